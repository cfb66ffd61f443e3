#pragma once
// Material libraries of OBJ files (Wavefront MTL), and how they are understood.
//
// A Material is made of each `newmtl`:
//
//   illum 0            emission = Kd (+ Ke), all else black
//   illum 1            ambient = Ka, diffuse = Kd, specular = 0
//   illum 2, 10        and specular = Ks, shininess = Ns
//   illum 3 to 9       and reflect = Ks
//   no illum           as 2 where Ks is given, else as 1
//   d < 1, or 4, 6, 7, 9   see-through: ambient and diffuse are multiplied by d, transmit = 1 - d in every
//   channel illum 6, 7         refraction: transmit = Tf where it is given, ior = Ni (1 where it is not) Ke
//   emission
//
// - ior is 1 for everything but illum 6 and 7: what is merely dissolved does not bend light.
// - Tr is not in the specification; it counts as 1 - d. Where d and Tr contradict each other, d holds, with a
// warning.
// - Ka not given: 0.1 Kd. Kd not given: black; but the neutral 0.8 where nothing else gives the surface a
// colour (no Ks, Tf
//   or Ke) or an image does (map_Kd).
// - One number for a colour means a grey. Colours by spectral file or CIE XYZ are ignored, with a warning.
// - `d -halo f` counts as `d f`, with a warning.
// - `illum` itself goes to the model mtl, which the scene made for an OBJ file has: there the highlight of 5
// and 7 has its Fresnel factor, and 10 is black. Under other models it says nothing.
// - For all other models the Fresnel factors of illum 5 and 7, the shadow matte of 10 and the reflection map
// of 8 and 9 are not modelled: 5 reflects as
//   3, 7 as 6, 10 shades as 2, and 8 and 9 trace a ray as 3 and 4 do.
// - Images (map_*, bump, disp, decal, refl, norm) and the keys of physically based materials (Pr, Pm, ...)
// are passed over.

#include <string>
#include <vector>

#include "import/text_file.h"
#include "scene/scene.h"

namespace lambent {

struct MaterialLibrary {
  std::vector<Material>
      materials;  ///< In the order of the file; of equal names the first holds, and stands alone.
  std::vector<Diagnostic> warnings;
};

/// Throws InputError with everything that is wrong, up to 20 errors.
MaterialLibrary read_material_library(const TextFile& file);

}  // namespace lambent
