#pragma once
// What the formats have in common: materials as sums of terms that other renderers know, and remarks.

#include <cstdint>
#include <string>
#include <vector>

#include "lambent/diagnostics.h"
#include "scene/scene.h"

namespace lambent {

/// A material, whatever its model: constant + diffuse (N.L)^brilliance Il + highlights, then reflect and
/// transmit.
struct Finish {
  Rgb constant{};  ///< Emission and the ambient term.
  Rgb diffuse{};
  double brilliance = 1;
  Rgb phong{};  ///< Times ((R.V)+)^phong_power.
  double phong_power = 1;
  Rgb blinn{};  ///< Times ((N.H)+)^blinn_power.
  double blinn_power = 1;
  bool fast = false;  ///< The latter in Tachyon's fast form.
  Rgb reflect{}, transmit{};
  double ior = 1;
};

/// Collects remarks that begin with who cannot say it: "Tachyon has no cones; object 'roof' is left out".
class Remarks {
 public:
  Remarks(std::string program, std::vector<Diagnostic>& to) : program_(std::move(program)), to_(to) {}
  void add(const Place& place, const std::string& rest);

 private:
  std::string program_;
  std::vector<Diagnostic>& to_;
};

/// How light fades under the scene's model.
Attenuation fading_of(const Scene& scene);

/// Says what of the scene's settings hardly any other renderer has.
void remark_on_settings(const Scene& scene, Remarks& remarks);

/// The material's terms. What its model does that no sum of such terms can say goes into the remarks.
Finish finish_of(const Scene& scene, const Material& material, Remarks& remarks);

/// Whether materials are used by any object.
std::vector<bool> used_materials(const Scene& scene);

/// Which of the scene's materials a primitive of an object has.
std::uint32_t material_of(const Shape& shape, const Object& object, std::size_t primitive);

/// A mesh's triangle in the world, as our renderer sees it: smooth where all its corners have normals,
/// otherwise flat.
struct PlacedTriangle {
  Vec3<double> corner[3];
  Vec3<double>
      normal[3];  ///< Unit; the face's own in all corners where it is not smooth, zero where it has no area.
  bool smooth = false;
};
PlacedTriangle placed_triangle(const Mesh& mesh, const Object& object, std::size_t triangle);

/// The strongest channel of a grey, or of a colour that must do as one; `grey` says which.
double strongest(const Rgb& color);
bool is_grey(const Rgb& color);

/// A material's or light's name for a remark.
std::string called(const char* what, const std::string& name);
/// Any text as part of a line of comment.
std::string in_comment(std::string text);

}  // namespace lambent
