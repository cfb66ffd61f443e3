#include "scene/triangulate.h"

#include <algorithm>
#include <deque>

namespace lambent {

namespace {

struct Point {
  double x, y;
};

/// Twice the signed area of a, b, c: positive where they turn counter-clockwise.
double area(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
bool same(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// Dropping the normal's largest coordinate keeps the other two exact; their order keeps the polygon
/// counter-clockwise.
std::vector<Point> project(std::span<const Vec3<double>> points, const Vec3<double>& n) {
  const double x = abs(n.x), y = abs(n.y), z = abs(n.z);
  std::vector<Point> result;
  result.reserve(points.size());
  for (const auto& p : points) {
    Point q = z >= x && z >= y ? Point{p.x, p.y} : x >= y ? Point{p.y, p.z} : Point{p.z, p.x};
    if ((z >= x && z >= y ? n.z : x >= y ? n.x : n.y) < 0) std::swap(q.x, q.y);
    result.push_back(q);
  }
  return result;
}

// An ear is a corner whose neighbours see each other inside of the polygon. Cutting an ear off leaves the
// other corners' answers as they are, but for its two neighbours'; so a queue of corners to be asked, with
// the two appended at each cut, finds all ears in about 3 n questions.
class EarClipper {
 public:
  EarClipper(std::vector<Point> points) : points_(std::move(points)), count_(std::uint32_t(points_.size())) {
    Point lower = points_[0], upper = points_[0];
    for (const auto& p : points_) {
      lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
    largest_ = std::max({abs(lower.x), abs(lower.y), abs(upper.x), abs(upper.y)});
    for (std::uint32_t i = 0; i < count_; ++i) {
      next_.push_back(i + 1 < count_ ? i + 1 : 0);
      previous_.push_back(i > 0 ? i - 1 : count_ - 1);
    }
    for (std::uint32_t i = 0; i < count_; ++i)
      if (turn(i) <= 0) reflex_.push_back({points_[i], i});
    std::sort(reflex_.begin(), reflex_.end(), [](const Reflex& a, const Reflex& b) {
      return a.p.x != b.p.x ? a.p.x < b.p.x : a.corner < b.corner;
    });
    tidy_at_ = count_ / 2;
    budget_ = 100000000 + 500 * std::uint64_t(count_);
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(count_ - 2);
    for (std::uint32_t i = 0; i < count_; ++i) queue_.push_back(i);
    std::uint32_t at = 0;
    while (count_ > 3) {
      if (queue_.empty()) {
        // No ear is left: the polygon touches or crosses itself. First those will do that have no area, then
        // any corner.
        if (flat_ears_) {
          cut(at, triangles);
        } else {
          flat_ears_ = true;
          std::uint32_t i = at;
          do queue_.push_back(i);
          while ((i = next_[i]) != at);
        }
      } else {
        const std::uint32_t i = queue_.front();
        queue_.pop_front();
        if (!is_cut(i) && is_ear(i)) cut(i, triangles);
      }
      while (is_cut(at)) at = next_[at];
    }
    triangles.push_back({previous_[at], at, next_[at]});
    return triangles;
  }

 private:
  /// Positive at convex corners, negative at reflex ones, 0 where it is straight but for the rounding of
  /// coordinates.
  double turn(std::uint32_t i) const {
    const Point &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
    const double result = area(a, b, c);
    const double way = abs(b.x - a.x) + abs(b.y - a.y) + abs(c.x - a.x) + abs(c.y - a.y);
    return abs(result) > 1e-15 * largest_ * way ? result : 0;
  }
  bool is_cut(std::uint32_t i) const { return next_[previous_[i]] != i; }

  bool is_ear(std::uint32_t at) {
    if (flat_ears_ ? turn(at) < 0 : turn(at) <= 0) return false;
    const Point &a = points_[previous_[at]], &b = points_[at], &c = points_[next_[at]];
    const Point lower{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
    const Point upper{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    // Only reflex corners can lie inside of an ear.
    const auto first = std::lower_bound(reflex_.begin(), reflex_.end(), lower.x,
                                        [](const Reflex& r, double x) { return r.p.x < x; });
    auto r = first;
    // Only polygons that are made to be worse than real ones exhaust the budget; a convex corner must do
    // then.
    if (budget_ == 0) return true;
    bool blocked = false;
    for (; r != reflex_.end() && r->p.x <= upper.x && !blocked; ++r) {
      if (r->p.y < lower.y || r->p.y > upper.y) continue;
      const std::uint32_t i = r->corner;
      blocked = !is_cut(i) && i != at && i != previous_[at] && i != next_[at] && blocks(i, a, b, c);
    }
    budget_ -= std::min(budget_, std::uint64_t(r - first) + 1);
    return !blocked;
  }

  /// Whether corner `i` hinders the ear a, b, c.
  bool blocks(std::uint32_t i, const Point& a, const Point& b, const Point& c) const {
    const Point& p = points_[i];
    // A polygon with a hole runs twice through the ends of the cut that leads to the hole. At a or c, no way
    // leads from there into the ear without crossing the polygon; at b, one may lead through a and c's
    // diagonal.
    if (same(p, a) || same(p, c)) return false;
    if (same(p, b))
      return leads_into(points_[previous_[i]], a, b, c) || leads_into(points_[next_[i]], a, b, c);
    return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
  }
  static bool leads_into(const Point& p, const Point& a, const Point& b, const Point& c) {
    return area(a, b, p) > 0 && area(b, c, p) > 0;
  }

  void cut(std::uint32_t i, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const std::uint32_t p = previous_[i], n = next_[i];
    triangles.push_back({p, i, n});
    next_[p] = n;
    previous_[n] = p;
    queue_.push_back(p);
    queue_.push_back(n);
    if (--count_ > tidy_at_) return;
    tidy_at_ = count_ / 2;
    const auto gone = [&](const Reflex& r) { return is_cut(r.corner) || turn(r.corner) > 0; };
    reflex_.erase(std::remove_if(reflex_.begin(), reflex_.end(), gone), reflex_.end());
  }

  struct Reflex {
    Point p;
    std::uint32_t corner;
  };

  std::vector<Point> points_;
  std::uint32_t count_;  ///< Corners that are left.
  std::vector<std::uint32_t> next_, previous_;
  std::vector<Reflex> reflex_;       ///< By x; some of them have been cut or are convex by now.
  std::deque<std::uint32_t> queue_;  ///< Corners to be asked; some of them have been cut.
  bool flat_ears_ = false;           ///< Whether a corner without area is an ear.
  std::uint32_t tidy_at_ = 0;        ///< reflex_ is looked through again when so few corners are left.
  double largest_ = 0;               ///< Of the coordinates' absolute values.
  std::uint64_t budget_ = 0;         ///< Corners that may still be looked at.
};

}  // namespace

Vec3<double> newell_normal(std::span<const Vec3<double>> points) {
  Vec3<double> n{0, 0, 0};
  // Relative to the first corner, so that polygons far from the origin lose no digits.
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    n = n + cross(points[i] - points[0], points[i + 1] - points[0]);
  return n;
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3<double>> points) {
  if (points.size() < 3) return {};
  if (points.size() == 3) return {{0, 1, 2}};
  const Vec3<double> n = newell_normal(points);
  if (points.size() == 4) {
    // The diagonal 0-2, unless a triangle on it would turn the other way or have no area while one on 1-3
    // has.
    const auto least = [&](int a, int b, int c, int d, int e, int f) {
      return std::min(dot(n, cross(points[b] - points[a], points[c] - points[a])),
                      dot(n, cross(points[e] - points[d], points[f] - points[d])));
    };
    const double tiny = 1e-14 * dot(n, n), first = least(0, 1, 2, 0, 2, 3);
    if (first <= tiny && least(0, 1, 3, 1, 2, 3) > first) return {{0, 1, 3}, {1, 2, 3}};
    return {{0, 1, 2}, {0, 2, 3}};
  }
  return EarClipper(project(points, n)).run();
}

}  // namespace lambent
