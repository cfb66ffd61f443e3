#include "scenefile/autoscene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>

#include <fmt/format.h>

#include "scenefile/yaml_text.h"

namespace lambent {
namespace {

// ---- what suits the model

/// The ball around a box. Never without size, so that everything can be measured by it.
struct Ball {
  Vec3<double> center{0, 0, 0};
  double radius = 1;
};
Ball ball_around(const Bounds& box) {
  if (box.empty()) return {};
  Ball ball{0.5 * box.lower + 0.5 * box.upper, 0.5 * length(box.upper - box.lower)};
  // A single point has no size; nor has what is too small for the float coordinates of meshes to tell apart.
  const double least = max(1e-6 * max_abs(ball.center), 1e-9);
  if (ball.radius < least) ball.radius = max(1e-3 * max_abs(ball.center), 1e-3);
  return ball;
}

/// Numbers for people: rounded to a hundred-thousandth of the model's size, far below a pixel.
class Rounding {
 public:
  explicit Rounding(double size) : decimals_(5 - int(std::floor(std::log10(size)))) {}
  double operator()(double value) const {
    if (decimals_ <= 0) {  // the shortest form of such a number is exact
      const double step = std::pow(10.0, -decimals_);
      return std::round(value / step) * step;
    }
    const std::string text = fmt::format("{:.{}f}", value, decimals_);
    double rounded = 0;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    return rounded + 0.0;  // no "-0"
  }
  Vec3<double> operator()(const Vec3<double>& v) const { return {(*this)(v.x), (*this)(v.y), (*this)(v.z)}; }

 private:
  int decimals_;
};

/// The directions of a picture in the world; unit vectors.
struct Frame {
  Vec3<double> right, up, backward;  ///< `backward` points to the eye.
};
Frame frame_of(const Vec3<double>& to_eye, const Vec3<double>& up) {
  const Vec3<double> backward = normalize(to_eye), right = normalize(cross(up, backward));
  return {right, cross(backward, right), backward};
}

/// The unit vector that is `azimuth` to the right of the camera, as the model sees it, and `elevation` above
/// it; degrees.
Vec3<double> direction(const Frame& frame, double azimuth, double elevation) {
  const auto [sin_a, cos_a] = sincos_degrees(azimuth);
  const auto [sin_e, cos_e] = sincos_degrees(elevation);
  return sin_a * cos_e * frame.right + sin_e * frame.up + cos_a * cos_e * frame.backward;
}

/// A way to look at a model. The angles are against its front.
struct NamedView {
  const char* name;
  double azimuth, elevation;  ///< Degrees.
  const char* comment;
};
constexpr NamedView views[] = {
    {"three-quarter", 30, 18, "From three quarters and a little above"},
    {"front", 0, 0, "From the front"},
    {"back", 180, 0, "From behind"},
    {"left", -90, 0, "From the left"},
    {"right", 90, 0, "From the right"},
    {"top", 0, 90, "From above"},
};
constexpr double camera_fov = 30;  // degrees

/// The model as one stands before it: x to the right, and its vertical up. Where z is up that is -y towards
/// the viewer, as in the front views of CAD.
Frame front_of(bool z_up) {
  if (z_up) return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

/// What is up in the picture of a view: the model's vertical, but not where one looks along it.
Vec3<double> up_in(const NamedView& view, const Frame& front) {
  return view.elevation == 90 ? -front.backward : front.up;
}

/// What the model's bounds take of the picture, in its tighter direction: a margin of 10 % remains.
constexpr double filled = 0.9;

/// The nearest camera of that view that has the whole box in its picture, in the middle.
Camera framing_camera(const NamedView& view, const Frame& front, const Bounds& box, const Ball& ball,
                      double aspect) {
  const Vec3<double> up = up_in(view, front);
  const Frame frame = frame_of(direction(front, view.azimuth, view.elevation), up);
  const auto [sin, cos] = sincos_degrees(camera_fov / 2);
  const double tan_y = filled * sin / cos, tan_x = tan_y * aspect;
  // With the eye at (x, y, d) along (right, up, backward) from the centre, a corner (a, b, c) is in the
  // picture where |a - x| <= tan_x (d - c) and |b - y| <= tan_y (d - c). So x lies between the largest a +
  // tan_x c less tan_x d and the least a - tan_x c plus tan_x d; the nearest d is where the two meet, for x
  // or for y.
  double a_max = -1e300, a_min = 1e300, b_max = -1e300, b_min = 1e300;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<double> p{corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                         corner & 4 ? box.upper.z : box.lower.z};
    const Vec3<double> way = p - ball.center;
    const double a = dot(way, frame.right), b = dot(way, frame.up), c = dot(way, frame.backward);
    a_max = max(a_max, a + tan_x * c), a_min = min(a_min, a - tan_x * c);
    b_max = max(b_max, b + tan_y * c), b_min = min(b_min, b - tan_y * c);
  }
  const double distance = max((a_max - a_min) / (2 * tan_x), (b_max - b_min) / (2 * tan_y));
  Camera camera;
  camera.target = ball.center + (a_max + a_min) / 2 * frame.right + (b_max + b_min) / 2 * frame.up;
  // A single point leaves the distance open.
  camera.eye = camera.target + max(distance, ball.radius) * frame.backward;
  camera.fov = camera_fov;
  camera.up = up;
  return camera;
}

InputError wrong_choice(const std::string& path, const std::string& message, const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  diagnostic.message = message;
  diagnostic.hint = hint;
  return InputError(diagnostic);
}

bool is_z_up(const Model& model, const ModelChoices& choices, const std::string& path) {
  if (choices.up.empty()) return model.z_up;
  if (choices.up != "y" && choices.up != "z")
    throw wrong_choice(path, "the axis that points up is y or z, not '" + choices.up + "'",
                       std::string("without --up it is ") + (model.z_up ? "z" : "y") + " here");
  return choices.up == "z";
}

/// The camera that is chosen: one of the file's, or a view, which then has the whole model in its picture.
struct Chosen {
  const Camera* own = nullptr;
  const NamedView* view = nullptr;
};
Chosen chosen_camera(const Model& model, const ModelChoices& choices, const std::string& path) {
  const std::string& wanted = choices.camera;
  if (wanted.empty())
    return model.cameras.empty() ? Chosen{nullptr, &views[0]} : Chosen{&model.cameras[0].camera, nullptr};
  for (const NamedCamera& camera : model.cameras)
    if (camera.name == wanted) return {&camera.camera, nullptr};
  std::size_t number = 0;
  const char* const end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), end, number);
  if (error == std::errc() && stop == end && number >= 1 && number <= model.cameras.size())
    return {&model.cameras[number - 1].camera, nullptr};
  std::string known;
  for (const NamedView& view : views) {
    if (view.name == wanted) return {nullptr, &view};
    known += (known.empty() ? "" : ", ") + std::string(view.name);
  }
  constexpr std::size_t most = 20;
  std::string own;
  for (std::size_t i = 0; i < model.cameras.size() && i < most; ++i)
    own += fmt::format("{}{}{}", own.empty() ? "" : ", ", i + 1,
                       model.cameras[i].name.empty() ? "" : " '" + model.cameras[i].name + "'");
  if (model.cameras.size() > most) own += fmt::format(" and {} more", model.cameras.size() - most);
  throw wrong_choice(path, "there is no camera '" + wanted + "'",
                     (own.empty() ? "the file has none of its own" : "the file has " + own) +
                         "; views of the whole model are " + known);
}

/// The bounds of all that the model shows.
Bounds bounds_of(const Model& model) {
  Bounds box;
  const auto add = [&](const Bounds& part) {
    if (part.empty()) return;
    box.add(part.lower);
    box.add(part.upper);
  };
  for (const ModelObject& object : model.objects)
    add(bounds(model.shapes[object.shape], object.world_from_object));
  if (model.objects.empty())
    for (const Shape& shape : model.shapes) add(bounds(shape));
  return box;
}

/// One of the three lights, as seen from the model.
struct Lamp {
  const char* name;
  double azimuth, elevation;  ///< Against the camera, degrees.
  double brightness;          ///< On a white surface that faces it, at the model's centre.
};
constexpr Lamp lamps[] = {
    {"key", -45, 40, 0.85},  // from the left and above: it shapes the model
    {"fill", 50, 20, 0.15},  // from the other side: the key's shadows are not black
    {"rim", 160, 50, 0.3},   // from behind: it parts the model from the background
};
constexpr double lamp_distance = 5;          // radii of the model, from its centre
constexpr double ambient_brightness = 0.15;  // on a white surface at the centre
// Of the background, and of the floor where no light reaches it any more: no edge shows.
constexpr double background_grey = 0.02;
constexpr double floor_grey = 0.3;
constexpr double occlusion_distance = 1;  // radii of the model
constexpr double floor_radius = 60;       // radii of the model

/// Whether a material mirrors what is around it.
bool shines(const Material& material) {
  return !is_black(material.reflect) ||
         (material.metallic_roughness &&
          (material.metallic_roughness->roughness < 0.7 ||
           std::any_of(material.maps.begin(), material.maps.end(),
                       [](const MaterialMap& one) { return one.slot == MapSlot::roughness; })));
}

/// The studio around the model, turned so that its lamps stand where the lights do.
std::string surroundings_text(const Camera& camera, const Frame& front) {
  const Vec3<double> way = camera.eye - camera.target;
  const double turn = std::round(std::atan2(dot(way, front.right), dot(way, front.backward)) * 180 / M_PI);
  return fmt::format("file: studio{}{}", front.up.z > 0.5 ? ", up: z" : "",
                     turn != 0 ? ", turn: " + text_of(turn) : "");
}

/// Contacts and folds darken softly; what stands far away does not matter.
std::string occlusion_text(const Ball& ball, const Rounding& rounded) {
  return fmt::format("  ambient_occlusion: {{rays: 2, distance: {}}}\n",
                     text_of(max(rounded(occlusion_distance * ball.radius), positive.min)));
}

/// The lights that shine on the model from around the camera, and the equation they are meant for.
std::string studio_text(ModelId model, const Camera& camera, const Frame& frame, const Ball& ball,
                        const Rounding& rounded) {
  const Vec3<double> to_eye = camera.eye - ball.center;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out,
      "# {}. As 1/r and 1/R depend on the unit of length, the ambient light is {}\n"
      "# times the camera's distance, and each light's intensity its brightness times its own distance.\n",
      model == ModelId::mtl ? "Wavefront's equation, that of MTL files, under the lecture's attenuations"
                            : "The lecture's equation",
      ambient_brightness);
  fmt::format_to(out, "illumination:\n  model: {}\n  attenuation: {}\n  ambient: {}\n", info(model).name,
                 text_of(attenuation_1_over_r),
                 text_of(grey(rounded(ambient_brightness * max(length(to_eye), ball.radius)))));
  fmt::format_to(out, "  ambient_attenuation: {}\n  minimum_distance: {}\n",
                 text_of(AmbientAttenuation::one_over_R),
                 text_of(max(rounded(1e-3 * ball.radius), positive.min)));
  text += occlusion_text(ball, rounded);
  fmt::format_to(out, "\n# {} radii from the model's centre.\nlights:\n", lamp_distance);
  for (const Lamp& lamp : lamps) {
    const double distance = lamp_distance * ball.radius;
    PointLight light;
    light.position = rounded(ball.center + distance * direction(frame, lamp.azimuth, lamp.elevation));
    light.intensity = rounded(lamp.brightness * distance);
    fmt::format_to(out, "  - {}\n", light_text({lamp.name, {}, light}, Wanted::what_differs));
  }
  return text;
}

/// The model's own lights, under the rules of the Standard Procedural Databases.
std::string spd_lights_text(const std::vector<Light>& lights) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out,
      "# The rules of the Standard Procedural Databases and their pictures: nothing fades, there is\n"
      "# no ambient light, what transmits casts a full shadow, and every surface that reflects or\n"
      "# transmits throws a mirror ray.\n");
  fmt::format_to(out,
                 "illumination:\n  model: {}\n  attenuation: {}\n  ambient: {}\n  ambient_attenuation: {}\n",
                 info(ModelId::phong).name, text_of(attenuation_none), text_of(Rgb{}),
                 text_of(AmbientAttenuation::none));
  fmt::format_to(out,
                 "integrator: {{whitted: {{max_depth: 5, colored_shadows: false, trace_black_rays: "
                 "true}}}}\n\nlights:\n");
  for (const Light& light : lights) fmt::format_to(out, "  - {}\n", light_text(light, Wanted::what_differs));
  return text;
}

constexpr double own_ambient = 0.05;  // beside the model's own lights

/// What a light brings to a white surface at `p` that faces it, all colours in one number; of a spot on its
/// axis, as if it shone there.
double brought_to(const Vec3<double>& p, const AnyLight& light, double least_distance) {
  return with_light(light, [&](const auto& one) {
    const double bright =
        one.intensity * (0.2126 * one.color[0] + 0.7152 * one.color[1] + 0.0722 * one.color[2]);
    if constexpr (requires { one.position; }) {
      const double r = max(length(one.position - p), least_distance);
      return bright / (r * r);
    } else {
      return bright;
    }
  });
}

/// The model's own lights, as bright together as a picture needs: files give them in units of their own, and
/// often far too bright or too dark.
std::string own_lights_text(const Model& model, const Ball& ball, const Rounding& rounded) {
  double total = 0;
  // A light in the very middle would count for all.
  for (const Light& light : model.lights) total += brought_to(ball.center, light.light, 0.1 * ball.radius);
  const double scale = total > 0 && std::isfinite(total) ? 1 / total : 1;
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(
      out,
      "# The file's own lights, which fade with 1/r^2. Their intensities are the file's times {:.6g}:\n"
      "# so that together they bring 1 to a white surface in the model's middle that faces them.\n",
      scale);
  fmt::format_to(out, "illumination:\n  model: {}\n  attenuation: {}\n  ambient: {}\n",
                 info(model.illumination).name, text_of(attenuation_1_over_r2), text_of(grey(own_ambient)));
  fmt::format_to(out, "  ambient_attenuation: {}\n  minimum_distance: {}\n",
                 text_of(AmbientAttenuation::none), text_of(max(rounded(1e-3 * ball.radius), positive.min)));
  text += occlusion_text(ball, rounded);
  fmt::format_to(out, "\nlights:\n");
  for (Light light : model.lights) {
    std::visit(
        [&](auto& one) {
          if constexpr (requires { one.intensity; }) one.intensity *= scale;
        },
        light.light);
    fmt::format_to(out, "  - {}\n", light_text(light, Wanted::what_differs));
  }
  return text;
}

/// Camera, lights and floor stand apart from the model, and must be in reach too.
void check_reach(const Camera& camera, const Ball& ball, const std::string& path) {
  const double reach =
      max(max_abs(camera.eye), max_abs(ball.center) + max(lamp_distance, floor_radius) * ball.radius);
  if (reach <= largest_coordinate) return;
  Diagnostic diagnostic;
  diagnostic.place.file = path;
  diagnostic.message =
      "the model is too large, or too far from the origin, for a camera and lights around it";
  diagnostic.hint =
      fmt::format("choose a larger unit of length: coordinates reach up to {}", largest_coordinate);
  throw InputError(diagnostic);
}

}  // namespace

ModelScene scene_for(const Model& model, const std::string& path, const ModelChoices& choices) {
  Bounds box = bounds_of(model);
  const Ball ball = ball_around(box);
  if (box.empty()) box = {ball.center, ball.center};
  const Rounding rounded(ball.radius);
  const bool own_lights = !model.lights.empty();
  const Frame front = front_of(is_z_up(model, choices, path));
  const Chosen chosen = chosen_camera(model, choices, path);

  ImageSettings image;
  image.width = choices.width, image.height = choices.height, image.samples = 16;
  if (model.image) image = *model.image;
  Camera camera;
  if (chosen.own != nullptr) {
    camera = *chosen.own;
  } else {
    camera = framing_camera(*chosen.view, front, box, ball, double(image.width) / image.height);
    camera.eye = rounded(camera.eye), camera.target = rounded(camera.target);
  }
  const bool studio = !own_lights;
  const bool floor = chosen.view != nullptr && studio && choices.ground;
  if (chosen.view != nullptr || studio) check_reach(camera, ball, path);

  ModelScene made;
  made.axis = {ball.center, front.up};
  const auto out = std::back_inserter(made.text);
  const std::string file = yaml_quoted(std::filesystem::path(path).filename().string());
  fmt::format_to(out, "# The model {} as `lambent render` shows it: a start for a scene of one's own.\n",
                 file);
  fmt::format_to(out, "lambent: 1\n\n");
  fmt::format_to(out, "# {}\ncamera: {{{}}}\n",
                 chosen.view != nullptr
                     ? std::string(chosen.view->comment) + "; all of the model is in the picture."
                     : "The file's own view.",
                 settings_text(camera, Wanted::what_differs));
  fmt::format_to(out, "image: {{size: [{}, {}], samples: {}, pattern: {}, encoding: {}}}\n", image.width,
                 image.height, image.samples, text_of(image.pattern), text_of(image.encoding));
  if (!choices.background.empty()) fmt::format_to(out, "background: {}\n", choices.background);
  else if (model.background) fmt::format_to(out, "background: {}\n", text_of(*model.background));
  else if (studio && std::any_of(model.materials.begin(), model.materials.end(), shines))
    fmt::format_to(out, "# For mirrors to see: lamps that turn with the camera.\nbackground: {{{}}}\n",
                   surroundings_text(camera, front));
  else if (chosen.view != nullptr && studio)
    fmt::format_to(out, "background: {}\n", text_of(grey(background_grey)));

  // Who looks from above still has the lamps stand around the model, not above and below it.
  const Frame lamps_frame = chosen.view != nullptr && chosen.view->elevation == 90
                                ? front
                                : frame_of(camera.eye - camera.target, camera.up);
  fmt::format_to(out, "\n{}",
                 studio            ? studio_text(model.illumination, camera, lamps_frame, ball, rounded)
                 : model.spd_rules ? spd_lights_text(model.lights)
                                   : own_lights_text(model, ball, rounded));

  fmt::format_to(
      out, "\n# The model brings its materials.\nobjects:\n  - {{name: model, mesh: {{file: {}}}}}\n", file);
  if (floor) {
    // A hair below the model, so that a flat one is not mixed up with its floor.
    const double lowest = dot(front.up, box.lower), middle = dot(front.up, ball.center);
    const Disc disc{rounded(ball.center + (lowest - 1e-3 * ball.radius - middle) * front.up), front.up,
                    rounded(floor_radius * ball.radius)};
    const std::string color = text_of(grey(floor_grey));
    // Far away nothing is left of the light on it: it ends in the background's colour.
    fmt::format_to(
        out, "  - {{name: floor, disc: {{{}}}, material: {{ambient: {}, diffuse: {}, emission: {}}}}}\n",
        settings_text(disc, Wanted::what_differs), color, color, text_of(grey(background_grey)));
  }
  return made;
}

}  // namespace lambent
