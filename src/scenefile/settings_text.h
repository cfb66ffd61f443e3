#pragma once
#include "lambent/image.h"
#include "scene/scene.h"

namespace lambent {

/// The settings that made a picture, for its metadata: "lambent:version", "lambent:scene" (the input's file
/// name) and "lambent:settings", a piece of a scene file: camera, image, illumination, integrator, background
/// and lights, with every value spelt out. Nothing in it changes from run to run or from machine to machine.
Metadata settings_metadata(const Scene& scene);

}  // namespace lambent
