#pragma once
// A number that remembers how it was made.
//
// A model is a template over its number. Evaluated with a Traced, it hands back its terms with the numbers it
// always makes, and with the formula that made them: so every model explains itself, by the one source that
// renders.

#include <string>
#include <string_view>
#include <vector>

#include "math/color.h"
#include "math/functions.h"
#include "math/vec.h"

namespace lambent {

enum class Operation {
  number,
  symbol,
  add,
  subtract,
  multiply,
  divide,
  negate,
  max,
  min,
  power,
  root,
  absolute,
  choose
};

/// A step of a formula. Its parts are indices into Formulas::nodes.
struct FormulaNode {
  Operation operation;
  double value;
  int a = -1, b = -1;
  bool first = true;  ///< choose: whether a was chosen.
  std::string name;   ///< symbol: "Kd", "N.L".
  int axis = -1;  ///< symbol: which coordinate of the vector that is called so; -1: a number, not a vector.
};

/// The formulas of one piece of work. What is Traced goes to the one that lives, the last made in its thread.
class Formulas {
 public:
  Formulas();
  ~Formulas();
  Formulas(const Formulas&) = delete;
  Formulas& operator=(const Formulas&) = delete;
  static Formulas& current();

  int add(FormulaNode node);
  /// The name of a vector by its coordinates' nodes: "N", "(L + V)"; empty where it has none.
  std::string vector_name(int x, int y, int z) const;

  std::vector<FormulaNode> nodes;  ///< The first is 0, which every Traced is that was given no other value.
  struct Definition {
    std::string name, formula;
    Vec3<double> value;
  };
  std::vector<Definition> definitions;  ///< Vectors that were made on the way: R.

 private:
  Formulas* before_;
};

struct Traced {
  double value = 0;
  int node = 0;
  Traced() = default;
  explicit Traced(double number) : value(number), node(made(Operation::number, number)) {}
  Traced(Operation operation, double result, const Traced& a, int b = -1)
      : value(result), node(made(operation, result, a.node, b)) {}
  static Traced symbol(std::string name, double value, int axis = -1) {
    Traced result;
    result.value = value;
    result.node = Formulas::current().add({Operation::symbol, value, -1, -1, true, std::move(name), axis});
    return result;
  }

 private:
  static int made(Operation operation, double value, int a = -1, int b = -1) {
    return Formulas::current().add({operation, value, a, b, true, "", -1});
  }
};

inline Traced operator+(const Traced& a, const Traced& b) {
  return {Operation::add, a.value + b.value, a, b.node};
}
inline Traced operator-(const Traced& a, const Traced& b) {
  return {Operation::subtract, a.value - b.value, a, b.node};
}
inline Traced operator*(const Traced& a, const Traced& b) {
  return {Operation::multiply, a.value * b.value, a, b.node};
}
inline Traced operator/(const Traced& a, const Traced& b) {
  return {Operation::divide, a.value / b.value, a, b.node};
}
inline Traced operator-(const Traced& a) { return {Operation::negate, -a.value, a}; }
inline bool operator<(const Traced& a, const Traced& b) { return a.value < b.value; }
inline bool operator>(const Traced& a, const Traced& b) { return a.value > b.value; }
inline bool operator<=(const Traced& a, const Traced& b) { return a.value <= b.value; }
inline bool operator>=(const Traced& a, const Traced& b) { return a.value >= b.value; }
inline bool operator==(const Traced& a, const Traced& b) { return a.value == b.value; }
inline Traced max(const Traced& a, const Traced& b) {
  return {Operation::max, max(a.value, b.value), a, b.node};
}
inline Traced min(const Traced& a, const Traced& b) {
  return {Operation::min, min(a.value, b.value), a, b.node};
}
inline Traced abs(const Traced& a) { return {Operation::absolute, abs(a.value), a}; }
inline Traced pow(const Traced& x, const Traced& y) {
  return {Operation::power, pow(x.value, y.value), x, y.node};
}
/// w of Fresnel's equations: its steps would fill a page.
Traced fresnel_conductor(const Traced& cosine, const Traced& eta, const Traced& k);
inline Traced select(bool m, const Traced& a, const Traced& b) {
  Traced result(Operation::choose, m ? a.value : b.value, a, b.node);
  Formulas::current().nodes[std::size_t(result.node)].first = m;
  return result;
}
Traced sqrt(const Traced& a);

inline Vec3<double> values(const Vec3<Traced>& v) { return {v.x.value, v.y.value, v.z.value}; }
Vec3<Traced> vector_symbol(const std::string& name, const Vec3<double>& value);

/// The same numbers as the templates of vec.h, under the names that people know: N.L, R.
Traced dot(const Vec3<Traced>& a, const Vec3<Traced>& b);
Vec3<Traced> reflect(const Vec3<Traced>& L, const Vec3<Traced>& N);
Vec3<Traced> normalize(const Vec3<Traced>& a);

Color<Traced> color_symbol(const std::string& name, const Rgb& value);
inline Rgb values(const Color<Traced>& c) {
  Rgb result;
  for (int i = 0; i < color_channels; ++i) result[i] = c[i].value;
  return result;
}

}  // namespace lambent
