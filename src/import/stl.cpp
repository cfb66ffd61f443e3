// STL, the triangles of 3D printing and CAD; ASCII and binary.
// Source: 3D Systems, StereoLithography Interface Specification, 1989. Colours of binary files: those of
// VisCAM and SolidView, and of Magics.
//
// How what is written badly is read:
//   - Which of the two kinds a file is, its size says: 84 bytes and 50 for each triangle are binary, though
//   it
//     begin with "solid", in the other order of bytes too if only that fits.
//   - The facets' normals are not looked at: they are often wrong, and the corners' order says them.
//   - Equal corners become one vertex; faces that meet at 30 degrees or less are smooth there. So a ball
//   looks
//     like one, and a part keeps its edges.
//   - Facets without an area are left out. z is up, as on the bed of a printer.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>

#include "import/bare.h"
#include "import/creased_normals.h"
#include "import/model.h"
#include "import/text_file.h"
#include "import/vertex_table.h"
#include "lambent/image.h"
#include "scene/triangulate.h"

namespace lambent {

namespace {

constexpr double crease = 30;  // degrees
constexpr std::size_t header_size = 84, facet_size = 50;

/// Collects the facets of a solid, and makes a shape of them.
class Solid {
 public:
  /// `color`: its key, for solids of several colours.
  void add(const Vec3<float>& a, const Vec3<float>& b, const Vec3<float>& c, std::uint32_t color = 0) {
    const auto d = [](const Vec3<float>& v) { return cast<double>(v); };
    const Vec3<double> n = cross(d(b) - d(a), d(c) - d(a));
    if (!std::isfinite(n.x + n.y + n.z)) ++unplaced;
    else if (n == Vec3<double>{}) ++without_area;
    else triangles_.push_back({vertex(a, color), vertex(b, color), vertex(c, color)});
  }
  std::size_t size() const { return triangles_.size(); }

  /// `color_of` gives a key's colour; without it there are none. The solid is empty afterwards.
  template <class ColorOf> Mesh take_mesh(const ColorOf& color_of, bool colored) {
    Mesh mesh;
    mesh.triangles = std::move(triangles_);
    const std::vector<VertexKey> keys = vertices_.take_keys();
    mesh.vertices.reserve(keys.size());
    if (colored) mesh.colors.reserve(keys.size());
    for (const auto& [x, y, z, color] : keys) {
      mesh.vertices.push_back({std::bit_cast<float>(x), std::bit_cast<float>(y), std::bit_cast<float>(z)});
      if (colored) mesh.colors.push_back(color_of(color));
    }
    triangles_.clear();
    add_creased_normals(mesh, crease);
    return mesh;
  }

  std::size_t without_area = 0, unplaced = 0;  ///< Facets left out; of all solids.

 private:
  std::uint32_t vertex(const Vec3<float>& p, std::uint32_t color) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0
    return vertices_.index_of({bits(p.x), bits(p.y), bits(p.z), color});
  }
  PositionTable vertices_;  ///< Keys: the bits of x, y, z; colour.
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

void start(Model& model) {
  model.illumination = ModelId::blinn_phong;
  model.z_up = true;
}

void finish(Model& model, const Solid& solid, const std::string& path, std::size_t facets) {
  if (model.shapes.empty()) {
    if (facets > 0) throw InputError(file_error(path, "no facet has an area"));
    throw InputError(file_error(path, "the file has no facets"));
  }
  if (solid.unplaced > 0)
    model.warnings.push_back(
        file_warning(path, counted(solid.unplaced, "facet", "facets") +
                               " left out: a corner has coordinates that are no numbers, or too large"));
  if (solid.without_area > 0)
    model.warnings.push_back(
        file_warning(path, counted(solid.without_area, "facet", "facets") + " left out: they have no area"));
}

[[noreturn]] void too_many(const std::string& path, const Limits& limits) {
  throw InputError(file_error(
      path, "more than " + counted(limits.primitives, "facet", "facets") + ", which is the limit"));
}

// ---- binary

/// Five bits for each of three channels, sRGB-encoded; the first one stands in the lowest bits.
std::array<float, 4> color_of_bits(std::uint32_t bits, bool blue_first) {
  const auto channel = [&](int shift) { return float(linear_from_srgb(double(bits >> shift & 31) / 31)); };
  return {channel(blue_first ? 10 : 0), channel(5), channel(blue_first ? 0 : 10), 1};
}

class BinaryReader {
 public:
  BinaryReader(const std::string& path, std::string_view bytes, const Limits& limits)
      : path_(path), bytes_(bytes), limits_(limits) {}

  Model read() {
    Model model;
    start(model);
    if (bytes_.size() < header_size)
      throw InputError(file_error(path_, "the file ends at byte " + std::to_string(bytes_.size()) +
                                             ", within the header of 84 bytes that a binary STL has"));
    const std::uint64_t size = bytes_.size();
    std::uint64_t count = load_number<std::uint32_t>(bytes_.data() + 80, true);
    if (const std::uint64_t other = load_number<std::uint32_t>(bytes_.data() + 80, false);
        size != size_for(count) && size == size_for(other)) {
      little_ = false;
      count = other;
    }
    if (size < size_for(count))
      throw InputError(file_error(path_,
                                  "the file ends at byte " + std::to_string(size) + ", within facet " +
                                      std::to_string((size - header_size) / facet_size + 1) + " of " +
                                      std::to_string(count) + "; it should have " +
                                      std::to_string(size_for(count)) + " bytes",
                                  "it is cut off, or no STL file"));
    if (size > size_for(count)) {
      const std::string surplus = counted(size - size_for(count), "byte", "bytes") + " behind the " +
                                  counted(count, "facet", "facets") + " that the file counts";
      if (count == 0) throw InputError(file_error(path_, "the file has no facets, but " + surplus));
      model.warnings.push_back(file_warning(path_, surplus + " are ignored"));
    }
    if (count > limits_.primitives) too_many(path_, limits_);
    find_colors(count);
    Solid solid;
    for (std::uint64_t i = 0; i < count; ++i) {
      const char* const facet = facet_at(i);
      solid.add(point(facet + 12), point(facet + 24), point(facet + 36), color_key(attribute(i)));
    }
    if (solid.size() > 0) {
      Shape shape;
      shape.name = std::filesystem::path(path_).filename().string();
      const bool colored = kind_ != Colors::none;
      shape.primitives = solid.take_mesh([&](std::uint32_t key) { return color(key); }, colored);
      model.materials.push_back(colored ? coloring_material() : neutral_material());
      model.shapes.push_back(std::move(shape));
    }
    finish(model, solid, path_, std::size_t(count));
    return model;
  }

  static std::uint64_t size_for(std::uint64_t count) { return header_size + facet_size * count; }

 private:
  enum class Colors { none, viscam, magics };
  static constexpr std::uint32_t own = 0x8000;  ///< Of a key: the facet has a colour of its own.

  const char* facet_at(std::uint64_t i) const { return bytes_.data() + size_for(i); }
  std::uint32_t attribute(std::uint64_t i) const {
    return load_number<std::uint16_t>(facet_at(i) + 48, little_);
  }
  Vec3<float> point(const char* at) const {
    const auto number = [&](int i) { return load_number<float>(at + 4 * i, little_); };
    return {number(0), number(1), number(2)};
  }

  /// Magics writes its colour into the header, and then a facet's own has bit 15 clear. Others set bit 15 for
  /// a colour, and leave 0 where there is none; anything else in the two bytes is no colour.
  void find_colors(std::uint64_t count) {
    bool any = false, like_viscam = true;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint32_t a = attribute(i);
      any |= a != 0;
      like_viscam &= a == 0 || (a & own) != 0;
    }
    const std::size_t at = bytes_.substr(0, 80).find("COLOR=");
    if (at <= 70) {
      kind_ = Colors::magics;
      own_colors_ = any;  // where no facet says anything, 0 is not black
      for (std::size_t c = 0; c < 3; ++c)
        common_[c] = float(linear_from_srgb(double(std::uint8_t(bytes_[at + 6 + c])) / 255));
    } else if (any && like_viscam) {
      kind_ = Colors::viscam;
      common_ = {0.7f, 0.7f, 0.7f, 1};  // as neutral_material()
    }
  }
  std::uint32_t color_key(std::uint32_t attribute) const {
    if (kind_ == Colors::viscam) return attribute & own ? attribute : 0;
    if (kind_ == Colors::magics && own_colors_) return attribute & own ? 0 : attribute | own;
    return 0;
  }
  std::array<float, 4> color(std::uint32_t key) const {
    return key & own ? color_of_bits(key, kind_ == Colors::viscam) : common_;
  }

  const std::string& path_;
  std::string_view bytes_;
  const Limits& limits_;
  bool little_ = true, own_colors_ = false;
  Colors kind_ = Colors::none;
  std::array<float, 4> common_{1, 1, 1, 1};
};

// ---- ASCII

/// The words of a file that is read piece by piece. A word is there until the next one is asked for.
class Words {
 public:
  explicit Words(const std::string& path) : pieces_(path) {
    ended_ = !pieces_.next(piece), rest_ = piece_text();
  }

  /// Empty at the end of the file.
  std::string_view next() {
    for (;;) {
      std::size_t i = 0;
      while (i < rest_.size() && is_space(rest_[i])) ++i;
      rest_.remove_prefix(i);
      if (!rest_.empty()) break;
      if (ended_ || !pieces_.next(piece_ahead_)) {
        ended_ = true;
        return end_of(piece.text);
      }
      std::swap(piece, piece_ahead_);
      rest_ = piece_text();
    }
    std::size_t i = 1;
    while (i < rest_.size() && !is_space(rest_[i])) ++i;
    const std::string_view word = rest_.substr(0, i);
    rest_.remove_prefix(i);
    return word;
  }
  /// The rest of the line. (A piece ends with a line.)
  std::string_view line() {
    const std::string_view line = rest_.substr(0, rest_.find('\n'));
    rest_.remove_prefix(line.size());
    return trim(line);
  }

  TextFile piece;  ///< What the last word is a view into.

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  std::string_view piece_text() const { return piece.text; }

  TextPieces pieces_;
  TextFile piece_ahead_;
  std::string_view rest_;
  bool ended_ = false;
};

class AsciiReader {
 public:
  AsciiReader(const std::string& path, const Limits& limits) : path_(path), limits_(limits), words_(path) {}

  Model read() {
    start(model_);
    std::string_view word = words_.next();
    while (!word.empty()) {
      if (!is(word, "solid")) fail(word, "expected 'solid', found " + in_quotes(word));
      const std::string name(words_.line());
      word = solid(name);
    }
    finish(model_, solid_, path_, facets_);
    return std::move(model_);
  }

 private:
  [[noreturn]] void fail(std::string_view word, std::string message) const {
    throw InputError(error_at(words_.piece, word, std::move(message)));
  }
  static bool is(std::string_view word, std::string_view keyword) {
    return word == keyword || (word.size() == keyword.size() && lower_case(word) == keyword);
  }
  void expect(std::string_view keyword) {
    const std::string_view word = words_.next();
    if (is(word, keyword)) return;
    if (word.empty()) ends(word);
    fail(word, "expected " + in_quotes(keyword) + " in facet " + std::to_string(facets_) + ", found " +
                   in_quotes(word));
  }
  [[noreturn]] void ends(std::string_view at) const {
    fail(at, "the file ends within facet " + std::to_string(facets_));
  }

  /// Up to its end; returns the word behind it.
  std::string_view solid(const std::string& name) {
    for (;;) {
      const std::string_view word = words_.next();
      if (is(word, "facet")) {
        facet();
        continue;
      }
      if (word.empty()) {
        model_.warnings.push_back(
            warning_at(words_.piece, word, "the file ends without 'endsolid'; it may be cut off"));
      } else if (is(word, "endsolid")) {
        words_.line();  // the name again
      } else {
        fail(word, "expected 'facet' or 'endsolid', found " + in_quotes(word));
      }
      add_shape(name);
      return words_.next();
    }
  }

  void facet() {
    ++facets_;
    // A normal of whatever numbers, or none.
    std::string_view word = words_.next();
    for (int i = 0; i < 4 && !word.empty() && !is(word, "outer"); ++i) word = words_.next();
    if (word.empty()) ends(word);
    if (!is(word, "outer"))
      fail(word, "expected 'outer loop' behind the normal of facet " + std::to_string(facets_) + ", found " +
                     in_quotes(word));
    expect("loop");
    corners_.clear();
    for (word = words_.next(); is(word, "vertex"); word = words_.next()) {
      const float x = number(), y = number(), z = number();
      corners_.push_back({x, y, z});
    }
    if (word.empty()) ends(word);
    if (!is(word, "endloop"))
      fail(word, "expected 'vertex' or 'endloop' in facet " + std::to_string(facets_) + ", found " +
                     in_quotes(word));
    if (corners_.size() < 3)
      fail(word, "facet " + std::to_string(facets_) + " has " +
                     counted(corners_.size(), "corner", "corners") + "; it needs 3");
    expect("endfacet");
    if (corners_.size() == 3) {
      solid_.add(corners_[0], corners_[1], corners_[2]);
    } else {  // not of the specification, but its meaning is clear
      points_.clear();
      for (const Vec3<float>& corner : corners_) points_.push_back(cast<double>(corner));
      const bool finite = std::all_of(points_.begin(), points_.end(),
                                      [](const Vec3<double>& p) { return std::isfinite(p.x + p.y + p.z); });
      if (!finite) ++solid_.unplaced;
      else
        for (const auto& t : triangulate(points_)) solid_.add(corners_[t[0]], corners_[t[1]], corners_[t[2]]);
    }
    if (solid_.size() + added_ > limits_.primitives) too_many(path_, limits_);
  }

  float number() {
    const std::string_view word = words_.next();
    if (const auto value = parse_number(word)) return float(*value);
    if (word.empty()) ends(word);
    const std::string lower = lower_case(word.substr(word[0] == '-' || word[0] == '+').substr(0, 8));
    if (lower.starts_with("nan") || lower.starts_with("inf")) return NAN;
    fail(word, "expected a coordinate in facet " + std::to_string(facets_) + ", found " + in_quotes(word));
  }

  void add_shape(const std::string& name) {
    if (solid_.size() == 0) return;
    if (model_.materials.empty()) model_.materials.push_back(neutral_material());
    added_ += solid_.size();
    Shape shape;
    shape.name = name.empty() ? std::filesystem::path(path_).filename().string() : name;
    shape.primitives = solid_.take_mesh([](std::uint32_t) { return std::array<float, 4>{}; }, false);
    model_.shapes.push_back(std::move(shape));
  }

  const std::string& path_;
  const Limits& limits_;
  Words words_;
  Model model_;
  Solid solid_;
  std::size_t facets_ = 0, added_ = 0;
  std::vector<Vec3<float>> corners_;  // of the facet at hand; kept for their memory
  std::vector<Vec3<double>> points_;
};

// ---- which of the two

bool fits_binary(std::string_view head, std::uint64_t size) {
  if (head.size() < header_size) return false;
  for (const bool little : {true, false})
    if (size == BinaryReader::size_for(load_number<std::uint32_t>(head.data() + 80, little))) return true;
  return false;
}

/// Whether a file that does not fit a binary one begins as text does.
bool looks_ascii(std::string_view head) {
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) return true;  // UTF-16
  if (head.starts_with("\xef\xbb\xbf")) head.remove_prefix(3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return true;  // blank: it has no facets
  return lower_case(head.substr(first, 5)) == "solid" && head.find('\0') == std::string_view::npos;
}

}  // namespace

Model import_stl(const std::string& path, const ImportOptions& options) {
  check_file_size(path, options.limits);
  const std::string head = read_head(path, 1024);
  std::error_code unknown;
  const auto size = std::filesystem::file_size(path, unknown);
  if (!fits_binary(head, unknown ? 0 : size) && looks_ascii(head))
    return AsciiReader(path, options.limits).read();
  return BinaryReader(path, read_file(path), options.limits).read();
}

}  // namespace lambent
