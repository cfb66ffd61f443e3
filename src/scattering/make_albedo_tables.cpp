// Computes what src/scattering/albedo_tables.h holds, and says how well it fits. By hand, where a formula
// that it integrates has changed:
//
//   cmake --build build/release --target make_albedo_tables
//   build/release/src/make_albedo_tables > albedo_tables.h && mv albedo_tables.h src/scattering/
//
// It takes a few minutes. All of it is integrals over GGX by a lattice: of normals drawn by visible normals,
// the albedo is the mean of G2 / G1 of what they reflect and refract. ggx_albedo.h says what is fitted.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace {

double root_of(double c, double alpha) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); }
/// The cosine that is z of its root_of().
double cosine_of(double z, double alpha) {
  return std::min(alpha * z / std::sqrt(std::max(1 - (1 - alpha * alpha) * z * z, 1e-18)), 1.0);
}

/// Calls f(V.H, N.H, weight) for n x n visible normals (Dupuy and Benyoub 2023), by half a turn. They lie
/// denser where they lean far, as the tail of GGX is long. Each turn is shifted by the golden ratio against
/// the one before, so that the edge of total reflection is not met by a whole row at once.
template <class Function> void for_visible_normals(double mu, double alpha, int n, const Function& f) {
  const double sine = std::sqrt(std::max(1 - mu * mu, 0.0)), length = std::hypot(alpha * sine, mu);
  const double across = alpha * sine / length, up = mu / length;
  for (int i = 0; i < n; ++i) {
    const double turn = std::cos(M_PI * (i + 0.5) / n), shift = std::fmod((i + 0.5) * 0.6180339887498949, 1);
    for (int j = 0; j < n; ++j) {
      const double rest = (j + shift) / n, v = 1 - rest * rest * rest, below = v * (1 + up),
                   ring = std::sqrt(std::max(below * (2 - below), 0.0));
      const double hx = alpha * (ring * turn + across), hz = rest * rest * rest * (1 + up);
      const double over = 1 / std::sqrt(hx * hx + alpha * alpha * ring * ring * (1 - turn * turn) + hz * hz);
      f(std::min(over * (hx * sine + hz * mu), 1.0), over * hz, 3 * rest * rest / n / n);
    }
  }
}

/// G2 / G1 of the mirrored direction; 0 below the horizon.
double reflected(double VH, double NH, double mu, double alpha) {
  const double c = 2 * VH * NH - mu;
  if (c <= 0) return 0;
  return c * (mu + root_of(mu, alpha)) / (c * root_of(mu, alpha) + mu * root_of(c, alpha));
}

struct Albedo {
  double E, B;  ///< With F = 1, and with F = (1 - V.H)^5.
};
Albedo mirror_albedo(double mu, double alpha, int n) {
  Albedo sum{};
  for_visible_normals(mu, alpha, n, [&](double VH, double NH, double weight) {
    const double g = reflected(VH, NH, mu, alpha), x = 1 - VH, x2 = x * x;
    sum.E += weight * g, sum.B += weight * g * x2 * x2 * x;
  });
  return sum;
}

double glass_albedo(double mu, double alpha, double eta, int n) {
  double sum = 0;
  const double bend = 1 / eta;
  for_visible_normals(mu, alpha, n, [&](double VH, double NH, double weight) {
    const double k = 1 - bend * bend * (1 - VH * VH), cosine = std::sqrt(std::max(k, 0.0)), g = cosine * eta;
    const double down = bend * mu - (bend * VH - cosine) * NH;  // of the refracted ray
    const double s = (VH - g) / (VH + g), p = (eta * eta * VH - g) / (eta * eta * VH + g);
    const double F = k <= 0 || down <= 0 ? 1 : (s * s + p * p) / 2;
    sum += weight * F * reflected(VH, NH, mu, alpha);
    if (F < 1)
      sum += weight * (1 - F) *
             std::min(1.0, down * (mu + root_of(mu, alpha)) / (mu * (down + root_of(down, alpha))));
  });
  return sum;
}

/// Least squares by Householder's reflections: the c with the least |w (A c - b)|. A is row by row.
std::vector<double> least_squares(std::vector<double> A, std::vector<double> b,
                                  const std::vector<double>& w) {
  const std::size_t m = b.size(), n = A.size() / m;
  for (std::size_t r = 0; r < m; ++r) {
    for (std::size_t c = 0; c < n; ++c) A[r * n + c] *= w[r];
    b[r] *= w[r];
  }
  std::vector<double> diagonal(n), dots(n);
  for (std::size_t k = 0; k < n; ++k) {
    double norm = 0;
    for (std::size_t r = k; r < m; ++r) norm += A[r * n + k] * A[r * n + k];
    norm = A[k * n + k] > 0 ? -std::sqrt(norm) : std::sqrt(norm);
    diagonal[k] = norm;
    A[k * n + k] -= norm;
    double square = 0, of_b = 0;
    std::fill(dots.begin(), dots.end(), 0.0);
    for (std::size_t r = k; r < m; ++r) {
      const double v = A[r * n + k];
      square += v * v, of_b += v * b[r];
      for (std::size_t c = k + 1; c < n; ++c) dots[c] += v * A[r * n + c];
    }
    for (std::size_t r = k; r < m; ++r) {
      const double v = 2 * A[r * n + k] / square;
      b[r] -= v * of_b;
      for (std::size_t c = k + 1; c < n; ++c) A[r * n + c] -= v * dots[c];
    }
  }
  std::vector<double> x(n);
  for (std::size_t k = n; k-- > 0;) {
    double sum = b[k];
    for (std::size_t c = k + 1; c < n; ++c) sum -= A[k * n + c] * x[c];
    x[k] = sum / diagonal[k];
  }
  return x;
}

struct Fit {
  double error;  ///< The largest, weighted by `counts`.
  std::vector<double> coefficients;
};
/// Weights grow where the error is large, which makes the largest error small.
Fit fit(const std::vector<double>& basis, const std::vector<double>& values,
        const std::vector<double>& counts) {
  const std::size_t m = values.size(), n = basis.size() / m;
  std::vector<double> weight(m, 1.0), error(m), both(m);
  Fit best{1e300, {}};
  for (int round = 0; round < 80; ++round) {
    for (std::size_t r = 0; r < m; ++r) both[r] = weight[r] * counts[r];
    const std::vector<double> c = least_squares(basis, values, both);
    double largest = 0, most = 0;
    for (std::size_t r = 0; r < m; ++r) {
      double sum = -values[r];
      for (std::size_t i = 0; i < n; ++i) sum += basis[r * n + i] * c[i];
      error[r] = counts[r] * std::fabs(sum), largest = std::max(largest, error[r]);
    }
    if (largest < best.error) best = {largest, c};
    for (std::size_t r = 0; r < m; ++r)
      weight[r] *= std::sqrt(error[r] / largest + 0.05), most = std::max(most, weight[r]);
    for (double& w : weight) w /= most;
  }
  return best;
}

void add_powers(std::vector<double>& basis, double x, double y, int degree_x, int degree_y) {
  double px = 1;
  for (int i = 0; i <= degree_x; ++i, px *= x) {
    double p = px;
    for (int j = 0; j <= degree_y; ++j, p *= y) basis.push_back(p);
  }
}
double value_of(const std::vector<double>& c, double x, double y, int degree_x, int degree_y) {
  std::vector<double> powers;
  add_powers(powers, x, y, degree_x, degree_y);
  double sum = 0;
  for (std::size_t i = 0; i < c.size(); ++i) sum += c[i] * powers[i];
  return sum;
}

/// The table of T = (1 - E_glass) / d, as glass_albedo() of ggx_albedo.h reads it: from outside, from inside;
/// by place_of_glass(), the roughness, and sqrt((|t| - 0.02) / 0.48), t = (eta - 1) / (eta + 1).
class GlassTable {
  static constexpr int nx = 35, nr = 17, nt = 20;
  /// What E may be too much by, as shares, at the points that are looked at: nothing may be gained, nor
  /// between them.
  static constexpr double least = 0.0008, most = 0.007;
  std::vector<double> table_ = std::vector<double>(2 * nx * nr * nt);

  /// A point of the table's axes, in steps of it, and the integral there.
  struct Point {
    std::size_t cell;
    double rest[3], E, d;
  };
  std::vector<Point> points_;

 public:
  GlassTable() {
    // The ends of the first two axes are where E turns fastest.
    std::vector<double> along = halves(nx), rough = halves(nr);
    for (const double x : {0.02, 0.05, 0.1, 0.2, 0.3}) along.push_back(x);
    for (const double r : {0.06, 0.12, 0.25, 0.37, 0.75, 1.25}) rough.push_back(r);
    for (int inside = 0; inside < 2; ++inside)
      for (const double k : halves(nt))
        for (const double j : rough)
          for (const double i : along) add(inside, i, j, k);
    for (int sweep = 0; sweep < 60; ++sweep)
      for (const Point& p : points_) mend(p);
  }
  const std::vector<double>& values() const { return table_; }
  static std::vector<int> sizes() { return {2, nx, nr, nt}; }
  /// The largest share by which E is too little, and too much, at the points that were looked at.
  std::pair<double, double> errors() const {
    double little = 0, much = 0;
    for (const Point& p : points_) {
      const double error = value(p) / p.E - 1;
      little = std::max(little, -error), much = std::max(much, error);
    }
    return {little, much};
  }

 private:
  static std::vector<double> halves(int nodes) {
    std::vector<double> out;
    for (int i = 0; i < 2 * nodes - 1; ++i) out.push_back(i / 2.0);
    return out;
  }
  /// The cosine at a place of the first axis, 0 to 1: place_of_glass() the other way round.
  static double cosine_of_place(double x, double t, double alpha, bool inside) {
    const auto z_of = [&](double mu) { return mu / root_of(mu, alpha); };
    const double below = inside ? 0.7 : 1, critical = inside ? z_of(2 * std::sqrt(t) / (1 + t)) : 1,
                 q = x / below, root = 2 * q / (1.25 - 0.5 * q);
    const double z = x > below ? critical + (1 - critical) * (x - below) / (1 - below)
                               : critical * (q < 0.5 ? root * root / 2 : 1 - 2 * (1 - q) * (1 - q));
    return cosine_of(z, alpha);
  }
  void add(int inside, double i, double j, double k) {
    const double share = k / (nt - 1), t = 0.02 + 0.48 * share * share, eta = (1 + t) / (1 - t);
    const double roughness = std::max(j / (nr - 1), 0.004), alpha = roughness * roughness;
    const double mu = std::max(cosine_of_place(i / (nx - 1), t, alpha, inside), 1e-7);
    const double z = mu / root_of(mu, alpha);
    Point p;
    p.E = glass_albedo(mu, alpha, inside ? 1 / eta : eta, 150);
    p.d =
        z * (1 - z * z) * (0.21 + 0.35 * std::pow(z, 8)) + 0.06 * alpha + 0.5 * alpha * alpha * std::sqrt(z);
    const double at[] = {i, j, k};
    const int nodes[] = {nx, nr, nt};
    p.cell = inside;
    for (int axis = 0; axis < 3; ++axis) {
      const int whole = std::min(int(at[axis]), nodes[axis] - 2);
      p.rest[axis] = at[axis] - whole, p.cell = p.cell * nodes[axis] + whole;
    }
    // A node's own value is what its table begins with.
    if (i == int(i) && j == int(j) && k == int(k))
      table_[((inside * nx + std::size_t(i)) * nr + std::size_t(j)) * nt + std::size_t(k)] = (1 - p.E) / p.d;
    points_.push_back(p);
  }
  template <class Function> static void for_corners(const Point& p, const Function& f) {
    for (int corner = 0; corner < 8; ++corner) {
      const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
      const double weight =
          (i ? p.rest[0] : 1 - p.rest[0]) * (j ? p.rest[1] : 1 - p.rest[1]) * (k ? p.rest[2] : 1 - p.rest[2]);
      f(p.cell + (std::size_t(i) * nr + j) * nt + k, weight);
    }
  }
  double value(const Point& p) const {
    double T = 0;
    for_corners(p, [&](std::size_t node, double weight) { T += weight * table_[node]; });
    return std::min(1 - T * p.d, 1.0);
  }
  /// Moves a point's corners, as little as can be, until E lies between its bounds (Kaczmarz's projections).
  void mend(const Point& p) {
    const double E = value(p), off = E - std::clamp(E, (1 + least) * p.E, (1 + most) * p.E);
    if (off == 0) return;
    double squares = 0;
    for_corners(p, [&](std::size_t, double weight) { squares += weight * weight; });
    for_corners(p, [&](std::size_t node, double weight) {
      table_[node] = std::clamp(table_[node] + 0.7 * off / p.d * weight / squares, 0.0, 10.0);
    });
  }
};

void say(const char* type, const char* name, const std::vector<double>& values, std::vector<int> sizes,
         const std::string& sentence) {
  std::printf("/// %s\ninline constexpr %s %s", sentence.c_str(), type, name);
  for (const int n : sizes) std::printf("[%d]", n);
  std::printf(" = ");
  std::size_t next = 0;
  const std::function<void(std::size_t)> block = [&](std::size_t level) {
    std::printf("{");
    for (int i = 0; i < sizes[level]; ++i) {
      if (i) std::printf(level + 1 == sizes.size() ? ", " : ",\n");
      if (level + 1 < sizes.size()) block(level + 1);
      else std::printf(std::string(type) == "float" ? "%.6g" : "%.17g", values[next++]);
    }
    std::printf("}");
  };
  block(0);
  std::printf(";\n");
}

}  // namespace

int main() {
  constexpr int steps = 64, E_x = 8, h_x = 6, degree = 6, average_degree = 12;
  // E by s = sqrt(mu / S) and the roughness.
  std::vector<double> basis, values, stress;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double s = double(i) / steps, r = double(j) / steps, alpha = std::pow(std::max(r, 0.01), 2);
      add_powers(basis, s, r, E_x, degree);
      values.push_back(i == 0 ? 1 : mirror_albedo(cosine_of(s * s, alpha), alpha, 200).E);
      // A smooth surface loses little, and at grazing angles only: what the fit loses elsewhere would be most
      // of it.
      stress.push_back(1 + 6 * std::pow(s, 12) * std::pow(1 - r, 4));
    }
  Fit E = fit(basis, values, stress);
  E.coefficients[0] += E.error;  // rather a little too much: then nothing is gained

  // h by the same, where B = E (1 - S h)^5. Errors count as they do in B.
  std::vector<double> counts;
  basis.clear(), values.clear();
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double mu = std::max(std::pow(double(i) / steps, 2), 1e-6), r = double(j) / steps,
                   alpha = std::pow(std::max(r, 0.01), 2), S = root_of(mu, alpha);
      const Albedo a = mirror_albedo(mu, alpha, 200);
      const double q = std::pow(a.B / a.E, 0.2);
      add_powers(basis, std::sqrt(mu / S), r, h_x, degree);
      values.push_back((1 - q) / S);
      counts.push_back(S * std::max(5 * std::pow(q, 4), 0.05));
    }
  const Fit h = fit(basis, values, counts);

  // Averages 2 int ... mu dmu, of the fits; mu = x^3 is dense where E is steep. What is lost is divided by
  // alpha^2, and its relative error counts.
  std::vector<double> lost, grazing, over, all;
  basis.clear();
  for (int j = 4; j <= 200; ++j) {
    const double r = j / 200.0, alpha = r * r;
    double sum_lost = 0, sum_B = 0, most_lost = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) {
      const double x = (i + 0.5) / n, mu = x * x * x, S = root_of(mu, alpha), s = std::sqrt(mu / S);
      const double e = std::min(value_of(E.coefficients, s, r, E_x, degree), 1.0);
      const double b = e * std::pow(std::max(1 - S * value_of(h.coefficients, s, r, h_x, degree), 0.0), 5);
      const double weight = 6 * std::pow(x, 5) / n;
      sum_lost += weight * (1 - e), sum_B += weight * b, most_lost = std::max(most_lost, 1 - e);
    }
    add_powers(basis, r, 0, average_degree, 0);
    lost.push_back(sum_lost / (alpha * alpha)), grazing.push_back(sum_B);
    over.push_back(most_lost * alpha * alpha / sum_lost), all.push_back(1);
  }
  const Fit average_lost = fit(basis, lost, over), average_B = fit(basis, grazing, all);

  const GlassTable glass;

  char right[100];
  const auto to = [&](const char* words, double error) {
    std::snprintf(right, sizeof right, words, error);
    return std::string(right);
  };
  std::printf("#pragma once\n// Written by make_albedo_tables.cpp; do not edit. ggx_albedo.h reads it.\n\n");
  std::printf(
      "#include \"math/isa.h\"\n\nnamespace lambent {\ninline namespace LAMBENT_ISA {\nnamespace "
      "albedo_tables {\n\n// clang-format off\n");
  say("double", "E", E.coefficients, {E_x + 1, degree + 1},
      to("By powers of s, of the roughness: too much by 0 to %.4f.", 2 * E.error));
  say("double", "h", h.coefficients, {h_x + 1, degree + 1}, to("Likewise; B is right to %.4f.", h.error));
  say("double", "average_lost", average_lost.coefficients, {average_degree + 1},
      to("(1 - <E>) / alpha^2 by powers of the roughness: (1 - E) / (1 - <E>) (1 - <E>) is right to %.4f.",
         average_lost.error));
  say("double", "average_B", average_B.coefficients, {average_degree + 1},
      to("<B> by powers of the roughness: right to %.4f.", average_B.error));
  say("float", "glass", glass.values(), GlassTable::sizes(),
      "From outside, from inside; by place_of_glass() of N.V, the roughness, the index.");
  std::printf(
      "// clang-format on\n\n}  // namespace albedo_tables\n}  // namespace LAMBENT_ISA\n}  // namespace "
      "lambent\n");
  const auto [little, much] = glass.errors();
  std::fprintf(stderr, "E %.5f  B %.5f  <lost> %.5f  <B> %.5f  glass -%.5f +%.5f\n", E.error, h.error,
               average_lost.error, average_B.error, little, much);
}
