#pragma once
// The scene that suits a model file: what `lambent render model.obj` shows.

#include <string>

#include "import/model.h"

namespace lambent {

/// A scene file for the model that was read from `path`: readable YAML with comments, which names the model's
/// file without its folder, so it belongs beside it.
///
/// What the model brings (camera, picture size, background, lights) is kept; with lights of its own come the
/// rules of the Standard Procedural Databases, which are the only format here that has any. The rest is
/// chosen: a camera that sees the whole of the model's bounds from three quarters and a little above,
/// whatever the shape of a picture of width x height pixels; a key, a fill and a rim light; a floor. All of
/// it scales with the model, so its unit of length does not show.
std::string scene_text(const Model& model, const std::string& path, int width = 1280, int height = 720);

}  // namespace lambent
