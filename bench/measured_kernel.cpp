// Compiled once for each instruction set, as the renderer's kernels are.

#include <initializer_list>

#include "illumination/equation.h"
#include "illumination/models.h"
#include "math/pack.h"
#include "measured.h"

namespace lambent {
inline namespace LAMBENT_ISA {
namespace {

using DoublePack = Pack<double, native_float_lanes>;

/// What is computed goes here, so that the compiler must compute it.
volatile double sink;

/// Different numbers in every lane and step, from 0 to 1.
double spread_number(int i) { return (i * 37 % 101 + 0.5) / 101; }

constexpr int sets = 16;  // inputs that are taken in turn; they stay in the nearest cache

template <class F> F numbers(int first) {
  F result{};
  for (int k = 0; k < lanes_of<F>; ++k) set_lane(result, k, spread_number(first + 7 * k));
  return result;
}
template <class F> Vec3<F> unit_vector(int first) {
  return normalize(Vec3<F>{numbers<F>(first), numbers<F>(first + 3), numbers<F>(first + 5) + F(0.5)});
}
template <class F> Color<F> color(int first) {
  Color<F> c;
  for (int i = 0; i < color_channels; ++i) c[i] = numbers<F>(first + 11 * i);
  return c;
}

template <class F> void measure_pow(std::uint64_t steps) {
  F x[sets], sum(0.0);
  for (int i = 0; i < sets; ++i) x[i] = numbers<F>(i);
  const F n(32.0);
  for (std::uint64_t i = 0; i < steps; ++i) sum = sum + pow(x[i % sets], n);
  sink = lane(sum, 0);
}

/// One light's contribution to one surface point, as the renderer asks for it.
template <class Model, class F> void measure_model(std::uint64_t steps) {
  Surface<F, Color<F>> s[sets];
  Arriving<F, Color<F>> light[sets];
  for (int i = 0; i < sets; ++i) {
    s[i] = {unit_vector<F>(i),
            unit_vector<F>(i + 20),
            color<F>(i),
            color<F>(i + 1),
            color<F>(i + 2),
            F(32.0),
            {}};
    for (int p = 0; p < max_model_parameters; ++p) s[i].own[p] = F(Model::info.parameters[p].default_value);
    light[i] = {unit_vector<F>(i + 40), color<F>(i + 3)};
  }
  Color<F> sum{};
  for (std::uint64_t i = 0; i < steps; ++i) {
    const auto term = Model::evaluate(s[i % sets], light[i / sets % sets]);
    sum = sum + (term.diffuse + term.specular);
  }
  sink = lane(sum[0] + sum[1] + sum[2], 0);
}

constexpr int double_lanes = lanes_of<DoublePack>;
constexpr bench::Measured pieces[] = {
    {"pow/number", 1, measure_pow<double>},
    {"pow/packet", double_lanes, measure_pow<DoublePack>},
#define LAMBENT_MODEL(name, Struct)                             \
  {"model/" #name "/number", 1, measure_model<Struct, double>}, \
      {"model/" #name "/packet", double_lanes, measure_model<Struct, DoublePack>},
#include "illumination/models.def"
#undef LAMBENT_MODEL
};

}  // namespace

extern const bench::MeasuredKernel bench_measured;
const bench::MeasuredKernel bench_measured{LAMBENT_ISA_NAME, pieces, int(sizeof(pieces) / sizeof(*pieces))};

}  // namespace LAMBENT_ISA
}  // namespace lambent
