#pragma once
// The registry: every light of lights.def in one type.

#include <variant>

#include "generated/lights.h"  // includes every file of this room; the build writes it

namespace lambent {

/// Any light.
using AnyLight = std::variant<
#define LAMBENT_LIGHT(name, Struct) Struct,
#include "lights/lights.def"
#undef LAMBENT_LIGHT
    std::monostate>;

inline namespace LAMBENT_ISA {

/// Calls visitor(light) with the struct that `light` holds.
template <class Visitor> decltype(auto) with_light(const AnyLight& light, Visitor&& visitor) {
#define LAMBENT_LIGHT(name, Struct) \
  if (auto* one = std::get_if<Struct>(&light)) return visitor(*one);
#include "lights/lights.def"
#undef LAMBENT_LIGHT
  __builtin_unreachable();
}

}  // namespace LAMBENT_ISA
}  // namespace lambent
