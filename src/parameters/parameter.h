#pragma once
// What can be set, said once: a table of parameters beside each struct of settings. The scene reader, the
// JSON Schema, the manual, `lambent list` and everything else that must know a parameter read the same table.
// The default is the value that a default-constructed struct holds.

#include <limits>
#include <string>
#include <variant>

#include "math/color.h"
#include "math/vec.h"

namespace lambent {

/// Where a number may lie, ends included; for colours and vectors it holds for each component.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
inline constexpr Range at_least_zero{0};
inline constexpr Range zero_to_one{0, 1};
inline constexpr Range positive{1e-10};  ///< What is below counts as a mistake, not as a size.

/// What a Vec3 member means; it says how the reader checks it.
enum class Kind { value, point, direction };

/// One parameter that a member of S holds.
template <class S> struct Parameter {
  using Member =
      std::variant<double S::*, int S::*, bool S::*, Rgb S::*, Vec3<double> S::*, std::string S::*>;
  const char* name;
  Member member;
  Range range;
  const char* unit;      ///< "degrees", "scene units", or "" for a plain number.
  const char* sentence;  ///< What it is, one sentence for people.
  bool required = false;
  Kind kind = Kind::value;
};

/// The table of S: an array of Parameter<S>, specialised beside each S.
template <class S> inline constexpr int parameters_of = 0;

}  // namespace lambent
