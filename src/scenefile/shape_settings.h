#pragma once
// Shapes that a scene file knows and the scene itself does not, because they are made of others: a box is a
// mesh, a cylinder a cone with two equal radii.

#include "scene/scene.h"

namespace lambent {

struct BoxSettings {
  Vec3<double> min{0, 0, 0};
  Vec3<double> max{1, 1, 1};
};
template <>
inline constexpr Parameter<BoxSettings> parameters_of<BoxSettings>[] = {
    {"min",
     &BoxSettings::min,
     {},
     "scene units",
     "The corner with the smallest coordinates.",
     true,
     Kind::point},
    {"max",
     &BoxSettings::max,
     {},
     "scene units",
     "The opposite corner; each coordinate larger than that of `min`.",
     true,
     Kind::point},
};

struct CylinderSettings {
  Vec3<double> from{0, 0, 0};
  Vec3<double> to{0, 1, 0};
  double radius = 1;
};
template <>
inline constexpr Parameter<CylinderSettings> parameters_of<CylinderSettings>[] = {
    {"from", &CylinderSettings::from, {}, "scene units", "Centre of one end.", true, Kind::point},
    {"to",
     &CylinderSettings::to,
     {},
     "scene units",
     "Centre of the other end; not the same as `from`.",
     true,
     Kind::point},
    {"radius", &CylinderSettings::radius, positive, "scene units", "The radius.", true},
};

/// Attenuation as a mapping: 1 / (constant + linear r + quadratic r^2); what is not given is 0.
struct AttenuationSettings {
  double constant = 0, linear = 0, quadratic = 0;
};
template <>
inline constexpr Parameter<AttenuationSettings> parameters_of<AttenuationSettings>[] = {
    {"constant", &AttenuationSettings::constant, at_least_zero, "",
     "The part that does not depend on distance."},
    {"linear", &AttenuationSettings::linear, at_least_zero, "1 / scene units", "The factor of r."},
    {"quadratic", &AttenuationSettings::quadratic, at_least_zero, "1 / scene units^2",
     "The factor of r squared."},
};

/// A turn in a list of transforms.
struct RotateSettings {
  double degrees = 0;
  Vec3<double> center{0, 0, 0};
};
template <>
inline constexpr Parameter<RotateSettings> parameters_of<RotateSettings>[] = {
    {"degrees",
     &RotateSettings::degrees,
     {},
     "degrees",
     "The angle; counter-clockwise seen from the axis' tip.",
     true},
    {"center",
     &RotateSettings::center,
     {},
     "scene units",
     "A point of the axis, which stays where it is.",
     false,
     Kind::point},
};

}  // namespace lambent
