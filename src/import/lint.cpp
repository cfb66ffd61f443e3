#include "import/lint.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>

#include "import/mtl.h"
#include "import/obj.h"
#include "import/paths.h"
#include "import/text_file.h"
#include "scene/triangulate.h"

namespace lambent {

namespace {

constexpr std::uint32_t none = ~0u;
/// How many remarks of a kind are shown.
constexpr std::size_t most_of_a_kind = 10;

enum Kind : int {
  corner_twice,
  no_area,
  same_face,
  flipped,
  zero_normal,
  long_normal,
  several_forms,
  crowded_edges,
  turned_edges,
  unused,
  images_without_uvs,
  usemtl_without_faces,
  unused_material,
  contradiction,
  key_twice,
  names_by_case,
};
/// For "and 7 more ...".
constexpr const char* names_of_kinds[] = {"faces with a corner twice",
                                          "faces without an area",
                                          "faces with the corners of another",
                                          "faces whose normals point to the back",
                                          "normals without a direction",
                                          "normals far from unit length",
                                          "forms of faces",
                                          "crowded edges",
                                          "turned edges",
                                          "unused vertices",
                                          "materials with images on faces without texture coordinates",
                                          "usemtl without faces",
                                          "materials that no face has",
                                          "contradictions in materials",
                                          "keys given twice",
                                          "names of images that differ by case"};

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

class Remarks {
 public:
  void add(Kind kind, const TextFile& file, std::string_view word, std::string message,
           std::string hint = {}) {
    if (counts_[kind]++ < most_of_a_kind)
      list_.push_back(warning_at(file, word, std::move(message), std::move(hint)));
    file_of_[kind] = file.name;
  }
  /// Whether another one of the kind would be shown; asked where its place is dear to find.
  bool wants(Kind kind) const {
    const auto found = counts_.find(kind);
    return found == counts_.end() || found->second < most_of_a_kind;
  }
  void add(const std::vector<Diagnostic>& others) { list_.insert(list_.end(), others.begin(), others.end()); }

  /// All of them, by file in the order of `files`, then by line; how many there are more comes last.
  std::vector<Diagnostic> take(const std::vector<std::string>& files) {
    for (const auto& [kind, count] : counts_) {
      if (count <= most_of_a_kind) continue;
      Diagnostic more;
      more.severity = Severity::warning;
      more.place.file = file_of_[kind];
      more.message = "and " + std::to_string(count - most_of_a_kind) + " more " + names_of_kinds[kind];
      list_.push_back(std::move(more));
    }
    const auto order = [&](const Diagnostic& d) {
      const auto file = std::find(files.begin(), files.end(), d.place.file) - files.begin();
      return std::pair(file, d.place.line == 0 ? std::numeric_limits<int>::max() : d.place.line);
    };
    std::stable_sort(list_.begin(), list_.end(),
                     [&](const Diagnostic& a, const Diagnostic& b) { return order(a) < order(b); });
    return std::move(list_);
  }

 private:
  std::vector<Diagnostic> list_;
  std::map<Kind, std::size_t> counts_;
  std::map<Kind, std::string> file_of_;
};

// ---- libraries ----

/// What one newmtl says: the first statement of each key, the keys of images in lower case.
struct Block {
  struct Statement {
    std::string_view key, rest;
  };
  std::map<std::string, Statement> statements;

  const Statement* find(const std::string& key) const {
    const auto found = statements.find(key);
    return found == statements.end() ? nullptr : &found->second;
  }
  std::optional<double> number(const std::string& key) const {
    const Statement* statement = find(key);
    if (!statement) return {};
    std::string_view rest = statement->rest;
    return parse_number(next_word(rest));
  }
  /// Whether the key is given, and all its numbers are 0.
  bool black(const std::string& key) const {
    const Statement* statement = find(key);
    if (!statement) return false;
    std::string_view rest = statement->rest;
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest))
      if (parse_number(word) != 0.0) return false;
    return true;
  }
};

class LibraryLint {
 public:
  LibraryLint(const TextFile& file, const ImportOptions& options, Remarks& remarks)
      : file_(file), options_(options), remarks_(remarks) {}

  void look(const MaterialLibrary& library) {
    LineReader lines(file_.text, true);
    while (lines.next()) statement(lines.line);
    if (block_) finish(*block_);
    names(library.images);
  }

 private:
  void statement(std::string_view line) {
    std::string_view rest = line;
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') return;
    if (key == "newmtl") {
      if (block_) finish(*block_);
      block_.emplace();
      return;
    }
    if (!block_) return;
    const std::string lower = lower_case(key);
    const std::string name = lower.starts_with("map_") ? lower : std::string(key);
    if (!block_->statements.try_emplace(name, Block::Statement{key, rest}).second)
      say(key_twice, key, std::string(key) + " stands twice in this material; the last one holds");
  }

  void finish(const Block& m) {
    if (!m.find("Pr") && !m.find("Pm") && !m.find("map_pr") && !m.find("map_pm")) look_at_illum(m);
    for (const char* color : {"Ka", "Kd", "Ks", "Ke"}) {
      const std::string key = std::string("map_") + lower_case(color);
      if (m.find(key) && m.black(color))
        say(contradiction, m.find(key)->key,
            std::string(m.find(key)->key) + " multiplies " + color +
                ", which is black: the image is not seen",
            std::string("'") + color + " 1 1 1' shows the image as it is");
    }
    if (m.find("map_d") && m.find("map_tr"))
      say(contradiction, m.find("map_tr")->key, "map_Tr comes to nothing: map_d is given, too");
  }

  void look_at_illum(const Block& m) {
    const Block::Statement* Ks = m.find("Ks") ? m.find("Ks") : m.find("map_ks");
    if (m.find("Ns") && !Ks)
      say(contradiction, m.find("Ns")->key, "Ns comes to nothing: without Ks there is no highlight");
    const std::optional<double> given = m.number("illum");
    if (!given || *given < 0 || *given > 10 || *given != std::floor(*given)) return;
    const int illum = int(*given);
    const std::string_view key = m.find("illum")->key;
    const std::string name = "illum " + std::to_string(illum);
    if (illum == 1 || illum == 2)
      if (!m.find("Kd") && !m.find("map_kd"))
        say(contradiction, key, name + " asks for Kd, which is not given");
    if (illum <= 1 && Ks && !m.black("Ks"))
      say(contradiction, Ks->key, std::string(Ks->key) + " comes to nothing: " + name + " has no highlight",
          "illum 2 has one");
    if (illum >= 2 && illum <= 9 && !Ks) say(contradiction, key, name + " asks for Ks, which is not given");
    if (illum >= 3 && illum <= 9 && m.black("Ks"))
      say(contradiction, key, name + " reflects by Ks, which is black");
    if (illum == 6 || illum == 7) {
      if (!m.find("Ni")) say(contradiction, key, name + " refracts, but Ni is not given: nothing is bent");
      if (!m.find("Tf") && m.number("d").value_or(1) == 1 && m.number("Tr").value_or(0) == 0)
        say(contradiction, key, name + " lets light through by Tf or d, and neither is given");
    }
  }

  void names(const std::vector<ImageName>& images) {
    std::map<std::string, std::string_view> spelling;
    std::set<std::string_view> asked;
    for (const ImageName& image : images) {
      const std::string_view name = std::string_view(file_.text).substr(image.at, image.size);
      const auto [first, is_new] = spelling.try_emplace(lower_case(name), name);
      if (!is_new && first->second != name)
        say(names_by_case, name,
            "image " + in_quotes(name) + " is elsewhere written " + in_quotes(first->second));
      if (!image.path.empty() || !asked.insert(name).second || asked.size() > most_of_a_kind) continue;
      if (const std::string other = other_case(name); !other.empty())
        say(names_by_case, name,
            "image " + in_quotes(name) + " is not there, but " + in_quotes(other) + " is");
    }
  }

  /// The name of a file that has the same letters in another case; empty where there is none that may be
  /// read.
  std::string other_case(std::string_view name) const {
    namespace fs = std::filesystem;
    std::string slashes(name);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const fs::path wanted = (fs::path(file_.name).parent_path() / slashes).lexically_normal();
    const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
    if (!options_.limits.allow_outside && !lies_below(options_.root, folder.string())) return {};
    std::error_code error;
    std::string found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      const std::string there = entry.path().filename().string();
      // One of the same name is there, but may not be read: it is a pipe, or a link that leads elsewhere.
      if (there == wanted.filename().string()) return {};
      // The first by name: folders have no order of their own.
      if (lower_case(there) == lower_case(wanted.filename().string()) && (found.empty() || there < found))
        found = there;
    }
    return found;
  }

  void say(Kind kind, std::string_view word, std::string message, std::string hint = {}) {
    remarks_.add(kind, file_, word, std::move(message), std::move(hint));
  }

  const TextFile& file_;
  const ImportOptions& options_;
  Remarks& remarks_;
  std::optional<Block> block_;
};

// ---- models ----

struct Corner {
  std::uint32_t position, uv, normal;
};
struct Face {
  std::string_view word;  ///< Its statement, for places.
  std::size_t first;      ///< Index into the corners of all faces.
  std::uint32_t count, material;
  int line;
};
/// An edge as a face runs along it: from the lesser position to the greater, or back.
struct Edge {
  std::uint32_t low, high, face;
  bool forward;
};
struct UsedMaterial {
  std::string name;
  std::size_t without_uvs = 0;
  std::uint32_t first_without = none;
  bool shown = false;
};

/// Walks over a file that import_obj has found to be right.
class ModelLint {
 public:
  ModelLint(const TextFile& file, Remarks& remarks) : file_(file), remarks_(remarks) {
    materials_.emplace_back();
    material_of_name_[""] = 0;
  }

  void look() {
    LineReader lines(file_.text, true);
    while (lines.next()) statement(lines.line, lines.number);
    end_of_usemtl();
    for (std::uint32_t i = 0; i < faces_.size(); ++i) look_at(i);
    edges();
    forms();
    unused_ones();
  }
  /// What the libraries' materials come to.
  void look_at_materials(const TextFile& file, const MaterialLibrary& library, std::set<std::string>& seen) {
    for (const Material& material : library.materials) {
      if (!seen.insert(material.name).second) continue;
      const auto found = material_of_name_.find(material.name);
      const UsedMaterial* used = found == material_of_name_.end() ? nullptr : &materials_[found->second];
      if (!used || !used->shown)
        remarks_.add(unused_material, file,
                     remarks_.wants(unused_material) ? statement_of(file, material) : std::string_view{},
                     "material " + in_quotes(material.name) + " is on no face");
      else if (!material.maps.empty() && used->without_uvs > 0)
        remarks_.add(images_without_uvs, file_, faces_[used->first_without].word,
                     counted(used->without_uvs, "face has", "faces have") +
                         " no texture coordinates, though the material " + in_quotes(material.name) +
                         " has images; the first is this");
    }
  }

 private:
  void statement(std::string_view line, int number) {
    std::string_view rest = line;
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') return;
    if (key == "v") positions_.push_back(vector(rest));
    else if (key == "vt") ++uvs_;
    else if (key == "vn") normal(key, rest);
    else if (key == "f" || key == "fo") face(key, rest, number);
    else if (key == "usemtl") use_material(key, trim(rest));
    else if (key == "p" || key == "l") points(rest);
    else if (key.starts_with("curv") || key == "surf" || key == "sp") free_form_ = true;
  }

  static Vec3<double> vector(std::string_view rest) {
    double x[3] = {0, 0, 0};
    for (double& one : x) one = parse_number(next_word(rest)).value_or(0);
    return {x[0], x[1], x[2]};
  }

  void normal(std::string_view key, std::string_view rest) {
    const Vec3<double> n = vector(rest);
    normals_.push_back(n);
    const double size = length(n);
    if (!(size > 0)) say(zero_normal, key, "a normal without a direction; faces that have it are flat");
    else if (size < 0.9 || size > 1.1)
      say(long_normal, key, "a normal is not of length 1; its direction alone counts");
  }

  void use_material(std::string_view key, std::string_view name) {
    end_of_usemtl();
    const auto [found, is_new] =
        material_of_name_.try_emplace(std::string(name), std::uint32_t(materials_.size()));
    if (is_new) {
      materials_.emplace_back();
      materials_.back().name = name;
    }
    material_ = found->second;
    usemtl_ = key;
  }
  void end_of_usemtl() {
    if (!usemtl_.empty())
      say(usemtl_without_faces, usemtl_, "no face comes before the next usemtl: this one comes to nothing");
    usemtl_ = {};
  }

  /// From 0 on; `none` where there is no such thing.
  static std::uint32_t index(std::string_view text, std::size_t defined) {
    const auto i = parse_integer(text);
    if (i && *i >= 1 && std::uint64_t(*i) <= defined) return std::uint32_t(*i - 1);
    if (i && *i <= -1 && *i >= -std::int64_t(defined)) return std::uint32_t(std::int64_t(defined) + *i);
    return none;
  }
  Corner corner(std::string_view word) const {
    const std::size_t a = std::min(word.find('/'), word.size());
    const std::size_t b = a < word.size() ? std::min(word.find('/', a + 1), word.size()) : a;
    return {index(word.substr(0, a), positions_.size()),
            b > a + 1 ? index(word.substr(a + 1, b - a - 1), uvs_) : none,
            b + 1 < word.size() ? index(word.substr(b + 1), normals_.size()) : none};
  }

  void face(std::string_view key, std::string_view rest, int number) {
    Face face{key, corners_.size(), 0, material_, number};
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      corners_.push_back(corner(word));
      ++face.count;
    }
    usemtl_ = {};
    faces_.push_back(face);
    UsedMaterial& material = materials_[material_];
    material.shown = true;
    if (corners_[face.first].uv != none) return;
    if (material.without_uvs++ == 0) material.first_without = std::uint32_t(faces_.size() - 1);
  }

  void points(std::string_view rest) {
    for (std::string_view word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest))
      points_.push_back(corner(word));
    usemtl_ = {};
    materials_[material_].shown = true;
  }

  // ---- faces and edges ----

  void look_at(std::uint32_t number) {
    const Face& face = faces_[number];
    const Corner* c = &corners_[face.first];
    sorted_.clear();
    points_of_face_.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) {
      sorted_.push_back(c[i].position);
      points_of_face_.push_back(cast<double>(cast<float>(positions_[c[i].position])));
    }
    std::sort(sorted_.begin(), sorted_.end());
    if (std::adjacent_find(sorted_.begin(), sorted_.end()) != sorted_.end())
      return say(corner_twice, face.word, "this face has a corner twice");
    const Vec3<double> n = newell_normal(points_of_face_);
    if (n == Vec3<double>{}) return say(no_area, face.word, "this face has no area");
    std::uint64_t hash = face.count;
    for (const std::uint32_t position : sorted_)
      hash = (hash ^ position) * 0xd6e8feb86659fd93u, hash ^= hash >> 32;
    const auto [first, is_new] = first_of_hash_.try_emplace(hash, number);
    if (!is_new && same_corners(faces_[first->second]))
      return say(
          same_face, face.word,
          "this face has the corners of the one in line " + std::to_string(faces_[first->second].line));
    double side = 0;
    for (std::uint32_t i = 0; i < face.count; ++i) {
      if (c[i].normal != none && length(normals_[c[i].normal]) > 0)
        side += dot(n, normalize(normals_[c[i].normal]));
      const std::uint32_t a = c[i].position, b = c[(i + 1) % face.count].position;
      edges_.push_back({std::min(a, b), std::max(a, b), number, a < b});
    }
    if (side < 0)
      say(flipped, face.word,
          "the normals of this face's corners point to its back: its corners should be counter-clockwise "
          "seen "
          "from outside");
  }

  /// Whether that face has the positions in sorted_.
  bool same_corners(const Face& face) const {
    std::vector<std::uint32_t> other;
    for (std::uint32_t i = 0; i < face.count; ++i) other.push_back(corners_[face.first + i].position);
    std::sort(other.begin(), other.end());
    return other == sorted_;
  }

  void edges() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    std::size_t crowded = 0, turned = 0;
    std::uint32_t first_crowded = none, first_turned = none;
    for (std::size_t i = 0, j = 0; i < edges_.size(); i = j) {
      while (j < edges_.size() && edges_[j].low == edges_[i].low && edges_[j].high == edges_[i].high) ++j;
      if (j - i > 2) ++crowded, first_crowded = std::min(first_crowded, edges_[i + 2].face);
      else if (j - i == 2 && edges_[i].forward == edges_[i + 1].forward)
        ++turned, first_turned = std::min(first_turned, edges_[i + 1].face);
    }
    if (crowded > 0)
      say(crowded_edges, faces_[first_crowded].word,
          counted(crowded, "edge belongs", "edges belong") +
              " to more than two faces; this is the third face of the first");
    if (turned > 0)
      say(turned_edges, faces_[first_turned].word,
          "two faces run along " + counted(turned, "edge", "edges") +
              " in the same direction, so that one shows its back where the other shows its front; this face "
              "is "
              "the first");
  }

  void forms() {
    static constexpr const char* names[] = {"v", "v/vt", "v//vn", "v/vt/vn"};
    std::size_t counts[4] = {0, 0, 0, 0};
    const Face* other = nullptr;
    const auto form = [&](const Face& face) {
      const Corner& c = corners_[face.first];
      return (c.uv != none ? 1 : 0) + (c.normal != none ? 2 : 0);
    };
    for (const Face& face : faces_) {
      ++counts[form(face)];
      if (!other && form(face) != form(faces_[0])) other = &face;
    }
    if (!other) return;
    std::string text;
    for (int i = 0; i < 4; ++i)
      if (counts[i] > 0) text += (text.empty() ? "" : ", ") + std::to_string(counts[i]) + " " + names[i];
    say(several_forms, other->word,
        "faces have different forms: " + text + "; this is the first that differs");
  }

  // ---- what is used ----

  void unused_ones() {
    if (free_form_ || (faces_.empty() && points_.empty())) return;
    std::vector<bool> positions(positions_.size()), uvs(uvs_), normals(normals_.size());
    const auto mark = [](std::vector<bool>& used, std::uint32_t i) {
      if (i != none) used[i] = true;
    };
    for (const std::vector<Corner>* corners : {&corners_, &points_})
      for (const Corner& c : *corners) mark(positions, c.position), mark(uvs, c.uv), mark(normals, c.normal);
    std::string text;
    std::string_view first;
    const auto tell = [&](const std::vector<bool>& used, const char* key, const char* one, const char* many) {
      const auto count = std::size_t(std::count(used.begin(), used.end(), false));
      if (count == 0) return;
      text += (text.empty() ? "" : ", ") + counted(count, one, many);
      if (first.empty())
        first = nth(key, std::size_t(std::find(used.begin(), used.end(), false) - used.begin()));
    };
    tell(positions, "v", "vertex", "vertices");
    tell(uvs, "vt", "texture coordinate", "texture coordinates");
    tell(normals, "vn", "normal", "normals");
    if (!text.empty()) say(unused, first, "no face uses " + text + "; this is the first");
  }

  /// The key of statement `n`, counted from 0, of those that begin with `key`.
  std::string_view nth(std::string_view key, std::size_t n) const {
    LineReader lines(file_.text, true);
    while (lines.next()) {
      std::string_view rest = lines.line;
      const std::string_view word = next_word(rest);
      if (word == key && n-- == 0) return word;
    }
    return end_of(file_.text);
  }

  /// Where `file` begins a material.
  static std::string_view statement_of(const TextFile& file, const Material& material) {
    LineReader lines(file.text, true);
    while (lines.next())
      if (file.first_line + lines.number - 1 == material.place.line) {
        std::string_view rest = lines.line;
        next_word(rest);
        const std::string_view name = trim(rest);
        return name.empty() ? lines.line : name;
      }
    return end_of(file.text);
  }

  void say(Kind kind, std::string_view word, std::string message) {
    remarks_.add(kind, file_, word, std::move(message));
  }

  const TextFile& file_;
  Remarks& remarks_;
  std::vector<Vec3<double>> positions_, normals_;
  std::size_t uvs_ = 0;
  std::vector<Corner> corners_, points_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::unordered_map<std::uint64_t, std::uint32_t> first_of_hash_;
  std::vector<UsedMaterial> materials_;
  std::unordered_map<std::string, std::uint32_t> material_of_name_;
  std::uint32_t material_ = 0;
  std::string_view usemtl_;  ///< The last usemtl, as long as no face has come behind it.
  bool free_form_ = false;
  // Of the face at hand; kept for their memory.
  std::vector<std::uint32_t> sorted_;
  std::vector<Vec3<double>> points_of_face_;
};

}  // namespace

std::vector<Diagnostic> lint_obj(const std::string& path, const ImportOptions& given) {
  const ImportOptions options = within_folder_of(path, given);
  std::vector<std::string> files;
  Remarks remarks;
  remarks.add(read_obj(path, options, &files).warnings);
  const TextFile model = read_text_file(path);
  ModelLint lint(model, remarks);
  lint.look();
  std::set<std::string> seen;
  for (const std::string& name : files) {
    const TextFile file = read_text_file(name);
    const MaterialLibrary library = read_material_library(file, options);
    LibraryLint(file, options, remarks).look(library);
    lint.look_at_materials(file, library, seen);
  }
  files.insert(files.begin(), path);
  return remarks.take(files);
}

std::vector<Diagnostic> lint_mtl(const std::string& path, const ImportOptions& given) {
  const ImportOptions options = within_folder_of(path, given);
  check_file_size(path, options.limits);
  const TextFile file = read_text_file(path);
  const MaterialLibrary library = read_material_library(file, options);
  Remarks remarks;
  remarks.add(library.warnings);
  LibraryLint(file, options, remarks).look(library);
  return remarks.take({path});
}

}  // namespace lambent
