// Wavefront OBJ: polygons with their materials. Free-form curves and surfaces, and points and lines beside
// faces, are passed over with a warning; weights of vertices, which only curves use, without. A file of
// points and lines alone is shown as balls and rods.
//
// All faces of a file become one mesh. Its vertices are the different (position, texture coordinate, normal)
// triples of the faces' corners. A file without normals (vn) but with smoothing groups (s) gets normals: in
// each group, the sum of the normals of the faces around a position, each as long as the face is large. A
// file with neither gets them where faces meet at less than 40 degrees (creased_normals.h); `s off` keeps its
// faces flat.
//
// Colours of vertices (v x y z r g b, no part of the specification) are taken as those who write them mean
// them: sRGB-encoded, 0 to 1, or 0 to 255 where one is above 1 and all are whole.

#include "import/obj.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "import/creased_normals.h"
#include "import/mtl.h"
#include "import/paths.h"
#include "import/text_file.h"
#include "import/vertex_table.h"
#include "lambent/image.h"
#include "scene/triangulate.h"

namespace lambent {

namespace {

constexpr std::uint32_t none = ~0u;
constexpr double crease = 40;  // degrees
constexpr std::size_t most_errors = 20;
constexpr std::size_t most_warnings_of_a_kind = 20;
/// Of balls and rods, in diagonals of the box around all points: thin, and still some pixels wide.
constexpr double rod_radius = 1.0 / 400;

/// One corner of a face: indices from 0, or `none`.
struct Corner {
  std::uint32_t position, uv, normal;
};

/// A material as the faces name it.
struct Used {
  std::string name;
  std::optional<Diagnostic> where{};  ///< Where it was first named, as a warning without words.
  bool shown = false;                 ///< A face has it.
};

/// Triangles one after the other that have the same material.
struct Run {
  std::uint32_t slot;  ///< Index into the materials used.
  std::size_t triangles;
};

/// Of a vertex without one; no other is below -1.
constexpr Vec3<float> no_color{-2, -2, -2};

/// Part of a line, or a point where both ends are the same; positions from 0.
struct Stroke {
  std::uint32_t from, to, slot;
};

/// Whether a file that was named can be read.
enum class Found { yes, no, outside };

std::string plural(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

class ObjReader {
 public:
  ObjReader(const std::string& path, const ImportOptions& options)
      : options_(within_folder_of(path, options)), pieces_(path) {
    check_file_size(path, options.limits);
    used_.push_back({});
    slot_of_name_[""] = 0;
  }

  /// The paths of the libraries that were read.
  const std::vector<std::string>& libraries() const { return libraries_; }

  Model read() {
    while (pieces_.next(file_)) {
      LineReader lines(file_.text, true);
      while (lines.next()) statement(lines.line);
      if (!triangles_.empty()) continue;
      if (!end_ || !trim(file_.text).empty()) end_ = warning_at(file_, end_of(file_.text), {});
      any_text_ |= !trim(file_.text).empty();
    }
    points_alone();
    const bool strokes_alone = triangles_.empty() && without_area_ == 0 && !strokes_.empty();
    if (errors_.empty() && triangles_.empty() && !strokes_alone) no_faces();
    if (!errors_.empty()) throw InputError(std::move(errors_));
    remark_what_was_skipped(strokes_alone);
    Model model;
    model.illumination = ModelId::mtl;
    if (strokes_alone) {
      make_balls_and_rods(model);
    } else {
      const std::vector<std::uint32_t> material_of_slot = make_materials(model);
      Shape shape;
      shape.name = name_of_shape();
      if (model.materials.size() > 1)
        for (const Run& run : runs_)
          shape.material_of_primitive.insert(shape.material_of_primitive.end(), run.triangles,
                                             material_of_slot[run.slot]);
      shape.primitives = make_mesh();
      model.shapes.push_back(std::move(shape));
    }
    std::stable_sort(warnings_.begin(), warnings_.end(), [&](const Diagnostic& a, const Diagnostic& b) {
      // In the order of the file, then those of its libraries.
      const bool a_here = a.place.file == file_.name, b_here = b.place.file == file_.name;
      return a_here != b_here ? a_here : a_here && a.place.line < b.place.line;
    });
    model.warnings = std::move(warnings_);
    return model;
  }

 private:
  // ---- statements ----

  void statement(std::string_view line) {
    std::string_view rest = line;
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') return;
    if (key == "v") return vertex(line, rest);
    if (key == "f" || key == "fo") return face(line, rest);
    if (key == "vn") return normal(line, rest);
    if (key == "vt") return texture_coordinate(line, rest);
    if (key == "usemtl") return use_material(key, trim(rest));
    if (key == "mtllib") return libraries(key, trim(rest));
    if (key == "s") return smoothing_group(line, rest);
    if (key == "g" || key == "o") return;
    if (key == "p" || key == "l") {
      if (points_and_lines_++ == 0) first_point_or_line_ = warning_at(file_, key, {});
      return point_or_line(key == "l", rest);
    }
    if (unknown_.size() < most_warnings_of_a_kind && unknown_.insert(std::string(key)).second)
      warn(key, "statement " + in_quotes(key) + " is not supported; it is ignored wherever it stands");
  }

  /// Reads up to `most` numbers into `result`; says what is wrong where fewer than `least` are there. A
  /// comment ends them.
  int numbers(std::string_view line, std::string_view& rest, const char* what, int least, int most,
              double* result) {
    int count = 0;
    while (count < most) {
      const std::string_view word = next_word(rest);
      if (word.empty() || word[0] == '#') break;
      const auto x = parse_number(word);
      if (!x) {
        fail(word, in_quotes(word) + " is not a number that " + what + " can have");
        return count;
      }
      if (std::abs(*x) > std::numeric_limits<float>::max()) {
        fail(word, in_quotes(word) + " is too large: coordinates go up to 3.4e38");
        return count;
      }
      result[count++] = *x;
    }
    if (count < least)
      fail(end_of(line), std::string(what) + " needs " + plural(std::size_t(least), "number", "numbers") +
                             ", found " + std::to_string(count));
    return count;
  }

  // Whatever is wrong with it, a vertex is counted: else every face behind it would seem to be wrong as well.
  void vertex(std::string_view line, std::string_view rest) {
    double x[3] = {0, 0, 0};
    const bool whole = numbers(line, rest, "a vertex", 3, 3, x) == 3;
    add(positions_, Vec3<double>{x[0], x[1], x[2]}, line);
    if (whole && !rest.empty()) color_of_vertex(line, rest);
  }
  /// What stands behind x y z: nothing, w, r g b, or w r g b.
  void color_of_vertex(std::string_view line, std::string_view rest) {
    float x[4];
    int count = 0;
    for (std::string_view word = next_word(rest); count < 4 && !word.empty(); word = next_word(rest)) {
      const auto value = parse_number(word);
      if (!value) break;
      x[count++] = float(std::clamp(*value, -1.0, 1e6));
    }
    if (count < 3) return;
    const float* rgb = x + (count - 3);
    colors_.resize(positions_.size(), no_color);
    colors_.back() = {rgb[0], rgb[1], rgb[2]};
    for (int i = 0; i < 3; ++i) {
      if (rgb[i] >= 0 && rgb[i] <= 1) continue;
      if (!odd_color_) odd_color_ = warning_at(file_, line, {});
      bytes_ &= rgb[i] >= 0 && rgb[i] <= 255;
    }
    bytes_ &= rgb[0] == std::floor(rgb[0]) && rgb[1] == std::floor(rgb[1]) && rgb[2] == std::floor(rgb[2]);
  }
  void normal(std::string_view line, std::string_view rest) {
    double x[3] = {0, 0, 0};
    numbers(line, rest, "a normal", 3, 3, x);
    const Vec3<double> n{x[0], x[1], x[2]};
    const double size = length(n);  // floats squared do not overflow
    add(normals_, size > 0 ? cast<float>(n / size) : Vec3<float>{}, line);
  }
  void texture_coordinate(std::string_view line, std::string_view rest) {
    double x[2] = {0, 0};
    numbers(line, rest, "a texture coordinate", 1, 2, x);
    add(uvs_, Vec2<float>{float(x[0]), float(x[1])}, line);
  }
  template <class T> void add(std::vector<T>& list, const T& value, std::string_view line) {
    if (list.size() == none) {
      errors_.push_back(error_at(file_, line, "more than 2^32 - 1 of these are more than can be numbered"));
      throw InputError(std::move(errors_));
    }
    list.push_back(value);
  }

  void point_or_line(bool line, std::string_view rest) {
    Corner last{none, none, none};
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      Corner corner;
      if (!read_corner(word, corner)) return;
      if (!line) strokes_.push_back({corner.position, corner.position, slot_});
      else if (last.position != none) strokes_.push_back({last.position, corner.position, slot_});
      last = corner;
    }
  }

  void smoothing_group(std::string_view line, std::string_view rest) {
    const std::string_view word = next_word(rest);
    const auto number = parse_integer(word);
    any_group_ = true;
    if (word == "off") group_ = 0;
    else if (word == "on") group_ = 1;
    else if (number && *number >= 0 && *number < none) group_ = std::uint32_t(*number);
    else fail(word.empty() ? end_of(line) : word, "a smoothing group is a number from 0 on, or 'off'");
  }

  // ---- faces ----

  void face(std::string_view line, std::string_view rest) {
    corners_.clear();
    std::string_view first;
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      Corner corner;
      if (!read_corner(word, corner)) return;
      if (corners_.empty()) first = word;
      else if ((corner.uv == none) != (corners_[0].uv == none) ||
               (corner.normal == none) != (corners_[0].normal == none))
        return fail(word, in_quotes(word) + " and " + in_quotes(first) + " name different things in one face",
                    "all corners of a face have the same form: v, v/vt, v//vn or v/vt/vn");
      corners_.push_back(corner);
    }
    if (corners_.size() < 3)
      return fail(end_of(line), "a face needs at least 3 corners, found " + std::to_string(corners_.size()));
    if (errors_.empty()) add_face(line);
  }

  /// The usual corner, of plain numbers in range. All others go the long way, which has the messages.
  bool read_plain_corner(std::string_view word, Corner& corner) const {
    const std::size_t defined[3] = {positions_.size(), uvs_.size(), normals_.size()};
    std::uint32_t* const parts[3] = {&corner.position, &corner.uv, &corner.normal};
    const char *at = word.data(), *const end = at + word.size();
    for (int i = 0; i < 3; ++i) {
      const char* const begin = at;
      std::uint64_t number = 0;
      while (at < end && *at >= '0' && *at <= '9' && at - begin < 18)
        number = 10 * number + std::uint64_t(*at++ - '0');
      if (at > begin) {
        if (number < 1 || number > defined[i]) return false;
        *parts[i] = std::uint32_t(number - 1);
      } else if (i != 1) {
        return false;
      }
      if (at == end) return at > begin;
      if (*at++ != '/') return false;
    }
    return false;
  }

  bool read_corner(std::string_view word, Corner& corner) {
    corner = {none, none, none};
    if (read_plain_corner(word, corner)) return true;
    corner = {none, none, none};
    const std::size_t a = std::min(word.find('/'), word.size());
    const std::size_t b = a < word.size() ? std::min(word.find('/', a + 1), word.size()) : a;
    if (!read_index(word, word.substr(0, a), "vertex", positions_.size(), corner.position, nullptr))
      return false;
    if (b > a + 1 && !read_index(word, word.substr(a + 1, b - a - 1), "texture coordinate", uvs_.size(),
                                 corner.uv, &without_uvs_))
      return false;
    if (b + 1 < word.size() &&
        !read_index(word, word.substr(b + 1), "normal", normals_.size(), corner.normal, &without_normals_))
      return false;
    return true;
  }

  /// From 1 on, or from -1 back, as the file counts, to from 0 on. Where nothing of the kind is defined yet,
  /// and one can do without, the result is `none`, and the place is kept.
  bool read_index(std::string_view corner, std::string_view text, const char* thing, std::size_t defined,
                  std::uint32_t& result, std::optional<Diagnostic>* without) {
    const auto index = parse_integer(text);
    if (index && *index >= 1 && std::uint64_t(*index) <= defined) {
      result = std::uint32_t(*index - 1);
      return true;
    }
    if (index && *index <= -1 && *index >= -std::int64_t(defined)) {
      result = std::uint32_t(std::int64_t(defined) + *index);
      return true;
    }
    const std::string_view where = text.empty() ? corner : text;
    if (without && defined == 0 && index && *index >= 1) {
      if (!*without) *without = warning_at(file_, where, {});
      result = none;
      return true;
    }
    // An integer of any length: one that does not fit 64 bits is out of range, too.
    const std::string_view digits = text.substr(!text.empty() && (text[0] == '-' || text[0] == '+'));
    if (digits.empty() || digits.find_first_not_of("0123456789") != std::string_view::npos) {
      fail(where, in_quotes(corner) + " is no corner of a face",
           "corners are written v, v/vt, v//vn or v/vt/vn");
    } else if (index && *index == 0) {
      fail(where, std::string("face refers to ") + thing + " 0, but they count from 1");
    } else {
      fail(where, std::string("face refers to ") + thing + " " + std::string(text.substr(0, 24)) + ", but " +
                      (defined == 0 ? "none is"
                                    : "only " + std::to_string(defined) + (defined == 1 ? " is" : " are")) +
                      " defined so far");
    }
    return false;
  }

  void add_face(std::string_view line) {
    used_[slot_].shown = true;
    const bool smooth = group_ != 0 && corners_[0].normal == none && normals_.empty();
    points_.clear();
    indices_.clear();
    for (const Corner& c : corners_) {
      points_.push_back(positions_[c.position]);
      indices_.push_back(vertices_.index_of({c.position, c.uv, c.normal, smooth ? group_ : 0}));
      has_uvs_ |= c.uv != none;
      has_normals_ |= c.normal != none;
    }
    if (vertices_.size() > none - corners_.size()) {
      errors_.push_back(error_at(file_, line, "more than 2^32 - 1 vertices are more than can be numbered"));
      throw InputError(std::move(errors_));
    }
    if (triangles_.size() + corners_.size() - 2 > options_.limits.primitives) too_many(line);
    if (smooth) {
      const Vec3<double> n = newell_normal(points_);
      for (const Corner& c : corners_) {
        const std::uint32_t i = smooth_points_.index_of({c.position, none, none, group_});
        if (i == smooth_normals_.size()) smooth_normals_.push_back({});
        smooth_normals_[i] = smooth_normals_[i] + n;
      }
    }
    if (corners_.size() == 3) return add_triangle(line, 0, 1, 2);
    for (const auto& t : triangulate(points_)) add_triangle(line, t[0], t[1], t[2]);
  }

  void add_triangle(std::string_view line, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    // As the mesh will hold them: rounding may have taken the area away.
    const auto p = [&](std::uint32_t i) { return cast<double>(cast<float>(points_[i])); };
    if (cross(p(b) - p(a), p(c) - p(a)) == Vec3<double>{}) {
      if (without_area_++ == 0) first_without_area_ = warning_at(file_, line, {});
      return;
    }
    triangles_.push_back({indices_[a], indices_[b], indices_[c]});
    if (runs_.empty() || runs_.back().slot != slot_) runs_.push_back({slot_, 0});
    ++runs_.back().triangles;
  }

  // ---- materials ----

  void use_material(std::string_view key, std::string_view name) {
    const auto [found, is_new] = slot_of_name_.try_emplace(std::string(name), std::uint32_t(used_.size()));
    slot_ = found->second;
    if (is_new) used_.push_back({std::string(name), warning_at(file_, name, {})});
    if (!used_[slot_].where) used_[slot_].where = warning_at(file_, key, {});
  }

  /// The names on one mtllib line. A name may hold blanks, so the whole line is tried first, then word by
  /// word.
  void libraries(std::string_view key, std::string_view rest) {
    any_library_ = true;
    if (rest.empty()) return warn(key, "mtllib names no file");
    if (!libraries_seen_.insert(std::string(rest)).second) return;
    switch (read_library(rest)) {
      case Found::yes:
        return;
      case Found::outside:
        return remark_outside(rest);
      case Found::no:
        break;
    }
    std::vector<std::string_view> missing;
    bool any = false;
    for (const std::string_view name : library_names(rest)) {
      const Found found = read_library(name);
      any |= found != Found::no;
      if (found == Found::no) missing.push_back(name);
      else if (found == Found::outside) remark_outside(name);
    }
    if (!any) missing = {rest};
    for (const std::string_view name : missing)
      if (missing_libraries_++ < most_warnings_of_a_kind)
        warn(name, "material library " + in_quotes(name) + " is not there; its materials will be grey");
  }
  void remark_outside(std::string_view name) {
    if (missing_libraries_++ < most_warnings_of_a_kind)
      warn(name,
           "material library " + in_quotes(name) +
               " lies outside of the model's folder and is not read; its materials will be grey",
           hint_for_outside);
  }

  /// The words of `rest`; a backslash keeps the blank behind it in a word.
  static std::vector<std::string_view> library_names(std::string_view rest) {
    std::vector<std::string_view> names;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= rest.size(); ++i) {
      const bool blank =
          i == rest.size() || ((rest[i] == ' ' || rest[i] == '\t') && (i == 0 || rest[i - 1] != '\\'));
      if (!blank) continue;
      if (i > begin) names.push_back(rest.substr(begin, i - begin));
      begin = i + 1;
    }
    return names;
  }

  /// The name counts as it stands, else with the blanks that backslashes keep; paths.h says where it leads.
  Found read_library(std::string_view name) {
    NamedFile file = find_named_file(file_.name, name, options_);
    std::string kept(name);
    for (std::size_t i = kept.find("\\ "); i != std::string::npos; i = kept.find("\\ ", i)) kept.erase(i, 1);
    if (file.path.empty() && kept != name) file = find_named_file(file_.name, kept, options_);
    if (file.path.empty()) return file.outside ? Found::outside : Found::no;
    if (!paths_read_.insert(file.path).second) return Found::yes;
    libraries_.push_back(file.path);
    try {
      check_file_size(file.path, options_.limits);
      MaterialLibrary library = read_material_library(read_text_file(file.path), options_);
      warnings_.insert(warnings_.end(), library.warnings.begin(), library.warnings.end());
      const auto first_texture = std::uint32_t(textures_.size());
      std::move(library.textures.begin(), library.textures.end(), std::back_inserter(textures_));
      for (Material& material : library.materials) {
        for (MaterialMap& map : material.maps) map.map.texture += first_texture;
        // Of materials of one name, the library that is named first gives it.
        defined_.try_emplace(material.name, std::move(material));
      }
    } catch (const InputError& error) {
      for (const Diagnostic& diagnostic : error.diagnostics()) add_error(diagnostic);
    }
    return Found::yes;
  }

  /// Gives the model the materials that are shown, in the order in which the file names them, and their
  /// textures. Answers which material each of used_ has become.
  std::vector<std::uint32_t> make_materials(Model& model) {
    std::vector<Material>& materials = model.materials;
    std::vector<std::uint32_t> index_of_slot(used_.size(), none);
    std::size_t undefined = 0;
    for (std::size_t slot = 0; slot < used_.size(); ++slot) {
      const Used& used = used_[slot];
      if (!used.shown) continue;
      index_of_slot[slot] = std::uint32_t(materials.size());
      const auto found = defined_.find(used.name);
      if (found != defined_.end()) {
        materials.push_back(std::move(found->second));
        for (MaterialMap& map : materials.back().maps)
          map.map.texture = kept(map.map.texture, model.textures);
        continue;
      }
      Material grey;
      grey.name = used.name;
      if (used.where) grey.place = place_for(used, undefined);
      materials.push_back(std::move(grey));
    }
    if (undefined > most_warnings_of_a_kind)
      warnings_.push_back(
          {Severity::warning,
           {file_.name, 0, 0},
           std::to_string(undefined - most_warnings_of_a_kind) + " more materials are not defined",
           {},
           {},
           0});
    name_the_nameless(materials);
    return index_of_slot;
  }

  /// Where textures_[index] stands in `textures`, which has each image once for each use of it.
  std::uint32_t kept(std::uint32_t index, std::vector<Texture>& textures) {
    Texture& texture = textures_[index];
    const auto [at, is_new] =
        texture_kept_.try_emplace({texture.source.file, texture.srgb}, std::uint32_t(textures.size()));
    if (is_new) textures.push_back(texture);
    return at->second;
  }

  /// Where a material that is not defined was first named; warns of it.
  Place place_for(const Used& used, std::size_t& undefined) {
    if (!used.name.empty() && undefined++ < most_warnings_of_a_kind)
      warnings_.push_back(worded(*used.where,
                                 "material " + in_quotes(used.name) + " is not defined; it is grey",
                                 any_library_ ? "" : "the file names no material library (mtllib)"));
    return used.where->place;
  }

  /// "default" for the material without a name, or the next name like it that is free.
  static void name_the_nameless(std::vector<Material>& materials) {
    const auto taken = [&](const std::string& name) {
      return std::any_of(materials.begin(), materials.end(),
                         [&](const Material& m) { return m.name == name; });
    };
    std::string name = "default";
    for (int i = 2; taken(name); ++i) name = "default_" + std::to_string(i);
    for (Material& material : materials)
      if (material.name.empty()) material.name = name;
  }

  // ---- the mesh ----

  std::string name_of_shape() const { return std::filesystem::path(file_.name).filename().string(); }

  Mesh make_mesh() {
    const bool smooth = normals_.empty() && smooth_points_.size() > 0;
    Mesh mesh;
    mesh.triangles = std::move(triangles_);
    // One after the other, and what is not wanted any more goes first: this is where most memory is in use.
    const std::vector<VertexTable::Key> keys = vertices_.take_keys();
    mesh.vertices.reserve(keys.size());
    for (const auto& [position, uv, normal, group] : keys)
      mesh.vertices.push_back(cast<float>(positions_[position]));
    positions_ = {};
    if (!colors_.empty()) make_colors(keys, mesh);
    if (has_uvs_) mesh.uvs.reserve(keys.size());
    if (has_normals_ || smooth) mesh.normals.reserve(keys.size());
    for (const auto& [position, uv, normal, group] : keys) {
      if (has_uvs_) mesh.uvs.push_back(uv == none ? Vec2<float>{} : uvs_[uv]);
      if (has_normals_) mesh.normals.push_back(normal == none ? Vec3<float>{} : normals_[normal]);
      else if (smooth) mesh.normals.push_back(group == 0 ? Vec3<float>{} : smooth_normal(position, group));
    }
    if (!has_normals_ && !any_group_) add_creased_normals(mesh, crease);
    return mesh;
  }

  void make_colors(const std::vector<VertexTable::Key>& keys, Mesh& mesh) {
    const bool bytes = odd_color_ && bytes_;
    if (odd_color_)
      warnings_.push_back(worded(
          *odd_color_, bytes ? "colours of vertices above 1: all are taken as whole numbers from 0 to 255"
                             : "colours of vertices go from 0 to 1; what is beyond is cut off"));
    mesh.colors.reserve(keys.size());
    const auto linear = [&](float x) { return float(linear_from_srgb(bytes ? x / 255.0 : x)); };
    for (const auto& [position, uv, normal, group] : keys) {
      const Vec3<float> c = position < colors_.size() ? colors_[position] : no_color;
      mesh.colors.push_back(c == no_color ? std::array<float, 4>{1, 1, 1, 1}
                                          : std::array<float, 4>{linear(c.x), linear(c.y), linear(c.z), 1});
    }
    colors_ = {};
  }

  /// A file that has nothing but vertices is a cloud of points.
  void points_alone() {
    if (!triangles_.empty() || !strokes_.empty() || without_area_ > 0 || !unknown_.empty()) return;
    if (!errors_.empty() || points_and_lines_ > 0) return;
    for (std::uint32_t i = 0; i < positions_.size(); ++i) strokes_.push_back({i, i, 0});
    if (!strokes_.empty()) first_point_or_line_ = *end_;
  }

  /// A ball at each point and at each end of a line, a rod along it.
  void make_balls_and_rods(Model& model) {
    Bounds box;
    for (const Stroke& s : strokes_) {
      used_[s.slot].shown = true;
      box.add(positions_[s.from]);
      box.add(positions_[s.to]);
    }
    if (strokes_.size() > options_.limits.primitives) too_many({});
    double radius = rod_radius * length(box.upper - box.lower);
    if (!(radius > 0)) radius = std::max(1e-3 * max_abs(box.lower), 1e-3);
    const std::vector<std::uint32_t> material_of_slot = make_materials(model);
    std::vector<Sphere> balls;
    std::vector<Cone> rods;
    Shape ball_shape, rod_shape;
    ball_shape.name = rod_shape.name = name_of_shape();
    std::vector<bool> has_ball(positions_.size());
    for (const Stroke& s : strokes_) {
      for (const std::uint32_t end : {s.from, s.to}) {
        if (has_ball[end]) continue;
        has_ball[end] = true;
        balls.push_back({positions_[end], radius});
        ball_shape.material_of_primitive.push_back(material_of_slot[s.slot]);
      }
      if (positions_[s.from] == positions_[s.to]) continue;
      rods.push_back({positions_[s.from], positions_[s.to], radius, radius});
      rod_shape.material_of_primitive.push_back(material_of_slot[s.slot]);
    }
    if (model.materials.size() == 1) ball_shape.material_of_primitive = rod_shape.material_of_primitive = {};
    const bool any_rods = !rods.empty();
    ball_shape.primitives = std::move(balls);
    rod_shape.primitives = std::move(rods);
    model.shapes.push_back(std::move(ball_shape));
    if (any_rods) model.shapes.push_back(std::move(rod_shape));
  }

  Vec3<float> smooth_normal(std::uint32_t position, std::uint32_t group) {
    Vec3<double> n = smooth_normals_[smooth_points_.index_of({position, none, none, group})];
    const double largest = max_abs(n);
    if (!(largest > 0) || !std::isfinite(largest)) return {};
    n = n / largest;  // so that its square neither vanishes nor overflows
    return cast<float>(normalize(n));
  }

  // ---- messages ----

  void no_faces() {
    const auto fail_at = [&](const Diagnostic& place, std::string message) {
      add_error(worded(place, std::move(message), {}, Severity::error));
    };
    if (without_area_ > 0) return fail_at(first_without_area_, "no face has an area");
    if (!any_text_) return fail_at(*end_, "the file is empty");
    fail_at(*end_, "the file has no faces: it holds " + plural(positions_.size(), "vertex", "vertices") +
                       " and " + plural(points_and_lines_, "statement", "statements") +
                       " of points and lines, which have no surface");
  }

  void remark_what_was_skipped(bool strokes_alone) {
    if (strokes_alone)
      warnings_.push_back(
          worded(first_point_or_line_, points_and_lines_ == 0
                                           ? "the file has vertices alone; they are shown as balls"
                                           : "the file has points and lines alone; they are shown as balls "
                                             "and rods"));
    else if (points_and_lines_ > 0)
      warnings_.push_back(
          worded(first_point_or_line_, plural(points_and_lines_, "statement", "statements") +
                                           " of points and lines skipped: they have no surface"));
    if (without_uvs_)
      warnings_.push_back(worded(*without_uvs_,
                                 "faces from here on name texture coordinates before any is "
                                 "defined; they are left out"));
    if (without_normals_)
      warnings_.push_back(worded(*without_normals_,
                                 "faces from here on name normals before any is defined; they are left out"));
    if (without_area_ > 0)
      warnings_.push_back(
          worded(first_without_area_, plural(without_area_, "triangle", "triangles") +
                                          " without an area left out; the first is in this face"));
  }

  /// What stands at `place`, whose text may be gone, and what there is to say about it.
  static Diagnostic worded(Diagnostic place, std::string message, std::string hint = {},
                           Severity severity = Severity::warning) {
    place.severity = severity;
    place.message = std::move(message);
    place.hint = std::move(hint);
    return place;
  }
  [[noreturn]] void too_many(std::string_view line) {
    errors_.push_back(error_at(
        file_, line.empty() ? end_of(file_.text) : line,
        "more than " + plural(options_.limits.primitives, "primitive", "primitives") + " may not be read"));
    throw InputError(std::move(errors_));
  }
  void warn(std::string_view word, std::string message, std::string hint = {}) {
    warnings_.push_back(warning_at(file_, word, std::move(message), std::move(hint)));
  }
  void fail(std::string_view word, std::string message, std::string hint = {}) {
    add_error(error_at(file_, word, std::move(message), std::move(hint)));
  }
  void add_error(Diagnostic diagnostic) {
    errors_.push_back(std::move(diagnostic));
    if (errors_.size() >= most_errors) throw InputError(std::move(errors_));
  }

  ImportOptions options_;
  TextPieces pieces_;
  TextFile file_;                  ///< The piece at hand; views into it do not outlive it.
  std::optional<Diagnostic> end_;  ///< Where the text ends, as long as there is no triangle; without words.
  bool any_text_ = false;
  std::vector<Diagnostic> errors_, warnings_;

  std::vector<Vec3<double>> positions_;
  std::vector<Vec2<float>> uvs_;
  std::vector<Vec3<float>> normals_;
  std::vector<Vec3<float>> colors_;      ///< Of positions, as they are written; as far as they have one.
  std::optional<Diagnostic> odd_color_;  ///< The first that is not from 0 to 1; without words.
  bool bytes_ = true;                    ///< All are whole numbers from 0 to 255.

  // The face at hand; kept for their memory.
  std::vector<Corner> corners_;
  std::vector<Vec3<double>> points_;
  std::vector<std::uint32_t> indices_;

  VertexTable vertices_;       ///< Keys: position, uv, normal, smoothing group.
  VertexTable smooth_points_;  ///< Keys: position, none, none, smoothing group.
  std::vector<Vec3<double>> smooth_normals_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Run> runs_;
  bool has_uvs_ = false, has_normals_ = false;
  std::uint32_t group_ = 0;  ///< The smoothing group; 0 is off.
  bool any_group_ = false;   ///< The file says where it is smooth.

  std::vector<Used> used_;  ///< First the material of faces before any usemtl, which has no name.
  std::unordered_map<std::string, std::uint32_t> slot_of_name_;
  std::uint32_t slot_ = 0;
  std::unordered_map<std::string, Material> defined_;
  std::vector<Texture> textures_;  ///< Of the libraries; the maps in defined_ index them.
  std::map<std::pair<std::string, bool>, std::uint32_t> texture_kept_;
  std::set<std::string> libraries_seen_, paths_read_;
  std::vector<std::string> libraries_;
  std::size_t missing_libraries_ = 0;
  bool any_library_ = false;

  std::vector<Stroke> strokes_;
  std::optional<Diagnostic> without_uvs_,
      without_normals_;  ///< Where faces first name what there is none of.
  std::set<std::string> unknown_;
  std::size_t points_and_lines_ = 0, without_area_ = 0;
  Diagnostic first_point_or_line_, first_without_area_;  ///< Without words.
};

}  // namespace

Model read_obj(const std::string& path, const ImportOptions& options, std::vector<std::string>* libraries) {
  ObjReader reader(path, options);
  Model model = reader.read();
  if (libraries) *libraries = reader.libraries();
  return model;
}

Model import_obj(const std::string& path, const ImportOptions& options) {
  return read_obj(path, options, nullptr);
}

ImportOptions within_folder_of(const std::string& path, const ImportOptions& options) {
  ImportOptions result = options;
  if (result.root.empty()) result.root = std::filesystem::path(path).parent_path().string();
  if (result.root.empty()) result.root = ".";
  return result;
}

}  // namespace lambent
