// NFF, the Neutral File Format of Haines' Standard Procedural Databases.
// Source: E. Haines, Neutral File Format, version 3.9, 1996.
//
// A statement is a keyword and its numbers; line breaks mean nothing but the end of a comment. So the file is
// read as a stream of words. What the text leaves open, and how it is read here:
//   - A negative radius shows only the inside; surfaces here have two sides, so its absolute value is taken.
//   - `hither` cuts nothing off. Pixels are square, and `angle` is the vertical one.
//   - Lights have "no particular value"; the databases' text proposes sqrt(n)/(2n) for each of n lights and
//     for the ambient light. Haines' own pictures were made otherwise: measured in them, each light is
//     1/sqrt(n), there is no ambient light, highlights are white, and the sums stand in the files as they
//     are, not encoded for a screen. The pictures are what people compare with, so that is done here; the
//     automatic scene says so, where it can be changed.
//   - Objects before the first `f` are of a neutral grey, with a warning.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "import/model.h"
#include "import/text_file.h"
#include "scene/triangulate.h"

namespace lambent {
namespace {

struct Statement {
  std::string_view keyword;
  const char* usage;
};
constexpr Statement statements[] = {
    {"v", "v from X Y Z at X Y Z up X Y Z angle DEGREES hither DISTANCE resolution WIDTH HEIGHT"},
    {"b", "b R G B"},
    {"l", "l X Y Z [R G B]"},
    {"f", "f R G B Kd Ks Shine T ior"},
    {"c", "c X Y Z radius X Y Z radius"},
    {"s", "s X Y Z radius"},
    {"p", "p N, then N times X Y Z"},
    {"pp", "pp N, then N times X Y Z and the normal's X Y Z"},
};
const Statement* find_statement(std::string_view word) {
  for (const Statement& statement : statements)
    if (statement.keyword == word) return &statement;
  return nullptr;
}

/// The words of a file, comments left out.
class Words {
 public:
  explicit Words(const TextFile& file) : lines_(file.text), end_(end_of(file.text)) {}

  /// The next word, without taking it; at the end of the file an empty view just behind the last word.
  std::string_view peek() {
    while (word_.empty()) {
      if (ended_ || !lines_.next()) {
        ended_ = true;
        return end_;
      }
      rest_ = lines_.line.substr(0, lines_.line.find('#'));
      word_ = next_word(rest_);
      first_of_line_ = true;
      line_ = lines_.number;
    }
    return word_;
  }
  std::string_view take() {
    const std::string_view word = peek();
    if (ended_) return word;
    word_ = next_word(rest_);
    first_of_line_ = false;
    return word;
  }
  bool ended() { return peek(), ended_; }
  /// Whether the word that peek() shows is the first of its line.
  bool first_of_line() { return peek(), first_of_line_; }
  /// Line of the word that peek() shows.
  int line() { return peek(), line_; }

 private:
  LineReader lines_;
  std::string_view rest_, word_, end_;
  bool ended_ = false, first_of_line_ = false;
  int line_ = 0;
};

/// What a number is for, in words; put together only when a message needs it.
struct Wanted {
  const char* what;
  char component = 0;     ///< 'x' of `what`, or none.
  std::size_t index = 0;  ///< Which one of a polygon's vertices, from 1, or none.
  std::size_t count = 0;
};
std::string to_string(const Wanted& wanted) {
  const char* const article = wanted.index ? "" : "the ";
  std::string text =
      wanted.component ? fmt::format("{} of {}{}", wanted.component, article, wanted.what) : wanted.what;
  if (wanted.index) text += fmt::format(" {} of {}", wanted.index, wanted.count);
  return text;
}

class Reader {
 public:
  Reader(const std::string& path, const Limits& limits)
      : file_(read_text_file(path)), words_(file_), limits_(limits) {}

  Model read() {
    std::vector<Diagnostic> errors;
    constexpr std::size_t most_errors = 20;  // a file that is no NFF at all should not fill the screen
    while (!words_.ended() && errors.size() < most_errors && !limit_reached_) {
      try {
        statement();
      } catch (const InputError& error) {
        errors.insert(errors.end(), error.diagnostics().begin(), error.diagnostics().end());
        skip_to_next_statement();
      }
    }
    if (limit_reached_) errors.push_back(*std::move(limit_reached_));
    if (errors.empty() && spheres_.empty() && cones_.empty() && mesh_.triangles.empty())
      errors.push_back(error_at(file_, words_.peek(), "the file holds no object",
                                "a model needs at least one of the statements s, c, p and pp"));
    if (!errors.empty()) throw InputError(std::move(errors));
    return finish();
  }

 private:
  [[noreturn]] void fail(std::string_view word, std::string message, std::string hint = {}) const {
    throw InputError(error_at(file_, word, std::move(message), std::move(hint)));
  }

  // After an error, goes on where a line begins with a statement's keyword, to find what else is wrong.
  void skip_to_next_statement() {
    while (!words_.ended() && !(words_.first_of_line() && find_statement(words_.peek()))) words_.take();
  }

  void statement() {
    const int line = words_.line();
    const bool first_of_line = words_.first_of_line();
    const std::string_view word = words_.take();
    const Statement* const found = find_statement(word);
    if (!found) {
      if (last_ && (!first_of_line || parse_number(word)))
        fail(word, fmt::format("unexpected {} behind the statement '{}'", in_quotes(word), last_->keyword),
             fmt::format("it is written: {}{}", last_->usage,
                         last_->keyword == "f" ? "; NFF has no textures" : ""));
      fail(word, fmt::format("unknown statement {}", in_quotes(word)),
           "NFF has the statements v, b, l, f, c, s, p and pp");
    }
    last_ = found;
    keyword_ = word;
    if (word == "v") view();
    else if (word == "b") background();
    else if (word == "l") light(line);
    else if (word == "f") fill(line);
    else if (word == "c") cone();
    else if (word == "s") sphere();
    else polygon(word == "pp");
    if (spheres_.size() + cones_.size() + mesh_.triangles.size() > limits_.primitives) {
      // Not to be collected among others: reading ends here.
      limit_reached_ = error_at(
          file_, word,
          fmt::format("more than {} spheres, cones and triangles, which is the limit", limits_.primitives));
    }
  }

  // ---- words and numbers

  std::string_view take(const Wanted& wanted) {
    const std::string_view word = words_.take();
    if (word.empty())
      fail(word, fmt::format("the file ends before the {}", to_string(wanted)),
           fmt::format("it is written: {}", last_->usage));
    return word;
  }
  [[noreturn]] void fail_number(std::string_view word, const Wanted& wanted, const char* kind) const {
    fail(word, fmt::format("expected {} for the {}, found {}", kind, to_string(wanted), in_quotes(word)),
         fmt::format("it is written: {}", last_->usage));
  }
  double number(const Wanted& wanted, Range range = {}) {
    // The statement that comes too early must stay: it is read after the error.
    const std::string_view next = words_.peek();
    const auto value = parse_number(next);
    if (!value && !next.empty()) fail_number(next, wanted, "a number");
    const std::string_view word = take(wanted);
    if (*value >= range.min && *value <= range.max) return *value;
    fail(word, fmt::format("the {} is {}; it must be from {} to {}", to_string(wanted), *value, range.min,
                           range.max));
  }
  std::int64_t integer(const Wanted& wanted) {
    const std::string_view next = words_.peek();
    const auto value = parse_integer(next);
    if (!value && !next.empty()) fail_number(next, wanted, "an integer");
    take(wanted);
    return *value;
  }
  Vec3<double> vector(Wanted wanted, Range range = {}) {
    Vec3<double> v;
    wanted.component = 'x', v.x = number(wanted, range);
    wanted.component = 'y', v.y = number(wanted, range);
    wanted.component = 'z', v.z = number(wanted, range);
    return v;
  }
  Vec3<double> point(const Wanted& wanted) {
    return vector(wanted, {-largest_coordinate, largest_coordinate});
  }
  Rgb color() {
    Rgb c;
    c[0] = number({"red"}, factors);
    c[1] = number({"green"}, factors);
    c[2] = number({"blue"}, factors);
    return c;
  }

  // ---- statements

  void view() {
    if (!model_.cameras.empty()) fail(keyword_, "a second view 'v'", "a file has one view");
    constexpr std::array<std::string_view, 6> parts = {"from", "at", "up", "angle", "hither", "resolution"};
    std::array<bool, 6> given{};
    const std::string_view v = keyword_;
    std::string_view angle_word, up_word, at_word;
    Camera camera;
    ImageSettings image;
    image.pattern = Pattern::corners;
    for (;;) {
      const std::string_view word = words_.peek();
      const auto part = std::size_t(std::find(parts.begin(), parts.end(), word) - parts.begin());
      if (part == parts.size()) break;
      words_.take();
      if (given[part]) fail(word, fmt::format("'{}' stands twice in one view", word));
      given[part] = true;
      switch (part) {
        case 0:
          camera.eye = point({"point 'from'"});
          break;
        case 1:
          at_word = word, camera.target = point({"point 'at'"});
          break;
        case 2:
          up_word = word, camera.up = point({"direction 'up'"});
          break;
        case 3:
          angle_word = words_.peek(), camera.fov = number({"angle"}, angles);
          break;
        case 4:
          number({"hither distance"});
          break;
        case 5:
          image.width = size({"width"}), image.height = size({"height"});
          break;
      }
    }
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (!given[part] && parts[part] != "hither")
        fail(v, fmt::format("the view lacks '{}'", parts[part]),
             fmt::format("it is written: {}", last_->usage));
    const double angle = camera.fov;
    camera.fov = edge_to_edge(angle, image.height);
    if (camera.fov > angles.max)
      fail(angle_word,
           fmt::format("the angle is too wide for {} rows: it spans {:.4f} degrees from edge to edge",
                       image.height, camera.fov),
           fmt::format("cameras see {} degrees at most", angles.max));
    if (camera.eye == camera.target)
      fail(at_word, "'from' and 'at' are the same point: the view has no direction");
    const Vec3<double> way = camera.target - camera.eye;
    // Below 1e-9 rad between the two, their cross product is mostly rounding.
    if (length(cross(way, camera.up)) <= 1e-9 * length(way) * length(camera.up))
      fail(up_word, camera.up == Vec3<double>{} ? "the direction 'up' is zero"
                                                : "the direction 'up' is along the way from 'from' to 'at'");
    image.encoding = Encoding::none;
    model_.cameras = {{"", camera}};
    model_.image = image;
  }
  static constexpr Range angles{0.01, 179};  // of the scene's cameras
  // `angle` spans from the centre of the top row of pixels to the centre of the bottom row, rows - 1 steps;
  // our field of view from the upper edge of the one to the lower edge of the other, rows steps. Rays through
  // the pixels' corners reach the edges, so they too need the wider field: the databases' counts of eye rays
  // that hit agree so (teapot 12: 161120 there, 161124 here; with the angle from edge to edge it is 161546).
  static double edge_to_edge(double angle, int rows) {
    if (rows == 1) return angle;  // no two rows to measure between
    const auto [sin, cos] = sincos_degrees(angle / 2);
    const double half = std::atan2(rows * sin, (rows - 1) * cos) * (180 / std::numbers::pi);
    // Rounded, since the last bits of atan2 are not the same in every C library.
    return std::round(2 * half * 1e9) / 1e9;
  }
  int size(const Wanted& wanted) {
    const std::string_view word = words_.peek();
    const std::int64_t value = integer(wanted);
    constexpr std::int64_t largest = 65536;
    if (value < 1 || value > largest)
      fail(word,
           fmt::format("the {} is {}; it must be from 1 to {} pixels", to_string(wanted), value, largest));
    return int(value);
  }

  void background() {
    if (model_.background) fail(keyword_, "a second background 'b'", "a file has one background");
    model_.background = color();
  }

  void light(int line) {
    Light light;
    light.place = place_in_line(line);
    light.name = fmt::format("light {}", model_.lights.size() + 1);
    PointLight point_light;
    point_light.position = point({"light's position"});
    if (parse_number(words_.peek())) point_light.color = color();
    light.light = point_light;
    model_.lights.push_back(std::move(light));
  }

  void fill(int line) {
    const Place place = place_in_line(line);
    const Rgb rgb = color();
    const double Kd = number({"diffuse coefficient Kd"}, factors);
    const double Ks = number({"specular coefficient Ks"}, factors);
    const double shine = number({"Phong power Shine"}, {0, 1e6});
    const double T = number({"transmittance T"}, zero_to_one);
    const std::string_view ior_word = words_.peek();
    double ior = number({"index of refraction"});
    // Opaque materials may write 0 for "none".
    if (ior == 0) ior = 1;
    if (ior < 0.01 || ior > 100)
      fail(ior_word, fmt::format("the index of refraction is {}; it must be 0, or from 0.01 to 100", ior));
    const auto [found, is_new] = material_of_fill_.try_emplace(
        {rgb[0], rgb[1], rgb[2], Kd, Ks, shine, T, ior}, std::uint32_t(model_.materials.size()));
    material_ = found->second;
    if (!is_new) return;
    Material material;
    material.name = fmt::format("fill {}", material_of_fill_.size());
    material.place = place;
    material.ambient = material.diffuse = Kd * rgb;
    material.specular = grey(Ks);  // white highlights: so are those of Haines' pictures
    material.shininess = shine;
    material.reflect = grey(Ks);
    material.transmit = grey(T);
    material.ior = ior;
    model_.materials.push_back(std::move(material));
  }

  // The material of the object that is being read.
  std::uint32_t material() {
    if (!material_) {
      model_.warnings.push_back(
          warning_at(file_, keyword_, "an object before the first fill 'f'; it is drawn in a neutral grey"));
      Material neutral;
      neutral.name = "no fill";
      neutral.ambient = neutral.diffuse;
      neutral.place = model_.warnings.back().place;
      material_ = std::uint32_t(model_.materials.size());
      model_.materials.push_back(std::move(neutral));
    }
    return *material_;
  }

  void sphere() {
    Sphere sphere;
    sphere.center = point({"sphere's centre"});
    const std::string_view word = words_.peek();
    sphere.radius = std::abs(number({"sphere's radius"}, radii));
    if (sphere.radius < positive.min)
      fail(word,
           fmt::format("the sphere's radius is {}; it must be {} at least", sphere.radius, positive.min));
    spheres_.push_back(sphere);
    sphere_materials_.push_back(material());
  }

  void cone() {
    const std::string_view keyword = keyword_;
    Cone cone;
    cone.from = point({"base's centre"});
    const double from = number({"base's radius"}, radii);
    cone.to = point({"apex's centre"});
    const std::string_view word = words_.peek();
    const double to = number({"apex's radius"}, radii);
    if (from * to < 0)
      fail(word, "one radius of the cone is negative and the other is not",
           "two negative radii show the cone's inside");
    cone.radius_from = std::abs(from), cone.radius_to = std::abs(to);
    if (max(cone.radius_from, cone.radius_to) < positive.min) fail(word, "both radii of the cone are 0");
    if (length(cone.to - cone.from) < positive.min)
      fail(keyword, "base and apex of the cone are the same point",
           "a flat disc is written as a polygon 'p'");
    cones_.push_back(cone);
    cone_materials_.push_back(material());
  }

  static constexpr Range radii{-largest_coordinate, largest_coordinate};

  void polygon(bool with_normals) {
    const std::string_view keyword = keyword_;
    const std::string_view count_word = words_.peek();
    const std::int64_t count = integer({"number of vertices"});
    if (count < 3) fail(count_word, fmt::format("a polygon has 3 vertices at least, not {}", count));
    polygon_.clear();
    polygon_normals_.clear();
    bool flat = !with_normals;
    for (std::int64_t i = 1; i <= count; ++i) {
      polygon_.push_back(point({"vertex", 0, std::size_t(i), std::size_t(count)}));
      if (!with_normals) continue;
      const Vec3<double> normal = vector({"the normal of vertex", 0, std::size_t(i), std::size_t(count)});
      // Scaled first, so that no normal is too long or too short for the squares of its components.
      const double size = max_abs(normal);
      if (size == 0) flat = true;
      polygon_normals_.push_back(size == 0 ? normal : normalize(normal / size));
    }
    if (with_normals && flat && !flat_patch_warned_) {
      flat_patch_warned_ = true;
      model_.warnings.push_back(
          warning_at(file_, keyword, "a normal of this patch is zero; such patches are drawn flat"));
    }
    const auto first = std::uint32_t(mesh_.vertices.size());
    for (const auto& vertex : polygon_) mesh_.vertices.push_back(cast<float>(vertex));
    add_normals(flat);
    const std::uint32_t material_index = material();
    for (const auto& [a, b, c] : triangulate(polygon_)) {
      mesh_.triangles.push_back({first + a, first + b, first + c});
      triangle_materials_.push_back(material_index);
    }
  }
  // A mesh of polygons alone has no normals; among patches, a polygon's are zero: "the face's own".
  void add_normals(bool flat) {
    if (flat && mesh_.normals.empty()) return;
    mesh_.normals.resize(mesh_.vertices.size());
    if (flat) return;
    const std::size_t first = mesh_.vertices.size() - polygon_.size();
    for (std::size_t i = 0; i < polygon_.size(); ++i)
      mesh_.normals[first + i] = cast<float>(polygon_normals_[i]);
  }

  Place place_in_line(int line) const { return {file_.name, line, int(keyword_.data() - line_begin()) + 1}; }
  const char* line_begin() const {
    const char* at = keyword_.data();
    while (at > file_.text.data() && at[-1] != '\n') --at;
    return at;
  }

  Model finish() {
    model_.spd_rules = true;
    const double n = double(model_.lights.size());
    for (Light& light : model_.lights) std::get<PointLight>(light.light).intensity = 1 / std::sqrt(n);
    const auto add = [&](const char* name, Primitives primitives, std::vector<std::uint32_t> materials) {
      if (!materials.empty()) model_.shapes.push_back({name, std::move(primitives), std::move(materials)});
    };
    add("spheres", std::move(spheres_), std::move(sphere_materials_));
    add("cones", std::move(cones_), std::move(cone_materials_));
    add("polygons", std::move(mesh_), std::move(triangle_materials_));
    return std::move(model_);
  }

  // Colours and coefficients: usually up to 1. Products of them must stay finite.
  static constexpr Range factors{0, 1e6};

  TextFile file_;
  Words words_;
  const Statement* last_ = nullptr;  // the statement being read, or read last
  std::string_view keyword_;         // its keyword in the text
  Model model_;
  std::map<std::array<double, 8>, std::uint32_t> material_of_fill_;
  std::optional<std::uint32_t> material_;  // of the objects that follow
  bool flat_patch_warned_ = false;
  const Limits& limits_;
  std::optional<Diagnostic> limit_reached_;
  std::vector<Sphere> spheres_;
  std::vector<Cone> cones_;
  Mesh mesh_;
  std::vector<std::uint32_t> sphere_materials_, cone_materials_, triangle_materials_;
  std::vector<Vec3<double>> polygon_, polygon_normals_;  // the one being read; kept for their memory
};

}  // namespace

Model import_nff(const std::string& path, const ImportOptions& options) {
  check_file_size(path, options.limits);
  return Reader(path, options.limits).read();
}

}  // namespace lambent
