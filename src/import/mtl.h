#pragma once
// Material libraries of OBJ files (Wavefront MTL), and how they are understood.
//
// A Material is made of each `newmtl`:
//
//   illum 0            emission = Kd (+ Ke), all else black
//   illum 1            ambient = Ka, diffuse = Kd, specular = 0
//   illum 2, 10        and specular = Ks, shininess = Ns
//   illum 3 to 9       and reflect = Ks
//   no illum           as 2 where Ks or map_Ks is given, else as 1
//   d                  opacity = d
//   d of 4, 6, 7, 9    glass, whose highlights do not fade: ambient and diffuse are multiplied by d, and
//                      transmit = 1 - d in every channel
//   illum 6, 7         refraction: transmit = Tf where it is given, ior = Ni (1 where it is not)
//   Ke                 emission
//   Pr, Pm or their maps   metallic_roughness, in place of what illum says; see below
//
// - ior is 1 for everything but illum 6 and 7: what is merely dissolved does not bend light.
// - Tr is not in the specification; it counts as 1 - d. Where d and Tr contradict each other, d holds, with a
//   warning.
// - Ka not given: 0.1 Kd. Kd not given: black; but the neutral 0.8 where nothing else gives the surface a
//   colour (no Ks, Tf or Ke) or an image does (map_Kd). Ks and Ke not given: black, but 1 under an image of
//   their own.
// - One number for a colour means a grey. Colours by spectral file or CIE XYZ are ignored, with a warning.
// - `d -halo f` counts as `d f`, with a warning.
// - `illum` itself goes to the model mtl, which the scene made for an OBJ file has: there the highlight of 5
//   and 7 has its Fresnel factor, and 10 is black. Under other models it says nothing.
// - For all other models the Fresnel factors of illum 5 and 7, the shadow matte of 10 and the reflection map
//   of 8 and 9 are not modelled: 5 reflects as 3, 7 as 6, 10 shades as 2, and 8 and 9 trace a ray as 3 and 4
//   do.
//
// Images multiply what they are named after; their alpha counts for nothing unless it is asked for:
//
//   map_Ka             ambient
//   map_Kd             diffuse, and ambient where there is no map_Ka: what writes MTL means the surface's
//                      colour by it
//   map_Ks             specular, and reflect where illum has it
//   map_Ke             emission
//   map_Ns             shininess
//   map_d              opacity: the luminance, or alpha with `-imfchan m`
//   map_Tr             1 - opacity, times Tr (times 1 where Tr is 0)
//   bump, map_bump     heights; `-bm` is how far white stands above black
//   norm, map_Kn       a normal map
//   map_Pr, map_Pm, map_Pc, map_Pcr    roughness, metallic, clearcoat and its roughness
//
// - With illum 0 map_Kd multiplies the emission.
// - Images of colours are sRGB-encoded, all others data; `-colorspace` (no part of the specification) may say
//   otherwise.
// - Options: -s and -o (u' = s u + o), -mm (base + gain x), -imfchan, -clamp, -bm are obeyed; -blendu and
//   -blendv too where both are off (the nearest texel). -texres changes nothing that is seen. -t, -boost,
//   -cc, -type and -imfchan z are ignored, with a warning, as are disp, decal, refl and map_Ps.
// - A name may hold blanks; options may also stand behind it. The file is looked for as paths.h says, from
//   the library's folder. Where it is missing the map is left out, with a warning.
//
// metallic_roughness: base_color = Kd, with map_Kd; metallic = Pm, 0 where it is not given; roughness = Pr,
// or that of Ns (alpha = sqrt(2 / (Ns + 2)), roughness = sqrt(alpha)), or 0.5; what has a map and no number
// is 1. clearcoat = Pc, clearcoat_roughness = Pcr; ior = Ni above 1, else 1.5; opacity = d; with illum 6 and
// 7 transmission = the mean of Tf. Sheen (Ps) and anisotropy are ignored, with a warning.

#include <string>
#include <vector>

#include "import/model.h"
#include "import/text_file.h"

namespace lambent {

/// An image as a library names it, there or not.
struct ImageName {
  std::size_t at = 0, size = 0;  ///< Where the name stands in TextFile::text.
  std::string path;              ///< Empty where there is no such file.
};

struct MaterialLibrary {
  /// In the order of the file; of equal names the first holds, and stands alone. Their maps index `textures`.
  std::vector<Material> materials;
  std::vector<Texture> textures;  ///< Not loaded; one for each file and use of it (colour or data).
  std::vector<ImageName> images;  ///< In the order of the file.
  std::vector<Diagnostic> warnings;
};

/// Images are looked for beside the file, within `options.root`. Throws InputError with everything that is
/// wrong, up to 20 errors.
MaterialLibrary read_material_library(const TextFile& file, const ImportOptions& options = {});

}  // namespace lambent
