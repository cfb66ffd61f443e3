#pragma once
// The scene that suits a model file: what `lambent render model.obj` shows.

#include <string>

#include "import/model.h"

namespace lambent {

/// What somebody may say of the scene that is made for a model. Empty: it is chosen to suit.
struct ModelChoices {
  int width = 1280, height = 720;  ///< Pixels, where the model does not say.
  /// One of the model's cameras, by its name or its number from 1, or a view that has the whole model in its
  /// picture: "three-quarter", "front", "back", "left", "right", "top".
  std::string camera = {};
  std::string up = {};          ///< "y" or "z".
  std::string background = {};  ///< As a scene file says it.
  bool ground = true;           ///< Whether there may be a floor.
};

struct ModelScene {
  std::string text;
  Axis axis;  ///< The model's vertical, through the middle of its bounds.
};

/// A scene file for the model that was read from `path`: readable YAML with comments, which names the model's
/// file without its folder, so it belongs beside it.
///
/// What the model brings (camera, picture size, background, lights) is kept. Lights of its own shine by the
/// rules of the Standard Procedural Databases where the format asks for them (Model::spd_rules); else they
/// fade with 1/r^2, all scaled together so that they bring 1 to the model's middle. The rest is chosen: a
/// camera that sees the whole of the model's bounds, whatever the shape of the picture; a key, a fill and a
/// rim light; a floor, where the camera is not the file's own. All of it stands upright along the model's
/// vertical and scales with the model, so its unit of length does not show. Throws InputError for choices
/// that there are not.
ModelScene scene_for(const Model& model, const std::string& path, const ModelChoices& choices = {});

}  // namespace lambent
