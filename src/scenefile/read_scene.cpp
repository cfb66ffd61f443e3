#include "scenefile/read_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "import/text_file.h"
#include "scenefile/nearest.h"
#include "scenefile/read_objects.h"
#include "scenefile/reader.h"
#include "scenefile/shape_settings.h"
#include "scenefile/studio.h"
#include "scenefile/textures.h"

namespace lambent {
namespace {

void warn(const Reader& reader, Scene& scene, const Node& at, std::string message, std::string hint) {
  Diagnostic warning = diagnostic_at(reader.document(), at, std::move(message), std::move(hint));
  warning.severity = Severity::warning;
  scene.warnings.push_back(std::move(warning));
}

/// Where the way from `eye` to `target` is zero, or `up` lies along it, there is no picture.
void check_view(Reader& reader, const Values& values, const Camera& camera) {
  const Vec3<double> way = camera.target - camera.eye;
  const Value* target = values.find("target");
  if (target == nullptr || values.find("eye") == nullptr) return;
  if (!(length(way) > 0)) {
    reader.error(target->place(), "'eye' and 'target' are the same point",
                 "the camera looks from one to the other");
    return;
  }
  // The sine of the angle between the two; what is smaller leaves no digits for the picture's upright.
  if (length(cross(normalize(way), normalize(camera.up))) > 1e-6) return;
  const Value* up = values.find("up");
  reader.error(up != nullptr ? up->place() : target->place(),
               "'up' lies along the way from 'eye' to 'target'",
               "to look straight up or down give another 'up', such as [0, 0, -1]");
}

void read_camera(Reader& reader, const Value& value, Scene& scene) {
  const auto& fields = format().camera.fields;
  const auto values = reader.mapping(value, fields, "the camera");
  if (!values) return;
  const bool good = reader.table(*values, fields, scene.camera);
  if (const Value* projection = values->find("projection"))
    reader.choice(*projection, scene.camera.projection);
  if (good) check_view(reader, *values, scene.camera);
  const bool flat = scene.camera.projection == Projection::orthographic;
  if (const Value* unused = values->find(flat ? "fov" : "height"))
    warn(reader, scene, *unused->key,
         fmt::format("{} has no effect: the camera is {}", unused->label, text_of(scene.camera.projection)),
         flat ? "the size of an orthographic picture is its 'height'"
              : "the size of a perspective picture is its 'fov'");
  const Value* focus = values->find("focus_distance");
  if (focus != nullptr && scene.camera.focus_distance > 0 && scene.camera.aperture == 0)
    warn(reader, scene, *focus->key, "'focus_distance' has no effect: the camera is a pinhole",
         "'aperture', the diameter of the lens, blurs what is not in focus");
}

void read_samples(Reader& reader, const Value& value, ImageSettings& image) {
  if (value.node->kind != Node::Kind::mapping) {
    reader.integer(value, sample_range, image.samples);
    return;
  }
  const auto ways = reader.mapping(value, format().samples.fields, "the samples");
  if (!ways) return;
  const Value* adaptive = ways->find("adaptive");
  if (adaptive == nullptr) {
    if (!ways->unknown_keys)
      reader.error(value.place(), "the samples are neither a number nor 'adaptive'",
                   "for example samples: {adaptive: {error: 1}}");
    return;
  }
  AdaptiveSamples settings;
  const auto& fields = format().adaptive.fields;
  if (adaptive->node->kind != Node::Kind::nothing) {
    const auto values = reader.mapping(*adaptive, fields, "adaptive samples");
    if (!values || !reader.table(*values, fields, settings)) return;
    if (settings.max < settings.start) {
      const Value* max = values->find("max");
      reader.error((max ? *max : *values->find("start")).place(),
                   fmt::format("at most {} samples, but {} to start with", settings.max, settings.start),
                   "'max' is at least 'start'");
      return;
    }
  }
  image.adaptive = settings;
}

void read_image(Reader& reader, const Value& value, ImageSettings& image) {
  constexpr double most_pixels = 268435456;  // 2^28: three floats each are 3 GiB
  const auto& fields = format().image.fields;
  const auto values = reader.mapping(value, fields, "the image");
  if (!values) return;
  if (const Value* samples = values->find("samples")) read_samples(reader, *samples, image);
  if (const Value* filter = values->find("filter")) reader.choice(*filter, image.filter);
  if (const Value* pattern = values->find("pattern")) {
    reader.choice(*pattern, image.pattern);
    // Corners have no number of samples: one that comes from outside, as --samples, puts the other pattern in
    // the place of the file's.
    const Value* samples = values->find("samples");
    if (samples != nullptr && samples->node->source > 0 && pattern->node->source == 0)
      image.pattern = Pattern::stratified;
  }
  if (const Value* encoding = values->find("encoding")) reader.choice(*encoding, image.encoding);
  if (const Value* slices = values->find("shutter_slices"))
    reader.integer(*slices, slice_range, image.shutter_slices);
  const Value* size = values->find("size");
  if (size == nullptr) return;
  const auto sides = reader.list(*size, "side");
  if (!sides) return;
  if (sides->size() != 2) {
    reader.error(*size->node, fmt::format("'size' must be [width, height], not a list of {}", sides->size()));
    return;
  }
  const Range range = limits(*find(fields, "size"));
  Value width = (*sides)[0], height = (*sides)[1];
  width.label = "the width";
  height.label = "the height";
  width.key = height.key = size->node;
  const bool good = reader.integer(width, range, image.width);
  if (!reader.integer(height, range, image.height) || !good) return;
  if (double(image.width) * image.height > most_pixels)
    reader.error(*size->node, fmt::format("an image of {} by {} is too large", image.width, image.height),
                 fmt::format("{} pixels at most", std::int64_t(most_pixels)));
}

void read_attenuation(Reader& reader, const Value& value, Illumination& illumination) {
  if (value.node->kind != Node::Kind::mapping) {
    Attenuation word;
    const bool text = value.node->kind == Node::Kind::text;
    if (!text) {
      reader.error(value.place(),
                   value.label + (value.node->kind == Node::Kind::nothing
                                      ? " has no value"
                                      : " must be a word or a mapping, not a list"),
                   "it is one of: " + join(names_of<Attenuation>()) + ", {constant, linear, quadratic}");
      return;
    }
    if (reader.choice(value, word)) illumination.attenuation = word;
    return;
  }
  const auto& fields = format().attenuation.fields;
  const auto values = reader.mapping(value, fields, "an attenuation");
  if (!values) return;
  AttenuationSettings settings;
  if (!reader.table(*values, fields, settings) || values->unknown_keys) return;
  if (settings.constant == 0 && settings.linear == 0 && settings.quadratic == 0) {
    reader.error(value.place(), "'constant', 'linear' and 'quadratic' are all 0",
                 "for lights that do not fade write: attenuation: none");
    return;
  }
  illumination.attenuation = Attenuation{settings.constant, settings.linear, settings.quadratic};
}

void read_illumination(Reader& reader, const Value& value, Illumination& illumination) {
  const auto& fields = format().illumination.fields;
  const auto values = reader.mapping(value, fields, "the illumination");
  if (!values) return;
  reader.table(*values, fields, illumination);
  illumination.spectra = reader.spectra<Illumination>(*values);
  if (const Value* occlusion = values->find("ambient_occlusion")) {
    illumination.occlusion.emplace();
    const auto& own = format().ambient_occlusion.fields;
    if (const auto settings = reader.mapping(*occlusion, own, "the ambient occlusion"))
      reader.table(*settings, own, *illumination.occlusion);
  }
  if (const Value* model = values->find("model")) {
    std::string word;
    if (reader.one_of(*model, names_of(format().models), word))
      for (int i = 0; i < model_count; ++i)
        if (word == model_infos[i].name) illumination.model = ModelId(i);
  }
  if (const Value* attenuation = values->find("attenuation"))
    read_attenuation(reader, *attenuation, illumination);
  if (const Value* ambient = values->find("ambient_attenuation")) {
    AmbientAttenuation word{};
    if (reader.choice(*ambient, word)) illumination.ambient_attenuation = word;
  }
}

/// The light whose N.L a view shows: one by name, or the only one there is. The lights have been read.
void choose_light(Reader& reader, const Values& values, const std::vector<Light>& lights,
                  ViewSettings& view) {
  std::vector<std::string> names;
  for (const Light& light : lights) names.push_back(light.name);
  if (const Value* given = values.find("light")) {
    if (!view.light.empty() && std::find(names.begin(), names.end(), view.light) == names.end())
      reader.error(given->place(), "there is no light '" + view.light + "'",
                   names.empty() ? "the scene has no lights" : suggestion(view.light, names));
  } else if (view.show == View::cosine && names.size() == 1) {
    view.light = names[0];
  } else if (view.show == View::cosine) {
    reader.error(values.find("show")->place(), "the view 'cosine' needs 'light': it shows N.L of one light",
                 names.empty()
                     ? "the scene has no lights"
                     : "integrator: {view: {show: cosine, light: NAME}}, with NAME one of: " + join(names));
  }
}

/// The settings of the integrator `name`, from its table.
template <class Settings>
std::optional<Values> read_settings(Reader& reader, const std::string& name, const Value& value,
                                    Settings& settings) {
  const auto& fields = find(format().integrators, name)->fields;
  auto values = reader.mapping(value, fields, "the integrator " + name);
  if (values) reader.table(*values, fields, settings);
  return values;
}

void read_spectral(Reader& reader, const Value& value, Scene& scene) {
  const auto values = read_settings(reader, "spectral", value, scene.whitted);
  if (!values) return;
  const Value* wavelengths = values->find("wavelengths");
  if (wavelengths == nullptr) return;
  int count = 0;
  if (wavelengths->node->kind == Node::Kind::list) {
    if (auto list = reader.wavelengths(*wavelengths)) scene.spectral.wavelengths = std::move(*list);
    if (scene.spectral.wavelengths.size() > std::size_t(most_wavelengths))
      reader.error(*wavelengths->node, fmt::format("'wavelengths' are {}", scene.spectral.wavelengths.size()),
                   fmt::format("there may be {}", most_wavelengths));
  } else if (reader.integer(*wavelengths, {1, most_wavelengths}, count)) {
    scene.spectral.wavelengths = even_wavelengths(count);
  }
}

void read_view(Reader& reader, const Value& value, Scene& scene) {
  const auto values = read_settings(reader, "view", value, scene.view);
  if (!values) return;
  reader.table(*values, find(format().integrators, "view")->fields, scene.whitted);
  const Value* show = values->find("show");
  if (show != nullptr && reader.choice(*show, scene.view.show))
    choose_light(reader, *values, scene.lights, scene.view);
}

/// Which text said the latest of what stands in a value: 0 is the file, others come from outside.
int newest_source(const Node& node) {
  int newest = node.source;
  for (const Node* child : node.children) newest = std::max(newest, newest_source(*child));
  return newest;
}

/// One of them. But settings from outside put their integrator in the place of the file's; a view then counts
/// rays by the `whitted` that is there, too.
void read_integrator(Reader& reader, const Value& value, Scene& scene) {
  const auto values = reader.mapping(value, format().integrator.fields, "the integrator");
  if (!values) return;
  if (values->values.empty() && !values->unknown_keys)
    reader.error(value.place(), "'integrator' names none",
                 "it is one of: " + join(names_of(format().integrators)));
  const Value* chosen = nullptr;
  int chosen_source = -1;
  for (const Value& one : values->values) {
    const int source = std::max(one.key->source, newest_source(*one.node));
    if (chosen != nullptr && source == chosen_source && source == one.key->source &&
        source == chosen->key->source) {
      reader.error(
          *one.key, one.label + " stands beside " + chosen->label,
          "a picture is made by one of them; 'lambent render --integrator' and '--view' show any scene "
          "by others");
      return;
    }
    const bool counts_rays = chosen != nullptr && chosen_source > 0 && chosen->key->text == "view";
    if (source > chosen_source && !(counts_rays && one.key->text == "whitted"))
      chosen = &one, chosen_source = source;
    else if (source > 0 && one.key->text == "view" && chosen->key->text == "whitted") chosen = &one;
  }
  for (const Value& one : values->values)
    if (one.key->text == "whitted") read_settings(reader, "whitted", one, scene.whitted);
  if (chosen == nullptr) return;
  scene.integrator = *meaning_of<Integrator>(chosen->key->text);
  if (scene.integrator == Integrator::view) read_view(reader, *chosen, scene);
  if (scene.integrator == Integrator::spectral) read_spectral(reader, *chosen, scene);
  if (scene.integrator == Integrator::path) read_settings(reader, "path", *chosen, scene.path);
  if (scene.integrator == Integrator::ambient_occlusion)
    read_settings(reader, "ambient_occlusion", *chosen, scene.ambient_occlusion);
}

/// Of integrators that choose directions by chance or by hash: many samples where none are given. Those of
/// paths are spread over the pixel whatever the pattern.
void settle_samples(Reader& reader, const Value* given, Integrator integrator, ImageSettings& image) {
  constexpr int usual = 64;
  const Node* samples = given != nullptr ? value_of(*given->node, "samples") : nullptr;
  if (samples == nullptr) image.samples = usual;
  if (integrator != Integrator::path) return;
  if (image.adaptive && samples != nullptr)
    reader.error(*samples, "adaptive samples are for integrators without noise",
                 "for 'path' write integrator: {path: {until: 0.01}}: samples until the noise is 1 %");
  image.pattern = Pattern::stratified;
}

/// Where something moves, the samples of each pixel are dealt over the time that the shutter is open.
void check_motion(Reader& reader, const Value* given, Scene& scene) {
  if (!is_moving(scene) || scene.integrator == Integrator::view) return;
  const auto find = [&](const char* key) { return given != nullptr ? value_of(*given->node, key) : nullptr; };
  const char* remedy = "give a number of them for all pixels: samples: 64";
  if (const Node* samples = find("samples"); scene.image.is_adaptive() && samples != nullptr)
    reader.error(*samples, "adaptive samples do not see what moves", remedy);
  else if (const Node* pattern = find("pattern");
           scene.image.pattern == Pattern::corners && pattern != nullptr)
    reader.error(*pattern, "'pattern: corners' takes one sample of each corner, which sees nothing move",
                 "leave the pattern out, and give samples: 64");
  else if (scene.image.samples == 1 || scene.image.shutter_slices == 1) {
    Diagnostic warning;
    warning.severity = Severity::warning;
    warning.place.file = reader.document().sources[0].name;
    warning.message = scene.image.samples == 1
                          ? "nothing is blurred by its motion: each pixel has one sample"
                          : "nothing is blurred by its motion: the shutter has one slice";
    warning.hint = scene.image.samples == 1 ? "image: {samples: 64}, or --samples 64" : "";
    scene.warnings.push_back(std::move(warning));
  }
}

/// A name that may be given once only; the default where none is given.
std::string unique_name(Reader& reader, const Values& values, std::string default_name,
                        std::map<std::string, int>& taken) {
  std::string name = std::move(default_name);
  const Value* given = values.find("name");
  if (given == nullptr || !reader.text(*given, "text", name)) return name;
  const auto [first, is_new] = taken.emplace(name, given->node->line);
  if (!is_new)
    reader.error(*given->node, "the name '" + name + "' is taken",
                 first->second > 0 ? fmt::format("the first is in line {}; choose another", first->second)
                                   : "choose another");
  return name;
}

template <class L> void read_light_of(Reader& reader, const Value& value, const Section& section, Light& to) {
  const auto values = reader.mapping(value, section.fields, "a " + section.name + " light");
  if (!values) return;
  L light;
  const bool good = reader.table(*values, section.fields, light);
  // Every light with a position and a target shines from one to the other.
  if constexpr (requires { light.target - light.position; }) {
    const Value* target = values->find("target");
    if (good && target != nullptr && values->find("position") != nullptr && light.target == light.position)
      reader.error(target->place(), "'position' and 'target' are the same point",
                   "the light shines from one to the other");
  }
  // A flat light with sides lies between them.
  if constexpr (requires { cross(light.u, light.v); }) {
    const Value* v = values->find("v");
    // The sine of the angle between the two; what is smaller leaves no digits for where the light faces.
    if (good && v != nullptr && values->find("u") != nullptr &&
        !(length(cross(normalize(light.u), normalize(light.v))) > 1e-6))
      reader.error(v->place(), "'v' lies along 'u': the light has no area",
                   "they are the light's sides; of a rectangle they are at a right angle");
  }
  to.light = light;
  to.spectra = reader.spectra<L>(*values);
}

void read_light(Reader& reader, const Value& value, std::size_t number, Scene& scene,
                std::map<std::string, int>& taken) {
  const Format& f = format();
  std::vector<Field> fields = f.light.fields;
  for (const Section& kind : f.lights) fields.emplace_back().name = kind.name;
  const auto values = reader.mapping(value, fields, "a light");
  if (!values) return;
  Light light;
  light.name = unique_name(reader, *values, fmt::format("light {}", number), taken);
  light.place = place_of(reader.document(), *value.node);
  const Value* first = nullptr;
  for (const Value& one : values->values) {
    if (one.key->text == "name") continue;
    if (first != nullptr) {
      reader.error(*one.key, one.label + " stands beside " + first->label,
                   "a light is of one kind; make it a second light");
      continue;
    }
    first = &one;
#define LAMBENT_LIGHT(word, Struct)       \
  if (one.key->text == Struct::info.name) \
    read_light_of<Struct>(reader, one, *find(f.lights, Struct::info.name), light);
#include "lights/lights.def"
#undef LAMBENT_LIGHT
  }
  if (first == nullptr && !values->unknown_keys)
    reader.error(*value.node, "this light has no kind", "it is one of: " + join(names_of(f.lights)));
  scene.lights.push_back(std::move(light));
}

void read_background(Reader& reader, const Value& value, const Files& files, Scene& scene) {
  if (value.node->kind != Node::Kind::mapping) {
    reader.color(value, limits(*find(format().top.fields, "background")), scene.background);
    return;
  }
  const auto& fields = format().background.fields;
  const auto values = reader.mapping(value, fields, "the background");
  if (!values) return;
  scene.background = grey(1.0);
  if (const Value* color = values->find("color"))
    reader.color(*color, limits(*find(fields, "color")), scene.background);
  if (const Value* turn = values->find("turn"))
    reader.number(*turn, limits(*find(fields, "turn")), scene.background_turn);
  std::string up;
  if (const Value* value_of_up = values->find("up"))
    if (reader.one_of(*value_of_up, {"y", "z"}, up)) scene.background_z_up = up == "z";
  const Value* file = values->find("file");
  if (file == nullptr) return;
  if (file->node->kind == Node::Kind::text && file->node->text == "studio") {
    scene.background_image = std::uint32_t(scene.textures.size());
    scene.textures.push_back(studio_texture());
  } else {
    scene.background_image = read_image_file(reader, *file, true, files, scene.textures);
  }
}

void read_materials(Reader& reader, const Value& value, const Files& files, Scene& scene) {
  const auto list = reader.list(value, "material");
  if (!list) return;
  std::vector<Field> fields{format().material_name};
  fields.insert(fields.end(), format().material.fields.begin(), format().material.fields.end());
  std::map<std::string, int> taken;
  for (const Value& one : *list) {
    Material material;
    if (one.node->kind == Node::Kind::mapping) {
      // Its name first: even a material with errors is known by it, so that objects do not complain as well.
      read_material(reader, one, fields, "a material", scene.illumination, files, scene.textures, material);
      const Node* given = value_of(*one.node, "name");
      if (given == nullptr) continue;
      Values values;
      values.values.push_back({given, one.node->children[0], "'name'"});
      for (std::size_t k = 0; k + 1 < one.node->children.size(); k += 2)
        if (one.node->children[k]->text == "name") values.values[0].key = one.node->children[k];
      material.name = unique_name(reader, values, {}, taken);
      if (!material.name.empty()) scene.materials.push_back(std::move(material));
    } else {
      reader.mapping(one, fields, "a material");  // which says what is wrong
    }
  }
}

void read_version(Reader& reader, const Value& value) {
  int version = 0;
  if (reader.integer(value, {}, version) && version != 1)
    reader.error(*value.node,
                 fmt::format("this is version {} of the format; only version 1 is known", version),
                 "write lambent: 1");
}

/// Scene files that show others, while one is read.
struct Nesting {
  int depth = 0;
  std::uint64_t read = 0;         ///< How many of them, since the first one was opened.
  std::vector<std::string> open;  ///< Their paths.
};
thread_local Nesting nesting;
/// Two files on each of thirty levels would be read a billion times.
constexpr std::uint64_t most_nested = 4096;

}  // namespace

Scene read_scene(const Document& document, const std::string& folder, LoadedModels models,
                 const ImportOptions& import) {
  struct Level {
    Level() {
      if (nesting.depth++ == 0) nesting.read = 0;
    }
    ~Level() { --nesting.depth; }
  } level;
  const Files files{folder, import};
  Reader reader(document);
  Scene scene;
  const Format& f = format();
  Node start;  // of an empty document
  start.kind = Node::Kind::mapping;
  static_cast<Spot&>(start) = {1, 1, 1};
  const Value whole{
      document.root != nullptr && document.root->kind != Node::Kind::nothing ? document.root : &start,
      nullptr, "the scene"};
  const auto top = reader.mapping(whole, f.top.fields, "a scene");
  if (top) {
    if (const Value* v = top->find("lambent")) read_version(reader, *v);
    if (const Value* v = top->find("camera")) read_camera(reader, *v, scene);
    if (const Value* v = top->find("image")) read_image(reader, *v, scene.image);
    if (const Value* v = top->find("film"))
      if (const auto film = reader.mapping(*v, f.film.fields, "the film"))
        reader.table(*film, f.film.fields, scene.film);
    if (const Value* v = top->find("illumination")) read_illumination(reader, *v, scene.illumination);
    if (const Value* v = top->find("background")) read_background(reader, *v, files, scene);
    if (const Value* v = top->find("fog"))
      if (const auto fog = reader.mapping(*v, f.fog.fields, "the fog"))
        reader.table(*fog, f.fog.fields, scene.fog);
    if (const Value* v = top->find("lights"))
      if (const auto lights = reader.list(*v, "light")) {
        std::map<std::string, int> taken;
        for (std::size_t i = 0; i < lights->size(); ++i)
          read_light(reader, (*lights)[i], i + 1, scene, taken);
      }
    if (const Value* v = top->find("integrator")) read_integrator(reader, *v, scene);
    if (const Value* v = top->find("materials")) read_materials(reader, *v, files, scene);
    if (const Value* v = top->find("objects"))
      if (const auto objects = reader.list(*v, "object")) {
        ObjectReader object_reader(reader, scene, folder, std::move(models), import);
        for (std::size_t i = 0; i < objects->size(); ++i)
          object_reader.object((*objects)[i], fmt::format("object {}", i + 1));
      }
    if (scene.integrator == Integrator::path || scene.integrator == Integrator::ambient_occlusion)
      settle_samples(reader, top->find("image"), scene.integrator, scene.image);
    check_motion(reader, top->find("image"), scene);
    if (scene.integrator == Integrator::view && scene.film.layers)
      reader.error(*value_of(*top->find("film")->node, "layers"), "a view has no layers",
                   "layers are what the colours of 'whitted' are made of; leave out one of the two");
  }
  if (!reader.good()) throw InputError(reader.errors());
  load_textures(scene, import.limits);
  std::vector<Diagnostic> faults = validate(scene);
  if (!faults.empty()) {
    show_lines(document, faults);
    throw InputError(std::move(faults));
  }
  return scene;
}

Model import_scene(const std::string& path, const ImportOptions& import) {
  const auto refuse = [&](const std::string& message) {
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = message;
    throw InputError(diagnostic);
  };
  // Scenes that show each other would never end.
  const std::string key = std::filesystem::weakly_canonical(path).string();
  if (std::find(nesting.open.begin(), nesting.open.end(), key) != nesting.open.end())
    refuse("this scene file shows itself, by way of 'scene'");
  if (++nesting.read > most_nested)
    refuse(fmt::format("scenes show scenes more than {} times over", most_nested));
  nesting.open.push_back(key);
  struct Close {
    ~Close() { nesting.open.pop_back(); }
  } close;
  Scene scene = read_scene(parse_yaml(read_file(path), path),
                           std::filesystem::path(path).parent_path().string(), {}, import);
  Model model;
  model.textures = std::move(scene.textures);
  model.shapes = std::move(scene.shapes);
  model.warnings = std::move(scene.warnings);
  for (Object& object : scene.objects) {
    if (!object.motion.empty()) {
      Diagnostic warning;
      warning.severity = Severity::warning;
      warning.place = object.place;
      warning.message = "'" + object.name + "' stands still where another scene shows it";
      warning.hint = "give the object that shows this scene a 'motion'";
      model.warnings.push_back(std::move(warning));
    }
    model.objects.push_back(
        {std::move(object.name), object.shape, object.world_from_object, std::move(object.materials)});
  }
  for (Material& material : scene.materials) {
    material.model = model_of(scene, material);  // as the file means it
    model.materials.push_back(std::move(material));
  }
  if (model.objects.empty()) {
    Diagnostic diagnostic;
    diagnostic.place.file = path;
    diagnostic.message = "the scene has no objects";
    throw InputError(diagnostic);
  }
  return model;
}

}  // namespace lambent
