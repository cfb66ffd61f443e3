// docs/scene-format.md: prose around tables that are made from the format's sections.

#include <fmt/format.h>

#include <cctype>

#include "lambent/lambent.h"
#include "scenefile/format.h"
#include "scenefile/nearest.h"
#include "spectra/optical.h"

namespace lambent {
namespace {

/// Text in a table's cell: a bar would end it.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + cell(text) + "`"; }

std::string table(const std::vector<Field>& fields) {
  std::string text = "| key | value | unit | default | range | |\n|---|---|---|---|---|---|\n";
  for (const Field& field : fields) {
    const std::string range =
        field.choices.empty() ? describe(field.range) : "`" + join(field.choices, "`, `") + "`";
    text +=
        fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", field.name, type_name(field.type), field.unit,
                    field.required ? "**required**" : code(field.default_value), range, cell(field.sentence));
  }
  return text + "\n";
}

std::string kinds(const std::vector<Section>& sections) {
  std::string text;
  for (const Section& section : sections) {
    text += fmt::format("### `{}`: {}\n\n", section.name, section.title);
    if (!section.equation.empty()) text += "    " + section.equation + "\n\n";
    if (!section.source.empty()) text += "Source: " + section.source + ".\n\n";
    if (!section.fields.empty()) text += table(section.fields);
  }
  return text;
}

std::string models_overview(const std::vector<Section>& models) {
  std::string text = "| model | | attenuation | ambient attenuation |\n|---|---|---|---|\n";
  for (const Section& model : models)
    text += fmt::format("| `{}` | {} | `{}` | `{}` |\n", model.name, cell(model.title), model.attenuation,
                        model.ambient_attenuation);
  return text + "\n";
}

std::string models_text(const std::vector<Section>& models) {
  std::string text;
  for (const Section& model : models) {
    std::string title = model.title;
    title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
    text += fmt::format("### `{}`\n\n{}.\n\n    {}\n\n", model.name, title, model.equation);
    if (!model.source.empty()) text += "Source: " + model.source + ".\n\n";
    if (!model.differs.empty()) text += "How it differs from the lecture: " + model.differs + "\n\n";
    if (!model.fields.empty()) text += "Numbers of its own, given in the material:\n\n" + table(model.fields);
  }
  return text;
}

constexpr const char* introduction = R"(# The scene format

<!-- Written by `lambent list --manual` from the tables of parameters in the source; change those, not this file. -->

A scene is a YAML file: a camera, lights, materials and objects, and the equation that lights them. JSON is YAML, so
programs can write scenes too. This is a complete one:

```yaml
lambent: 1
camera: {eye: [0, 1.4, 5], target: [0, 0.6, 0], fov: 40}
image: {size: [640, 360], samples: 16}
illumination: {model: phong, attenuation: 1/r, ambient: [1, 1, 1], ambient_attenuation: 1/R}
integrator: {whitted: {max_depth: 5}}
background: "#304050"

lights:
  - {name: key, point: {position: [3, 4, 4], intensity: 8}}
  - {name: fill, directional: {direction: [1, -1, -1], color: [0.6, 0.7, 1], intensity: 0.3}}

materials:
  - {name: red, ambient: [0.1, 0.02, 0.02], diffuse: [0.8, 0.1, 0.1], specular: 0.5, shininess: 32, reflect: 0.2}
  - {name: floor, diffuse: 0.6}

objects:
  - {sphere: {center: [0, 0.6, 0], radius: 0.6}, material: red}
  - {plane: {point: [0, 0, 0], normal: [0, 1, 0]}, material: floor}
  - box: {min: [-0.5, 0, -0.5], max: [0.5, 1, 0.5]}
    material: {diffuse: [0.1, 0.3, 0.8]}
    transform: [{scale: 0.6}, {rotate: {axis: y, degrees: 30}}, {translate: [1.3, 0, 0.4]}]
```

Save it as `scene.yaml` and run `lambent render scene.yaml`. `lambent check scene.yaml` says everything that is wrong with it
at once, with line and column. For completion and checks while you type, point your editor's YAML language server at
`docs/lambent.schema.json`:

```yaml
# yaml-language-server: $schema=lambent.schema.json
```

Contents: [conventions](#conventions), [top level](#top-level), [camera](#camera), [background](#background), [fog](#fog), [image](#image), [film](#film), [illumination](#illumination),
[models](#models), [integrator](#integrator), [lights](#lights), [materials](#materials), [spectra](#spectra), [objects](#objects), [shapes](#shapes),
[transforms](#transforms), [motion](#motion), [values from the command line](#values-from-the-command-line), [model files](#model-files).

## Conventions

- Coordinates are right-handed. Lengths are in scene units, whatever those mean to you; angles are in degrees.
- The camera looks from `eye` to `target`; `fov` is the vertical field of view. Row 0 of the picture is the top.
- One sample per pixel goes through the pixel's centre. `max_depth` counts the ray from the eye as 1.
- Colours are linear: 1 is white, 0.5 reflects half the light. A colour is `[r, g, b]`, one number for grey, or `"#rrggbb"` in
  sRGB, as picked on a screen. The quotes are needed: in YAML an unquoted `#` begins a comment. Or it is a
  [spectrum](#spectra): `{blackbody: 3000}`.
- Numbers are decimal: `16`, `0.5`, `-1e-3`. Infinity and NaN are errors. Coordinates and lengths reach up to 1e10, all other
  numbers up to 1e18, so that single precision can hold what is made of them.
- Directions may have any length but zero. Positive lengths are at least 1e-10.
- `true` and `false` are the only truth values.
- Text that looks like a number needs quotes: `name: "5"`.
- Anchors and aliases (`&a`, `*a`) work; merging with `<<` and tags such as `!!float` do not.
- A key that is unknown, repeated, missing, empty, of the wrong type or out of range is an error. Nothing is skipped in silence.

)";

constexpr const char* illumination_text = R"(The colour I that a surface point sends towards the eye is

    I = emission + Ka Ia / R  +  sum over lights of  Il / r [ diffuse + specular ]
        + reflect * (colour along the mirror ray) + transmit * (colour along the refracted ray)

with Ka the material's `ambient`, Ia the scene's `ambient`, Il a light's colour times its intensity, r its distance from the
point, and R the distance the ray has travelled since the eye, over all bounces. What stands in the brackets is the model's
affair; the factors 1/r and 1/R are the attenuations', and free to combine with any model. r and R count as at least
`minimum_distance`. A light at infinity does not fade. A point in the shadow of a light gets neither diffuse nor specular
light of it.

)";

constexpr const char* occlusion_text =
    R"(With `ambient_occlusion: {}` the ambient term is multiplied by A, the share of the directions above the surface in which
nothing stands: contacts and folds darken softly. What transmits hides nothing. The directions are spread evenly (Roberts' R2
sequence, turned in each pixel by a hash of its place), more of them where N.L would be larger (Malley's method).

)";

constexpr const char* lens_text =
    R"(With an `aperture` A the rays of a pixel start all over a lens, a thin one, and meet again where they are in focus: in the plane across the
view that lies `focus_distance` f from the eye. A point at the depth d is a disc in the picture as large as one of the diameter
A |d - f| / f would be at the depth d. Which point of the lens a sample takes is a hash of its pixel and number (Owen-scrambled Sobol points, the same on every
machine): give such pictures some samples, 64 or more.

)";

constexpr const char* background_text =
    R"(A colour, or an image all around the scene, by longitude and latitude (equirectangular): what rays see that meet nothing,
eye rays and mirror rays alike. It lights nothing. `file: studio` is a dark room with soft lamps, which the program brings and shows
shining models in. The middle lies along -z, u grows to the right as seen from inside, the top row is straight up.

    background: {file: venice_sunset_1k.hdr, turn: 90}

)";

constexpr const char* fog_text =
    R"(is what the eye gets of a colour along a ray of the length t. Rays from the eye see it, and mirrored and refracted ones on each of their ways. What
meets nothing goes without end, and is wholly the fog's colour, whatever the background. Light on its way to surfaces goes through no fog: shadow rays,
and what `path` scatters by chance. The lecture's 1/R, by which the ambient term fades, is another matter (`ambient_attenuation`).

)";

constexpr const char* materials_text =
    R"(`opacity` less than 1 shows the rest of what lies behind, straight on, and lets as much light through. With `alpha: mask` there is no
surface where the opacity is below `alpha_cutoff`, and all of it elsewhere: leaves, fences. Rays that pass such gaps, or a
`one_sided` surface from inside, do not count for `max_depth`.

)";

constexpr const char* rough_text =
    R"(A material as glTF and most modelling programs write it. It becomes the lecture's Ka, Kd, Ks and n at every point; the formulas, and where they
come from, are in `src/illumination/metallic_roughness.h`:

    F0   = (1 - metallic) d + metallic base_color,      d = ((ior - 1) / (ior + 1))^2 specular_color specular
    K    = (1 - metallic) base_color (1 - d)
    n    = 2 / alpha^2 - 2,      alpha = roughness^2,      w = alpha^2
    Kd   = K (1 - transmission) + w F0
    Ks   = (1 - w) F0 (n + 2) / 8
    reflect  = F0 ((1 - 2 alpha)+)^2
    Ka   = Kd + (1 - w) F0 - reflect
    transmit = K transmission

)";

constexpr const char* maps_text =
    R"(Each entry is the name of an image file (PNG, JPEG, HDR, EXR, TGA, BMP), or a mapping with `file` and more:

    materials:
      - {name: floor, diffuse: 1, maps: {diffuse: planks.png, bump: {file: planks_height.png, strength: 0.01}}}

Colours are decoded from sRGB, data is taken as it is. (u, v) = (0, 0) is the image's lower left corner. Textures are looked up with the width of the ray: from
several levels of detail, linearly between them, and with up to 16 taps where the surface lies at a slant. Meshes bring their texture
coordinates; spheres have longitude and latitude about the y axis, infinite planes and discs two lengths in scene units (for a floor x and -z), cylinders and cones the
way round and the height, boxes, rectangles and polygons those of the plane they lie in.

)";

constexpr const char* whitted_text =
    R"(In Whitted's sum `lights` light surfaces. Surfaces with `emission` and the background are seen, in mirrors too, and light others where
`emission_samples` and `background_samples` say so: `--set integrator.whitted.background_samples=64` lights any scene by its sky. So many
lights then stand for them, the same for all surface points, so that the picture has no noise, but shadows have steps where there are few. What shines
is cut in two, again and again, where it extends farthest, with half of the power on either side (the median cut of Debevec, 2005). A
part of a surface becomes a point of it with Il = Le A / pi times the cosine there, and a sphere one with Il = Le R^2, for its radiance Le; it fades as
`illumination` says, and 1/r^2 is right. A part of the sky becomes a `directional` light with Il = (sum of L dw) / pi: a matt, open floor below an even sky of radiance L
gets Kd L. Both have layers, `surfaces` and `sky`. The ambient term stands for the same light, so take `ambient: 0` with them.

)";

constexpr const char* path_text =
    R"(`integrator: {path: {}}` solves the rendering equation: light reaches a surface from lights, from the background, from surfaces
that shine, and from all other surfaces. `lambent render scene.yaml --integrator path` shows any scene so.

- **The same lights.** A light of colour Il gives Il Kd (N.L)+ / r^2 on a matt surface, as in the model `attenuated`; so a point
  light's radiant intensity is pi Il. Lights without extent fade as `illumination.attenuation` says, if it is given, else with 1/r^2.
  There is no ambient term: its place is taken by the light that comes by way of other surfaces. What has `emission`, and the
  background, light everything.
- **The same materials**, as they scatter light. Kd is Lambert's f = Kd / pi. Ks and n are a lobe that conserves energy: Phong's with the factor
  (n + 2) / (2 pi) (Lafortune and Willems 1994), or Blinn's about N.H for models that have it. `reflect` and `transmit` are perfect mirrors
  and glass. Where the four add up to more than 1 they are scaled down together, as nothing shines brighter than it is lit. `metallic_roughness` is GGX with
  Fresnel's reflection, a matt layer below, and a clear coat, made up for the light that microfacets scatter more than once.
  What is not opaque (`opacity`) is there by that chance.
- **Samples.** `image.samples` is the number of paths for each pixel, 64 where not given. `until: 0.01` (or `--until 0.01`) goes on
  until the noise is 1 % of the mean luminance; `--stats` tells the noise that is left. Adaptive samples are not for paths.
- **For a time**: `lambent render scene.yaml --until 30s` (`5min`, `2h`) takes as many samples as fit in that time, from the first ray on, and
  at least one; limits may be combined, and the first that is met counts. How many fit depends on the machine, and so does the picture. `--stats` and the
  picture's `lambent:samples` tell how many they were, and `--until 256spp` (`progressive: true, max_samples: 256`), with `--samples` as before, makes the same bits
  again anywhere. (`--samples 256` lays them out for 256, not for more to follow; that is another picture of the same quality.)
- **What costs noise**: light that paths meet by chance only. That is the light of lamps behind glass, caustics and small mirrors' light on
  walls; of a point light behind glass nothing arrives at all, as nothing can meet it. `clamp` takes the specks, and light with them.
- **Without the noise that is left**: `lambent render scene.yaml --denoise -o picture.png`, where
  [Open Image Denoise](https://www.openimagedenoise.org) is installed: see [Denoising](denoising.md).
- The same bits whatever the machine and its threads, as all else; another `seed` makes another picture of the same.

With `film: {layers: true}` there are, for each light, for the surfaces that shine and for the sky, the light that comes directly from there
and the light that comes by way of other surfaces.

)";

constexpr const char* occlusion_integrator_text =
    R"(`integrator: {ambient_occlusion: {}}` shows A alone, in grey: as if all surfaces were white and opaque, and an even, white sky
their only light. The materials' colours, the lights and the background do not count; cut-outs (`alpha: mask`), `one_sided`, normal and bump
maps do. Directions are chosen as for the ambient term (above), `rays` of them for each sample. `image.samples` is 64 for it where not given.

)";

constexpr const char* spectral_text =
    R"(`spectral` follows rays as `whitted` does, for wavelengths in place of three colours. `wavelengths: 12` are 390, 420, ... 720 nm. Colours that are not
[spectra](#spectra) become some: sums of three smooth ones that add up to 1 and look like sRGB's primaries in D65 (Mallett and Yuksel, 2019).
Each wavelength brings what the CIE 1931 observer (2 degrees) sees of D65 there, with straight lines between the wavelengths: white and grey are
the same with any wavelengths, whatever their number. Saturated colours come out the nearer, the more there are: with 12 to
3 hundredths, with 36 to 4 thousandths. Three wavelengths are followed together, but where a glass disperses, each by itself. Light of few wavelengths lies outside of
sRGB: an EXR then holds negative numbers, a PNG none. With layers there is a channel for each wavelength.

)";

constexpr const char* spectra_text =
    R"(Wherever a colour stands, a spectrum may stand: a mapping that says what there is at every wavelength.

    lights:
      - {name: bulb, point: {position: [0, 3, 0], color: {blackbody: 2856}, intensity: 5}}
      - {name: laser, point: {position: [2, 3, 0], color: {wavelengths: [529, 532, 535], power: [0, 1, 0]}}}
    materials:
      - {name: leaf, diffuse: {wavelengths: [450, 500, 550, 600, 680, 720], values: [0.04, 0.06, 0.16, 0.08, 0.04, 0.45]}}

Between the wavelengths it runs straight, beyond them it stays as it is. `spectral` takes it as it is; all other integrators, and colours
that maps, vertices or `metallic_roughness` take part in, take the colour that it has in sRGB.

)";

constexpr const char* substance_text =
    R"(`metal` and `glass` say what a surface is made of. How much it reflects follows from Fresnel's equations, exact for metals (with n and k)
and for glass, at the angle at hand; what glass does not reflect goes through, refracted by its index. `reflect` is a factor on the one, `transmit` on
the other, `specular` on the highlight, whose model is `wavelength_specular` unless another is named. What is not given follows from `roughness`: the numbers
of a `metallic_roughness` material whose reflection is that of the substance, with a mirror ray where it is smooth; a metal's `ambient` and `diffuse` are
factors on what it reflects head on.

    materials:
      - {name: ring, metal: gold, roughness: 0.2}
      - {name: prism, glass: sf11}
      - {name: window, glass: {ior: 1.52, abbe: 60}}
      - {name: alloy, metal: {wavelengths: [400, 550, 700], n: [1.4, 0.9, 0.3], k: [2.0, 2.5, 3.9]}}

With `spectral` every wavelength has its own n and k. Elsewhere a metal has n and k for red, green and blue: n is the mean over what the channel sees, k
is such that head on the metal has the colour of its spectrum in D65; a glass has its index at 587.6 nm, and does not disperse.

| metal | source |
|---|---|
)";

constexpr const char* view_text =
    R"(`lambent render scene.yaml --view normals` shows a view of any scene, whatever its `integrator` says. Each pixel is the mean
over its samples of a colour made of what the eye's ray meets first; where it meets nothing it is black:

| `show` | colour |
|---|---|
| `normals` | (N + 1) / 2 for each axis of the world, N on the eye's side |
| `depth` | grey: 1 / (1 + R / s), s the distance of the camera's `eye` from its `target`; near is bright |
| `uv` | (u - floor u, v - floor v, 0), of meshes that have `uvs` |
| `primitives`, `objects`, `materials` | each its own, whatever the others are |
| `cosine` | grey: (N.L)+ of one `light`, shadows left out |
| `rays` | how many rays the pixel asked: from the eye, mirrored, refracted and to lights |

`rays` goes from dark blue over green and yellow to white, by log(1 + count); white is the most of any pixel of the picture,
and the picture's metadata says how many these are (`lambent:most_rays`). With `pattern: corners` each corner's count has its
colour, and a pixel is their mean. Of adaptive samples a view takes `start`. Views are numbers, written as colours are: a PNG
holds them as they are with `image: {encoding: none}`, an EXR always. They have no layers.

A scene file names one integrator. One that is set on the command line takes the place of the file's; a view then counts the
rays of the file's `whitted`.

)";

constexpr const char* mesh_text =
    R"(A mesh file is read once, however many objects show it, and takes memory once: objects with the same `file` are instances.
An object without `material` takes the file's materials; one of the scene's `materials` that has the name of one of the
file's stands in for it; an object's `material` replaces them all. A file's camera and lights are not used here.

A rectangle's width runs horizontally: for a floor (`normal: [0, 1, 0]`) `size: [w, h]` is w along x and h along z; for a wall
that faces z it is w along x and h along y. A box, a rectangle and a polygon become triangles. The caps of a
cylinder or cone face outward.

)";

constexpr const char* motion_text =
    R"(An object with a `motion` is blurred by what it does while the shutter is open. It begins where `transform` has placed it, and ends when all steps
have been done to that, in the world and in the order written; each step goes on all the time, at a constant speed. A wheel of radius 1 that rolls a quarter of a turn:

    motion: [{rotate: {axis: z, degrees: -90, center: [0, 1, 0]}}, {translate: [1.5708, 0, 0]}]

The samples of each pixel are dealt over the time: over `image.shutter_slices` moments, or as many as there are samples. For each moment the scene is laid out anew and
its samples are taken, so many slices cost the building of as many trees, and a still scene costs nothing. What moves by more than a few pixels from one moment to
the next shows in steps: give more samples and slices. The order of the samples is the same in all pixels, so there is no noise. Views show the middle of the time; adaptive
samples and `pattern: corners` do not go together with motion.

)";

constexpr const char* command_line_text = R"(## Values from the command line

`lambent render scene.yaml --set path.to.key=value` puts a value into the scene before it is read, as if it stood in the file:

    --set image.samples=16
    --set illumination.attenuation='{quadratic: 1}'
    --set lights.key.point.intensity=4        the light that is called key
    --set materials.0.diffuse='[1, 0, 0]'     the first material
    --set background=#203040

The steps of a path are keys; an element of a list is named by its `name`, or by its index from 0. Mappings that are missing
on the way are created; elements of lists are not. The value is YAML.

)";

constexpr const char* model_files_text = R"(## Model files

`lambent render model.obj` needs no scene: a camera, lights and a floor are chosen to suit the model. `lambent convert model.obj
scene.yaml` writes that scene down, as a start for one of your own. Files that know a camera and lights of their own keep them. What is read:

| ending | up | lit by | |
|---|---|---|---|
| `.gltf`, `.glb` | y | `blinn_phong` | glTF 2.0; see gltf.md |
| `.obj` | y | `mtl` | with MTL and its images; points and lines alone as spheres and cylinders |
| `.ply` | y | `blinn_phong` | ASCII and binary; without faces a cloud of points, as spheres |
| `.stl` | z | `blinn_phong` | ASCII and binary |
| `.nff` | its own | `phong` | by the rules of the Standard Procedural Databases |

`--camera`, `--up`, `--background`, `--no-ground` and `--time` choose otherwise. Meshes without normals of their own (OBJ without smoothing
groups, PLY, STL) are smooth where their faces meet gently, and creased elsewhere. Around what shines stands a studio (`background`).
What a file names must lie in its own folder or below, unless `--allow-outside`; `--max-file-bytes`, `--max-pixels` and `--max-primitives` set
limits on what is read.

## For other renderers

`lambent convert scene.yaml scene.pov` writes a scene or a model for POV-Ray 3.7, `lambent convert scene.yaml scene.dat` for
Tachyon 0.99: camera, lights, materials and shapes, with the command that renders it in its first lines. What the other program
cannot do is said as a warning that names the material, light or object. `script/conformance` compares the pictures.
)";

}  // namespace

std::string scene_manual() {
  const Format& f = format();
  Section named = f.material;
  named.fields.insert(named.fields.begin(), f.material_name);
  std::string text = introduction;
  text += "## Top level\n\n" + table(f.top.fields);
  text +=
      "## Camera\n\nThe camera looks from `eye` to `target`; `up` says which way is up in the picture and "
      "need not be at a right "
      "angle to the view, only not along it.\n\n" +
      table(f.camera.fields) + lens_text;
  text += "## Background\n\n" + std::string(background_text) + table(f.background.fields);
  text += "## Fog\n\n    " + f.fog.equation + "\n\n" + fog_text + table(f.fog.fields);
  text += "## Image\n\n" + table(f.image.fields);
  text += "At most 2^28 pixels. `samples` belongs to `pattern: stratified`.\n\n";
  text +=
      "`samples: {adaptive: {}}` takes `start` samples of every pixel, and then four times as many, and "
      "again, "
      "up to `max`, of those where n samples may be off by more than `error`. The measure is D / (2 "
      "n^(3/4)), with D "
      "the largest difference of any two samples in the pixel and its eight neighbours, in steps of 8 bits "
      "as the "
      "eye sees them: n well-spread samples of an edge of that height are off by about as much. What lies "
      "wholly "
      "between the first samples of a pixel and of all its neighbours is not seen: give such pictures a "
      "larger "
      "`start`. The result is the same whatever the machine, as all else.\n\n" +
      table(f.adaptive.fields);
  text += "## Film\n\n" + table(f.film.fields);
  text += "## Illumination\n\n" + std::string(illumination_text) + table(f.illumination.fields);
  text += "An `attenuation` of one's own is a mapping; at least one of its numbers is not 0:\n\n" +
          table(f.attenuation.fields);
  text += std::string(occlusion_text) + table(f.ambient_occlusion.fields);
  text +=
      "## Models\n\nWhat one light contributes at a point, per channel. N is the surface's unit normal on "
      "the side of the eye, L "
      "the unit vector to the light, V the one to where the ray came from, n the shininess; (x)+ is x where "
      "positive, otherwise 0. "
      "`Kd` is the material's `diffuse`, `Ks` its `specular`. No highlight where N.L <= 0.\n\nEach model "
      "brings the attenuations "
      "that hold where the scene does not say:\n\n" +
      models_overview(f.models) + models_text(f.models);
  text += "## Integrator\n\n" + table(f.integrator.fields) + kinds(f.integrators) + whitted_text + path_text +
          "### Wavelengths\n\n" + spectral_text + "### Openness and views\n\n" + occlusion_integrator_text +
          view_text;
  text +=
      "## Lights\n\n`lights` is a list. A light has a name, if you like, and one kind:\n\n```yaml\nlights:\n "
      " - {name: lamp, point: "
      "{position: [0, 3, 0], color: [1, 0.9, 0.8], intensity: 5}}\n```\n\n" +
      table(f.light.fields) + "What arrives, before attenuation, is Il.\n\n" + kinds(f.lights);
  text +=
      "## Materials\n\n`materials` is a list of named materials. An object may also have one written out in "
      "its place, without a "
      "name.\n\n" +
      table(named.fields);
  text += std::string(materials_text) + "### `metal` and `glass`\n\n" + substance_text;
  for (const NamedMetal& metal : metals()) text += fmt::format("| `{}` | {} |\n", metal.name, metal.source);
  text += "\n| glass | | index at d | Abbe number | source |\n|---|---|---|---|---|\n";
  for (const NamedGlass& glass : glasses())
    text += fmt::format("| `{}` | {} | {:.5f} | {:.2f} | {} |\n", glass.name, glass.title,
                        index_at(glass.index, line_d), abbe_of(glass.index), glass.source);
  text += "\nA metal written out:\n\n" + table(f.metal.fields) + "A glass written out:\n\n" +
          table(f.glass.fields);
  text += "### `metallic_roughness`\n\n" + std::string(rough_text) + table(f.metallic_roughness.fields);
  text += "### `maps`\n\n" + std::string(maps_text) + table(f.maps.fields) + "A map written out:\n\n" +
          table(f.map.fields);
  text += "## Spectra\n\n" + std::string(spectra_text) + table(f.spectrum.fields);
  text +=
      "## Objects\n\n`objects` is a list. An object is one shape, with a material and a transform if you "
      "like:\n\n```yaml\nobjects:\n  "
      "- {name: ball, sphere: {center: [0, 1, 0], radius: 1}, material: red, transform: {translate: [2, 0, "
      "0]}}\n```\n\n" +
      table(f.object.fields);
  text += "## Shapes\n\n" + std::string(mesh_text) + kinds(f.shapes);
  text +=
      "## Transforms\n\nA list of steps, each with one key, applied in the order written: `[{scale: 2}, "
      "{translate: [1, 0, 0]}]` makes "
      "twice as large first and moves then.\n\n" +
      table(f.transform.fields) + "A `rotate`:\n\n" + table(f.rotate.fields);
  text += "## Motion\n\n" + std::string(motion_text) + table(f.motion.fields);
  text += command_line_text;
  text += model_files_text;
  return text;
}

}  // namespace lambent
