#include "scenefile/format.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/scene.h"
#include "scenefile/map_settings.h"
#include "scenefile/names.h"
#include "scenefile/shape_settings.h"

namespace lambent {
namespace {

template <class S> struct AsField {
  const Parameter<S>& parameter;
  Field& field;
  S defaults{};  // a temporary would do, but g++ 12 warns of its members without a cause

  void operator()(double S::*member) const { set(FieldType::number, text_of(defaults.*member)); }
  void operator()(int S::*member) const { set(FieldType::integer, std::to_string(defaults.*member)); }
  void operator()(bool S::*member) const { set(FieldType::boolean, defaults.*member ? "true" : "false"); }
  void operator()(Rgb S::*member) const { set(FieldType::color, text_of(defaults.*member)); }
  void operator()(Vec3<double> S::*member) const {
    set(parameter.kind == Kind::point       ? FieldType::point
        : parameter.kind == Kind::direction ? FieldType::direction
                                            : FieldType::vector,
        text_of(defaults.*member));
  }
  void operator()(std::string S::*) const { set(FieldType::name, {}); }  // names have no defaults
  void set(FieldType type, std::string default_value) const {
    field.type = type;
    if (!parameter.required) field.default_value = std::move(default_value);
  }
};

template <class S> std::vector<Field> fields_of() {
  std::vector<Field> fields;
  for (const Parameter<S>& parameter : parameters_of<S>) {
    Field field;
    field.name = parameter.name;
    field.range = parameter.range;
    field.unit = parameter.unit;
    field.sentence = parameter.sentence;
    field.required = parameter.required;
    std::visit(AsField<S>{parameter, field}, parameter.member);
    fields.push_back(std::move(field));
  }
  return fields;
}

Field field(std::string name, FieldType type, std::string default_value, std::string sentence) {
  Field result;
  result.name = std::move(name);
  result.type = type;
  result.default_value = std::move(default_value);
  result.sentence = std::move(sentence);
  return result;
}
Field required(std::string name, FieldType type, std::string sentence) {
  Field result = field(std::move(name), type, {}, std::move(sentence));
  result.required = true;
  return result;
}
Field choice(std::string name, std::vector<std::string> choices, std::string default_value,
             std::string sentence) {
  Field result = field(std::move(name), FieldType::choice, std::move(default_value), std::move(sentence));
  result.choices = std::move(choices);
  return result;
}
Field with(Field field, Range range, std::string unit) {
  field.range = range;
  field.unit = std::move(unit);
  return field;
}

Section section(std::string name, std::string title, std::vector<Field> fields) {
  Section result;
  result.name = std::move(name);
  result.title = std::move(title);
  result.fields = std::move(fields);
  return result;
}

std::vector<Field> operator+(std::vector<Field> a, const std::vector<Field>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<Section> model_sections() {
  std::vector<Section> models;
  for (const ModelInfo& info : model_infos) {
    Section model = section(info.name, info.title, {});
    model.equation = info.equation;
    model.source = info.source;
    model.differs = info.differs;
    model.attenuation = text_of(info.attenuation);
    model.ambient_attenuation = text_of(info.ambient_attenuation);
    for (const ModelParameter& parameter : info.parameters) {
      if (parameter.name == nullptr) break;
      model.fields.push_back(
          with(field(parameter.name, parameter.whole ? FieldType::integer : FieldType::number,
                     text_of(parameter.default_value), parameter.sentence),
               {parameter.min, parameter.max}, parameter.unit));
    }
    models.push_back(std::move(model));
  }
  return models;
}

template <class L> Section light_section() {
  Section light = section(L::info.name, L::info.title, fields_of<L>());
  light.equation = L::info.equation;
  return light;
}

std::vector<Section> light_sections() {
  return {
#define LAMBENT_LIGHT(name, Struct) light_section<Struct>(),
#include "lights/lights.def"
#undef LAMBENT_LIGHT
  };
}

std::vector<Section> shape_sections() {
  const Field capped =
      field("capped", FieldType::boolean, "false", "Whether the ends are closed with discs.");
  return {
      section("sphere", "a sphere", fields_of<Sphere>()),
      section("plane", "a plane, infinite or a rectangle",
              fields_of<Plane>() + std::vector{with(field("size", FieldType::extent, "",
                                                          "Width and height of a rectangle about `point`; "
                                                          "without it the plane is infinite. The width "
                                                          "runs horizontally (along x where the plane itself "
                                                          "is horizontal), the height at a right angle "
                                                          "to it (along z for a floor)."),
                                                    positive, "scene units")}),
      section("disc", "a flat disc", fields_of<Disc>()),
      section("box", "a box along the axes", fields_of<BoxSettings>()),
      section("cylinder", "a cylinder, open at both ends unless capped",
              fields_of<CylinderSettings>() + std::vector{capped}),
      section("cone", "a cone or a frustum, open at both ends unless capped",
              fields_of<Cone>() + std::vector{capped}),
      section("polygon", "a flat polygon, convex or concave",
              {with(required("vertices", FieldType::points,
                             "Its corners in order, three at least, all in one plane; it faces where they "
                             "run counter-clockwise."),
                    {}, "scene units")}),
      section("mesh", "triangles, from a file or written out",
              {field("file", FieldType::file, "",
                     "A model file, looked for beside the scene file. It brings its own materials."),
               with(field("vertices", FieldType::points, "", "The corners; instead of `file`."), {},
                    "scene units"),
               field("triangles", FieldType::triangles, "",
                     "Three indices of vertices each, from 0, counter-clockwise seen from outside; with "
                     "`vertices`."),
               field("normals", FieldType::directions, "",
                     "One direction for each vertex, of any length; without them the faces are flat. [0, 0, "
                     "0] stands for the face's own."),
               field("uvs", FieldType::uvs, "", "Two texture coordinates for each vertex.")}),
      section("scene", "the objects of another scene file",
              {required(
                  "file", FieldType::file,
                  "A scene file, looked for beside this one. Its objects with their materials are shown; its "
                  "camera, lights and all else are not used.")}),
  };
}

std::string sentence_of(MapSlot slot) {
  switch (slot) {
    case MapSlot::normal:
      return "Tilts N: red, green and blue are its parts along u, v and N, from -1 to 1.";
    case MapSlot::bump:
      return "Tilts N as if the surface had these heights.";
    case MapSlot::occlusion:
      return "Multiplies the ambient term alone.";
    case MapSlot::opacity:
      return "Multiplies `opacity`.";
    case MapSlot::specular_factor:
      return "Multiplies `specular` of `metallic_roughness`.";
    default:
      break;
  }
  std::string text = "Multiplies `" + text_of(slot) + "`";
  return text + (slot >= MapSlot::base_color ? " of `metallic_roughness`." : ".");
}

/// "gold, silver, copper".
template <class Named> std::string names_in_words(const std::vector<Named>& list) {
  std::string text;
  for (const Named& one : list) text += (text.empty() ? "" : ", ") + std::string(one.name);
  return text;
}

Section material_section(const std::vector<Section>& models) {
  Section material = section(
      "material", "what a surface does with light",
      std::vector{
          choice("model", names_of(models), "", "The illumination model; the scene's where not given.")} +
          fields_of<Material>() +
          std::vector{choice("alpha", names_of<Alpha>(), text_of(Material{}.alpha),
                             "What becomes of opacity: `blend` shows through, `mask` cuts out."),
                      field("metal", FieldType::substance, "",
                            "What it is made of, by its measured n and k: " + names_in_words(metals()) +
                                "; or a mapping with a table of one's own."),
                      field("glass", FieldType::substance, "",
                            "What clear material it is, by its measured index of refraction: " +
                                names_in_words(glasses()) + "; or a mapping."),
                      with(field("roughness", FieldType::number, "0",
                                 "Of a `metal` or a `glass`: 0 for a mirror, 1 for a surface without "
                                 "any gloss. (The model `povray` has one of its own.)"),
                           {0, 1e6}, ""),
                      field("metallic_roughness", FieldType::section, "",
                            "In place of ambient, diffuse, specular, shininess, reflect, transmit "
                            "and ior."),
                      field("maps", FieldType::section, "",
                            "Images on the surface, each of which multiplies what it is named "
                            "after.")});
  for (const Section& model : models)
    for (const Field& own : model.fields)
      if (find(material.fields, own.name) == nullptr) material.fields.push_back(own);
  return material;
}

Format make_format() {
  Format f;
  f.models = model_sections();
  f.lights = light_sections();
  f.shapes = shape_sections();
  f.material = material_section(f.models);
  f.background = section(
      "background", "a picture all around the scene, by longitude and latitude",
      {required("file", FieldType::file,
                "The image (HDR, EXR, PNG, ...), looked for beside the scene file; or `studio`, a dark room "
                "with soft "
                "lamps that the program brings."),
       choice("up", {"y", "z"}, "y", "Its vertical; with z its middle lies along +y."),
       with(field("turn", FieldType::number, "0", "A turn about the y axis, counter-clockwise from above."),
            {}, "degrees"),
       with(field("color", FieldType::color, "[1, 1, 1]", "A factor on it."), at_least_zero, "")});
  f.fog = section("fog", "fog: colours fade with the way of the ray that sees them", fields_of<Fog>());
  f.fog.equation = "exp(-density t) colour + (1 - exp(-density t)) color";
  f.metallic_roughness = section("metallic_roughness", "a material as glTF and modelling programs have it",
                                 fields_of<MetallicRoughness>());
  const Range seen{shortest_wavelength, longest_wavelength};
  const Field wavelengths =
      with(required("wavelengths", FieldType::numbers, "Wavelengths at which something is known, growing."),
           seen, "nm");
  f.metal =
      section("metal", "a metal by its complex index of refraction n + i k",
              {wavelengths,
               with(required("n", FieldType::numbers, "n at each of them; straight lines between them."),
                    {1e-3, 100}, ""),
               with(required("k", FieldType::numbers, "k at each of them."), {0, 100}, "")});
  Field loose = wavelengths;
  loose.required = false;
  f.glass = section(
      "glass", "something clear by its index of refraction",
      {with(field("ior", FieldType::number, "1.5", "The index at 587.6 nm, the line d."), {1, 10}, ""),
       with(field(
                "abbe", FieldType::number, "",
                "The Abbe number (n_d - 1) / (n_F - n_C): the smaller, the more it disperses. Not given: not "
                "at all."),
            {5, 1000}, ""),
       loose,
       with(field("n", FieldType::numbers, "", "The index at each of `wavelengths`, in place of the two."),
            {1, 10}, "")});
  f.spectrum = section(
      "spectrum", "a colour by what it is at every wavelength",
      {with(field("blackbody", FieldType::number, "",
                  "The light of a black body of this temperature, as bright as white."),
            {500, 1e5}, "kelvin"),
       loose,
       with(field("values", FieldType::numbers, "",
                  "At each of `wavelengths` a factor on white light: what a surface reflects, a filter lets "
                  "through."),
            at_least_zero, ""),
       with(
           field("power", FieldType::numbers, "",
                 "At each of `wavelengths` the power of a lamp, in any unit; it is made as bright as white."),
           at_least_zero, ""),
       with(field("intensity", FieldType::number, "1", "A factor on `blackbody` or `power`."), at_least_zero,
            "")});
  f.maps = section("maps", "images on a surface", {});
  for (const auto& [word, slot] : words_of<MapSlot>)
    f.maps.fields.push_back(field(word, FieldType::map, "", sentence_of(slot)));
  f.map = section(
      "map", "how an image lies on a surface",
      std::vector{
          required("file", FieldType::file, "The image, looked for beside the scene file."),
          choice(
              "encoding", {"srgb", "linear"}, "",
              "What the file's whole numbers mean: `srgb` for colors, `linear` for data; by the map's kind "
              "where not given. HDR and EXR are linear always."),
          choice("wrap", names_of<Wrap>(), text_of(Wrap::repeat), "How it goes on beyond its edges."),
          choice("filter", {"linear", "nearest"}, "linear",
                 "Whether there is a passage from texel to texel."),
          choice("channel", {"luminance", "r", "g", "b", "alpha"}, "luminance",
                 "Which of its numbers, where the map is one number."),
          with(field("uv_set", FieldType::integer, "0", "Which of the mesh's texture coordinates."), {0, 1},
               ""),
          field("scale", FieldType::uvs, "[1, 1]", "Factors on u and v, first of all.")} +
          fields_of<MapSettings>() +
          std::vector{field("offset", FieldType::uvs, "[0, 0]", "Added to u and v, last of all.")});
  f.material_name = required("name", FieldType::name, "What objects call it; each name once.");
  f.camera = section("camera", "where the picture is seen from",
                     std::vector{choice("projection", names_of<Projection>(), text_of(Camera{}.projection),
                                        "Whether distant things look smaller.")} +
                         fields_of<Camera>());
  const ImageSettings image;
  f.image = section(
      "image", "the picture's size and how its pixels are sampled",
      std::vector{with(field("size", FieldType::image_size,
                             fmt::format("[{}, {}]", image.width, image.height), "Width and height."),
                       {1, 65536}, "pixels"),
                  with(field("samples", FieldType::samples, fmt::to_string(image.samples),
                             "Rays through each pixel; with one, it goes through the centre. Or {adaptive: "
                             "{start, max, error}}: as many as each pixel needs."),
                       sample_range, "")} +
          std::vector{
              with(field("shutter_slices", FieldType::integer, fmt::to_string(image.shutter_slices),
                         "Where objects move: at how many moments, at most, they are seen while the shutter "
                         "is open. No more than there are samples."),
                   slice_range, ""),
              choice("filter", names_of<Filter>(), text_of(image.filter),
                     "How samples make a pixel: `box` is their mean, `tent` also weighs in those of the "
                     "neighbours."),
              choice(
                  "pattern", names_of<Pattern>(), text_of(image.pattern),
                  "Where samples lie: `stratified` spreads them evenly over each pixel, `corners` sends one "
                  "ray through each corner of the pixels and takes the mean of four."),
              choice("encoding", names_of<Encoding>(), text_of(image.encoding),
                     "What a PNG holds: `srgb` encodes the linear values for screens, `none` writes them as "
                     "they are, as "
                     "renderers once did. EXR is always linear.")});
  f.film = section("film", "what is kept of a picture beside its colours", fields_of<FilmSettings>());
  f.samples = section("samples", "how many samples a pixel gets, where it is not the same number for all",
                      {field("adaptive", FieldType::section, "", "As many as each pixel needs.")});
  f.adaptive = section("adaptive", "samples where the picture needs them", fields_of<AdaptiveSamples>());
  f.attenuation =
      section("attenuation", "1 / (constant + linear r + quadratic r^2)", fields_of<AttenuationSettings>());
  f.illumination = section(
      "illumination", "the equation and its choices, for the whole scene",
      std::vector{choice("model", names_of(f.models), info(Illumination{}.model).name,
                         "The illumination model of materials that name none."),
                  field("attenuation", FieldType::attenuation, "",
                        "How lights fade with their distance r: `none`, `1/r`, `1/r^2`, or a mapping "
                        "{constant, linear, quadratic} for "
                        "1 / (constant + linear r + quadratic r^2). The model's own where not given."),
                  choice("ambient_attenuation", names_of<AmbientAttenuation>(), "",
                         "What the ambient term is divided by: nothing, or R, the distance travelled since "
                         "the eye. The model's own where not given.")} +
          fields_of<Illumination>() +
          std::vector{field(
              "ambient_occlusion", FieldType::section, "",
              "Ambient light reaches a point only from where nothing stands in its way. Not given: from "
              "everywhere.")});
  f.ambient_occlusion =
      section("ambient_occlusion", "ambient light with soft shadows", fields_of<AmbientOcclusion>());
  Section whitted = section("whitted", "rays from the eye, mirrored and refracted on: Whitted's ray tracing",
                            fields_of<WhittedSettings>());
  whitted.source = "Whitted, An improved illumination model for shaded display, CACM 23(6), 1980";
  Field show = required("show", FieldType::choice, "What is made a colour.");
  show.choices = names_of<View>();
  Section view = section("view", "what eye rays meet first, as a colour, to look into a scene",
                         std::vector{show} + fields_of<ViewSettings>());
  // A picture of how many rays Whitted's tracing asks must say which.
  for (Field field : whitted.fields) {
    field.sentence = "Of the rays that `rays` counts, as in `whitted`. " + field.sentence;
    view.fields.push_back(std::move(field));
  }
  Section path =
      section("path", "paths of light by chance, as the rendering equation weighs them: path tracing",
              fields_of<PathSettings>());
  path.equation = "L(P, V) = Le(P, V) + integral over the sphere of  f(P, L, V) L(P, L) |N.L| dL";
  path.source = "Kajiya, The rendering equation, SIGGRAPH 1986";
  Section occlusion =
      section("ambient_occlusion", "white surfaces under a white, even sky: how open each place is",
              fields_of<AmbientOcclusion>());
  occlusion.equation = "A = 1 / pi  integral over the directions L above P of  V(P, L) (N.L)+ dL";
  occlusion.source =
      "Zhukov, Iones, Kronin, An ambient light illumination model, Eurographics Workshop on Rendering 1998";
  Section spectral = section(
      "spectral", "the same for each of a set of wavelengths, in place of red, green and blue",
      {with(field("wavelengths", FieldType::wavelengths, std::to_string(usual_wavelengths),
                  "How many, the middles of equal parts of 375 to 735 nm; or a list of them, growing."),
            seen, "nm")});
  spectral.source =
      "observer and white: CIE 1931 and D65; colours as spectra: Mallett and Yuksel, Spectral primary "
      "decomposition for rendering with sRGB reflectance, EGSR 2019";
  for (const Field& one : whitted.fields) spectral.fields.push_back(one);
  f.integrators = {whitted, spectral, path, occlusion, view};
  f.integrator = section(
      "integrator", "how rays are followed, and what is shown of them: one of these",
      {field("whitted", FieldType::section, "", "Rays from the eye, mirrored and refracted on."),
       field("spectral", FieldType::section, "", "The same with wavelengths in place of three colours."),
       field("path", FieldType::section, "", "All light there is, by chance: the rendering equation."),
       field("ambient_occlusion", FieldType::section, "",
             "No lights and no colours: how open to the sky each place is."),
       field("view", FieldType::section, "", "Not colours, but what the eye's rays meet first.")});
  f.light = section("light", "a light",
                    {field("name", FieldType::name, "",
                           "What it is called, once only; `light 1` and so on where not given.")});
  f.object =
      section("object", "a shape, its material and its place",
              {field("name", FieldType::name, "", "What it is called; `object 1` and so on where not given."),
               field("material", FieldType::material, "",
                     "A name from `materials`, or a material written out. Without it a mesh file keeps its "
                     "own, everything else is plain grey."),
               field("transform", FieldType::transform, "",
                     "Steps that move the object, applied in the order written; a single step may stand "
                     "without the list."),
               field("motion", FieldType::motion, "",
                     "What it does while the shutter is open, from where `transform` has placed it: steps, "
                     "each at a constant speed.")});
  f.rotate = section("rotate", "a turn about an axis",
                     std::vector{required("axis", FieldType::axis, "`x`, `y`, `z`, or a direction.")} +
                         fields_of<RotateSettings>());
  f.transform = section(
      "transform", "one step",
      {field("scale", FieldType::factors, "", "A factor, or one for each axis; not 0. Negative ones mirror."),
       field("rotate", FieldType::section, "", "A right-handed turn about an axis: {axis, degrees, center}."),
       with(field("translate", FieldType::point, "", "How far to move along x, y and z."), {}, "scene units"),
       field("matrix", FieldType::matrix, "",
             "Three rows of four numbers: the linear part and, last in each row, the translation.")});
  f.motion = section("motion", "one step of a motion",
                     {field("rotate", FieldType::section, "",
                            "A turn about an axis, at a constant speed: {axis, degrees, center}."),
                      with(field("translate", FieldType::point, "", "A straight way along x, y and z."), {},
                           "scene units")});
  f.top = section(
      "scene", "a scene file",
      {with(required("lambent", FieldType::integer, "The version of the format."), {1, 1}, ""),
       required("camera", FieldType::section, "Where the picture is seen from."),
       field("image", FieldType::section, "", "The picture's size and how its pixels are sampled."),
       field("film", FieldType::section, "", "What is kept of a picture beside its colours."),
       field("illumination", FieldType::section, "", "The equation and its choices, for the whole scene."),
       field("integrator", FieldType::section, "", "How rays are followed."),
       with(field("background", FieldType::background, text_of(Scene{}.background),
                  "What rays see that hit nothing: a color, or {file: NAME} for a picture all around."),
            at_least_zero, ""),
       field("fog", FieldType::section, "", "What colours fade into with distance. Not given: none."),
       field("lights", FieldType::sections, "", "The lights, in any number."),
       field("materials", FieldType::sections, "", "Materials that objects refer to by name."),
       field("objects", FieldType::sections, "", "What there is to see.")});
  return f;
}

}  // namespace

const Format& format() {
  static const Format the_format = make_format();
  return the_format;
}

Range limits(const Field& field) {
  const bool length = field.type == FieldType::point || field.type == FieldType::direction ||
                      field.type == FieldType::points || field.type == FieldType::directions ||
                      field.type == FieldType::vector || field.unit == "scene units";
  const double far = length ? largest_coordinate : largest_number;
  return {max(field.range.min, -far), min(field.range.max, far)};
}

std::string describe(const Range& range) {
  const bool below = std::isfinite(range.min) && range.min > -largest_coordinate;
  const bool above = std::isfinite(range.max) && range.max < largest_coordinate;
  if (below && above && range.min == range.max) return text_of(range.min);
  if (below && above) return text_of(range.min) + " to " + text_of(range.max);
  if (range.min == positive.min && !above) return "positive";
  if (below) return "at least " + text_of(range.min);
  if (above) return "at most " + text_of(range.max);
  return {};
}

std::string type_name(FieldType type) {
  switch (type) {
    case FieldType::number:
      return "number";
    case FieldType::integer:
      return "integer";
    case FieldType::boolean:
      return "boolean";
    case FieldType::color:
      return "color";
    case FieldType::vector:
      return "vector";
    case FieldType::point:
      return "point";
    case FieldType::direction:
      return "direction";
    case FieldType::choice:
      return "choice";
    case FieldType::name:
      return "text";
    case FieldType::file:
      return "file name";
    case FieldType::image_size:
      return "[width, height]";
    case FieldType::extent:
      return "[width, height]";
    case FieldType::points:
      return "list of points";
    case FieldType::triangles:
      return "list of [a, b, c]";
    case FieldType::directions:
      return "list of directions";
    case FieldType::uvs:
      return "list of [u, v]";
    case FieldType::factors:
      return "number or [x, y, z]";
    case FieldType::axis:
      return "x, y, z or direction";
    case FieldType::matrix:
      return "3 rows of 4 numbers";
    case FieldType::attenuation:
      return "choice or mapping";
    case FieldType::samples:
      return "integer or mapping";
    case FieldType::material:
      return "name or mapping";
    case FieldType::background:
      return "color or mapping";
    case FieldType::map:
      return "file name or mapping";
    case FieldType::substance:
      return "name or mapping";
    case FieldType::numbers:
      return "list of numbers";
    case FieldType::wavelengths:
      return "integer or list of numbers";
    case FieldType::transform:
    case FieldType::motion:
      return "step or list of steps";
    case FieldType::section:
      return "mapping";
    case FieldType::sections:
      return "list of mappings";
  }
  __builtin_unreachable();
}

std::vector<std::string> names_of(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const Field& one : fields) names.push_back(one.name);
  return names;
}
std::vector<std::string> names_of(const std::vector<Section>& sections) {
  std::vector<std::string> names;
  for (const Section& one : sections) names.push_back(one.name);
  return names;
}
const Field* find(const std::vector<Field>& fields, std::string_view name) {
  for (const Field& one : fields)
    if (one.name == name) return &one;
  return nullptr;
}

const Section* find(const std::vector<Section>& sections, std::string_view name) {
  for (const Section& one : sections)
    if (one.name == name) return &one;
  return nullptr;
}

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(const Vec3<double>& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
std::string text_of(const Rgb& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

}  // namespace lambent
