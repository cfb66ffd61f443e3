#pragma once

#include "parameters/parameter.h"

namespace lambent {

/// The plain numbers of a map in a scene file.
struct MapSettings {
  double rotate = 0;
  double gain = 1, base = 0;
  double strength = 1;
};
template <>
inline constexpr Parameter<MapSettings> parameters_of<MapSettings>[] = {
    {"rotate",
     &MapSettings::rotate,
     {},
     "degrees",
     "A turn of (u, v) about (0, 0), from u towards v, after `scale`."},
    {"gain", &MapSettings::gain, {}, "", "The value used is base + gain * texel."},
    {"base", &MapSettings::base, {}, "", "Likewise."},
    {"strength",
     &MapSettings::strength,
     {},
     "",
     "Of `normal`: factor on the tilt. Of `bump`: the height of white above black, in scene units. Of "
     "`occlusion`: how "
     "much of it counts."},
};

}  // namespace lambent
