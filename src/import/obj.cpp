// Wavefront OBJ: polygons with their materials. Colours and weights of vertices, free-form curves and
// surfaces, points and lines are passed over, the latter three with a warning.
//
// All faces of a file become one mesh. Its vertices are the different (position, texture coordinate, normal)
// triples of the faces' corners. A file without normals (vn) but with smoothing groups (s) gets normals: in
// each group, the sum of the normals of the faces around a position, each as long as the face is large.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <unordered_map>

#include "import/model.h"
#include "import/mtl.h"
#include "import/text_file.h"
#include "import/vertex_table.h"
#include "scene/triangulate.h"

namespace lambent {

namespace {

constexpr std::uint32_t none = ~0u;
constexpr std::size_t most_errors = 20;
constexpr std::size_t most_warnings_of_a_kind = 20;

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

std::string plural(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

class ObjReader {
 public:
  explicit ObjReader(const std::string& path) : pieces_(path) {
    used_.push_back({});
    slot_of_name_[""] = 0;
  }

  Model read() {
    while (pieces_.next(file_)) {
      LineReader lines(file_.text, true);
      while (lines.next()) statement(lines.line);
      if (!triangles_.empty()) continue;
      if (!end_ || !trim(file_.text).empty()) end_ = warning_at(file_, end_of(file_.text), {});
      any_text_ |= !trim(file_.text).empty();
    }
    if (errors_.empty() && triangles_.empty()) no_faces();
    if (!errors_.empty()) throw InputError(std::move(errors_));
    remark_what_was_skipped();
    Model model;
    model.illumination = ModelId::mtl;
    Shape shape;
    shape.name = std::filesystem::path(file_.name).filename().string();
    shape.material_of_primitive = make_materials(model.materials);
    shape.primitives = make_mesh();
    model.shapes.push_back(std::move(shape));
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
    if (key == "f") return face(line, rest);
    if (key == "vn") return normal(line, rest);
    if (key == "vt") return texture_coordinate(line, rest);
    if (key == "usemtl") return use_material(key, trim(rest));
    if (key == "mtllib") return libraries(key, trim(rest));
    if (key == "s") return smoothing_group(line, rest);
    if (key == "g" || key == "o") return;
    if (key == "p" || key == "l") {
      if (points_and_lines_++ == 0) first_point_or_line_ = warning_at(file_, key, {});
      return;
    }
    if (unknown_.size() < most_warnings_of_a_kind && unknown_.insert(std::string(key)).second)
      warn(key, "statement " + in_quotes(key) + " is not supported; it is ignored wherever it stands");
  }

  /// Reads up to `most` numbers into `result`; says what is wrong where fewer than `least` are there. A
  /// comment ends them.
  int numbers(std::string_view line, std::string_view rest, const char* what, int least, int most,
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
    numbers(line, rest, "a vertex", 3, 3, x);
    add(positions_, Vec3<double>{x[0], x[1], x[2]}, line);
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

  void smoothing_group(std::string_view line, std::string_view rest) {
    const std::string_view word = next_word(rest);
    const auto number = parse_integer(word);
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

  bool read_corner(std::string_view word, Corner& corner) {
    corner = {none, none, none};
    const std::size_t a = std::min(word.find('/'), word.size());
    const std::size_t b = a < word.size() ? std::min(word.find('/', a + 1), word.size()) : a;
    if (!read_index(word, word.substr(0, a), "vertex", positions_.size(), corner.position)) return false;
    if (b > a + 1 &&
        !read_index(word, word.substr(a + 1, b - a - 1), "texture coordinate", uvs_.size(), corner.uv))
      return false;
    if (b + 1 < word.size() &&
        !read_index(word, word.substr(b + 1), "normal", normals_.size(), corner.normal))
      return false;
    return true;
  }

  /// From 1 on, or from -1 back, as the file counts, to from 0 on.
  bool read_index(std::string_view corner, std::string_view text, const char* thing, std::size_t defined,
                  std::uint32_t& result) {
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
    if (read_library(rest)) return;
    std::vector<std::string_view> missing;
    bool found = false;
    std::vector<std::string_view> names = library_names(rest);
    for (const std::string_view name : names) {
      if (read_library(name)) found = true;
      else missing.push_back(name);
    }
    if (!found) missing = {rest};
    for (const std::string_view name : missing)
      if (missing_libraries_++ < most_warnings_of_a_kind)
        warn(name, "material library " + in_quotes(name) + " is not there; its materials will be grey");
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

  /// False where there is no such file: as the name stands, with the blanks that backslashes keep, with
  /// slashes for backslashes as Windows writes them, and last by the file's bare name beside the model, for
  /// paths of the machine it was made on.
  bool read_library(std::string_view name) {
    namespace fs = std::filesystem;
    std::string kept(name), slashes(name);
    for (std::size_t i = kept.find("\\ "); i != std::string::npos; i = kept.find("\\ ", i)) kept.erase(i, 1);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const fs::path folder = fs::path(file_.name).parent_path();
    for (const fs::path& candidate :
         {fs::path(std::string(name)), fs::path(kept), fs::path(slashes), fs::path(slashes).filename()}) {
      std::error_code ignored;
      const fs::path path = (folder / candidate).lexically_normal();
      if (!fs::is_regular_file(path, ignored)) continue;
      if (!paths_read_.insert(path.string()).second) return true;
      try {
        MaterialLibrary library = read_material_library(read_text_file(path.string()));
        warnings_.insert(warnings_.end(), library.warnings.begin(), library.warnings.end());
        // Of materials of one name, the library that is named first gives it.
        for (Material& material : library.materials) defined_.try_emplace(material.name, std::move(material));
      } catch (const InputError& error) {
        for (const Diagnostic& diagnostic : error.diagnostics()) add_error(diagnostic);
      }
      return true;
    }
    return false;
  }

  /// Fills `materials` with those that faces have, in the order in which the file names them, and says which
  /// each triangle has; nothing where there is but one.
  std::vector<std::uint32_t> make_materials(std::vector<Material>& materials) {
    std::vector<std::uint32_t> index_of_slot(used_.size(), none);
    std::size_t undefined = 0;
    for (std::size_t slot = 0; slot < used_.size(); ++slot) {
      const Used& used = used_[slot];
      if (!used.shown) continue;
      index_of_slot[slot] = std::uint32_t(materials.size());
      const auto found = defined_.find(used.name);
      if (found != defined_.end()) {
        materials.push_back(std::move(found->second));
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
    if (materials.size() == 1) return {};
    std::vector<std::uint32_t> material_of_triangle;
    material_of_triangle.reserve(triangles_.size());
    for (const Run& run : runs_)
      material_of_triangle.insert(material_of_triangle.end(), run.triangles, index_of_slot[run.slot]);
    return material_of_triangle;
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
    if (has_uvs_) mesh.uvs.reserve(keys.size());
    if (has_normals_ || smooth) mesh.normals.reserve(keys.size());
    for (const auto& [position, uv, normal, group] : keys) {
      if (has_uvs_) mesh.uvs.push_back(uv == none ? Vec2<float>{} : uvs_[uv]);
      if (has_normals_) mesh.normals.push_back(normal == none ? Vec3<float>{} : normals_[normal]);
      else if (smooth) mesh.normals.push_back(group == 0 ? Vec3<float>{} : smooth_normal(position, group));
    }
    return mesh;
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

  void remark_what_was_skipped() {
    if (points_and_lines_ > 0)
      warnings_.push_back(
          worded(first_point_or_line_, plural(points_and_lines_, "statement", "statements") +
                                           " of points and lines skipped: they have no surface"));
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

  TextPieces pieces_;
  TextFile file_;                  ///< The piece at hand; views into it do not outlive it.
  std::optional<Diagnostic> end_;  ///< Where the text ends, as long as there is no triangle; without words.
  bool any_text_ = false;
  std::vector<Diagnostic> errors_, warnings_;

  std::vector<Vec3<double>> positions_;
  std::vector<Vec2<float>> uvs_;
  std::vector<Vec3<float>> normals_;

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

  std::vector<Used> used_;  ///< First the material of faces before any usemtl, which has no name.
  std::unordered_map<std::string, std::uint32_t> slot_of_name_;
  std::uint32_t slot_ = 0;
  std::unordered_map<std::string, Material> defined_;
  std::set<std::string> libraries_seen_, paths_read_;
  std::size_t missing_libraries_ = 0;
  bool any_library_ = false;

  std::set<std::string> unknown_;
  std::size_t points_and_lines_ = 0, without_area_ = 0;
  Diagnostic first_point_or_line_, first_without_area_;  ///< Without words.
};

}  // namespace

Model import_obj(const std::string& path, const ImportOptions&) { return ObjReader(path).read(); }

}  // namespace lambent
