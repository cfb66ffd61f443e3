// PLY, the Stanford polygon format: meshes and point clouds, as scanners and their programs write them.
// Source: G. Turk, The PLY Polygon File Format, 1994; ply.c there reads ASCII line by line, and so does this.
//
// What the format leaves to custom, and how it is read here:
//   - Colours of whole numbers are sRGB-encoded, 0 to 255 (uint16: 0 to 65535), and are made linear; their
//     alpha is linear. Colours of floating-point numbers are taken as they are: linear, 1 is white.
//   - A mesh without normals gets them, creased where faces meet at more than 40 degrees: scans are smooth,
//     and cubes keep their edges.
//   - Texture coordinates are s t, u v, texture_u texture_v or texture_s texture_t of vertices, or the list
//     `texcoord` of faces; the image is named by a comment "TextureFile", as MeshLab writes it.
//   - A file without faces is a cloud: each point becomes a sphere (point_cloud.h).
//   - Nothing says which way is up: y.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <unordered_set>

#include "import/bare.h"
#include "import/creased_normals.h"
#include "import/model.h"
#include "import/paths.h"
#include "import/point_cloud.h"
#include "import/text_file.h"
#include "import/vertex_table.h"
#include "lambent/image.h"
#include "scene/triangulate.h"

namespace lambent {

namespace {

constexpr std::uint32_t none = ~0u;
constexpr double crease = 40;  // degrees
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// ---- the header

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
struct TypeName {
  std::string_view name;
  Type type;
};
constexpr TypeName type_names[] = {
    {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
    {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
    {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
    {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
    {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
    {"float64", Type::float64}};
constexpr std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[std::size_t(type)];
}
constexpr bool is_float(Type type) { return type >= Type::float32; }

/// What the reader does with a property.
enum class Use : std::uint8_t {
  x,
  y,
  z,
  nx,
  ny,
  nz,
  red,
  green,
  blue,
  alpha,
  u,
  v,        // numbers; Use is their place in a row
  texture,  // the number of a face's image
  skip,
  indices,
  texcoords,  // lists
};
constexpr std::size_t row_size = std::size_t(Use::skip) + 1;
using Row = std::array<double, row_size>;

struct Known {
  std::string_view name;
  Use use;
};
constexpr Known vertex_numbers[] = {
    {"x", Use::x},
    {"y", Use::y},
    {"z", Use::z},
    {"nx", Use::nx},
    {"ny", Use::ny},
    {"nz", Use::nz},
    {"red", Use::red},
    {"green", Use::green},
    {"blue", Use::blue},
    {"alpha", Use::alpha},
    {"r", Use::red},
    {"g", Use::green},
    {"b", Use::blue},
    {"a", Use::alpha},
    {"diffuse_red", Use::red},
    {"diffuse_green", Use::green},
    {"diffuse_blue", Use::blue},
    {"diffuse_alpha", Use::alpha},
    {"s", Use::u},
    {"t", Use::v},
    {"u", Use::u},
    {"v", Use::v},
    {"texture_u", Use::u},
    {"texture_v", Use::v},
    {"texture_s", Use::u},
    {"texture_t", Use::v},
};
constexpr Known face_numbers[] = {{"red", Use::red},     {"green", Use::green}, {"blue", Use::blue},
                                  {"alpha", Use::alpha}, {"r", Use::red},       {"g", Use::green},
                                  {"b", Use::blue},      {"a", Use::alpha},     {"texnumber", Use::texture}};
constexpr Known face_lists[] = {
    {"vertex_indices", Use::indices}, {"vertex_index", Use::indices}, {"texcoord", Use::texcoords}};

struct Property {
  std::string name;
  Type type = Type::int8;
  bool list = false;
  Type count = Type::int8;  ///< Of a list: how its length is written.
  Use use = Use::skip;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  std::string_view line;  ///< In the header's text.

  const Property* find(Use use) const {
    for (const Property& property : properties)
      if (property.use == use) return &property;
    return nullptr;
  }
  bool has(Use use) const { return find(use) != nullptr; }
};

enum class Format { ascii, little_endian, big_endian };

struct Header {
  TextFile file;
  Format format = Format::ascii;
  std::vector<Element> elements;
  std::vector<std::string_view> textures;  ///< Their names.
  std::size_t size = 0;                    ///< In bytes, with the end of its last line.
  int lines = 0;

  const Element* find(std::string_view name) const {
    for (const Element& element : elements)
      if (element.name == name) return &element;
    return nullptr;
  }
};

std::string_view line_at(std::string_view bytes, std::size_t at, char end) {
  const std::size_t found = bytes.find(end, at);
  return bytes.substr(at, found == std::string_view::npos ? found : found - at);
}

class HeaderReader {
 public:
  /// `header` is filled in place, since views into its text stand in it.
  HeaderReader(const std::string& path, std::string_view bytes, Header& header) : header_(header) {
    std::string_view first = bytes;
    if (first.starts_with("\xef\xbb\xbf")) first.remove_prefix(3);
    if (bytes.empty()) throw InputError(file_error(path, "the file is empty"));
    if (!first.starts_with("ply") ||
        (first.size() > 3 && std::string_view(" \t\r\n").find(first[3]) == std::string_view::npos))
      throw InputError(file_error(path, "not a PLY file: it does not begin with the line 'ply'"));
    find_end(bytes);
    header_.file = text_file(path, std::string(bytes.substr(0, header_.size)));
  }

  void read() {
    LineReader lines(header_.file.text);
    lines.next();  // ply
    bool ended = false;
    while (!ended && lines.next()) {
      std::string_view rest = lines.line;
      const std::string_view key = next_word(rest);
      if (key == "end_header") ended = true;
      else if (!key.empty()) statement(key, rest, lines.line);
    }
    header_.lines = lines.number;
    const std::string_view end = end_of(header_.file.text);
    if (!ended) fail(end, "the file ends within its header", "the header ends with the line 'end_header'");
    if (!has_format_) fail(end, "the header names no format", format_hint);
    check();
  }

 private:
  static constexpr const char* format_hint =
      "formats are: ascii, binary_little_endian, binary_big_endian, each in version 1.0";

  [[noreturn]] void fail(std::string_view word, std::string message, std::string hint = {}) const {
    throw InputError(error_at(header_.file, word, std::move(message), std::move(hint)));
  }

  /// Lines end with LF or CR LF; with CR alone, if the first one does.
  void find_end(std::string_view bytes) {
    const std::size_t first = bytes.find_first_of("\r\n");
    const bool cr = first != std::string_view::npos && bytes[first] == '\r' &&
                    (first + 1 == bytes.size() || bytes[first + 1] != '\n');
    const char end = cr ? '\r' : '\n';
    for (std::size_t at = 0; at < bytes.size();) {
      std::string_view line = line_at(bytes, at, end);
      at = std::min(at + line.size() + 1, bytes.size());
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (trim(line) != "end_header") continue;
      header_.size = at;
      return;
    }
    // For messages: what comes before anything that is no text.
    header_.size = std::min({bytes.size(), bytes.find('\0'), std::size_t(1) << 20});
  }

  void statement(std::string_view key, std::string_view rest, std::string_view line) {
    if (key == "comment") return comment(rest);
    if (key == "obj_info") return;
    if (key == "format") return format(rest, line);
    if (!has_format_)
      fail(key, "the format must stand before " + in_quotes(key) + " in the header", format_hint);
    if (key == "element") return element(rest, line);
    if (key == "property") return property(rest, line);
    fail(key, "unknown statement " + in_quotes(key) + " in the header",
         "the header has: format, comment, obj_info, element, property, end_header");
  }

  void comment(std::string_view rest) {
    const std::string_view key = next_word(rest);
    if (key == "TextureFile" && !trim(rest).empty()) header_.textures.push_back(trim(rest));
  }

  void format(std::string_view rest, std::string_view line) {
    const std::string_view word = next_word(rest), version = next_word(rest);
    if (has_format_) fail(line, "a second format", "a file has one format");
    if (word == "ascii") header_.format = Format::ascii;
    else if (word == "binary_little_endian") header_.format = Format::little_endian;
    else if (word == "binary_big_endian") header_.format = Format::big_endian;
    else
      fail(word.empty() ? end_of(line) : word,
           word.empty() ? "the format is missing" : "unknown format " + in_quotes(word), format_hint);
    if (!version.empty() && version != "1.0")
      fail(version, "unknown version " + in_quotes(version) + " of the format", format_hint);
    has_format_ = true;
  }

  void element(std::string_view rest, std::string_view line) {
    const std::string_view name = next_word(rest), count = next_word(rest);
    const char* const usage = "it is written: element NAME COUNT";
    if (name.empty()) fail(end_of(line), "the element has no name", usage);
    const auto number = parse_integer(count);
    if (!number || *number < 0)
      fail(count.empty() ? end_of(line) : count,
           "element " + in_quotes(name) +
               (count.empty() ? " has no count" : " needs a count, not " + in_quotes(count)),
           usage);
    if (const std::string_view more = next_word(rest); !more.empty())
      fail(more, "unexpected " + in_quotes(more) + " behind the element's count", usage);
    if (!elements_.insert(std::string(name)).second) fail(name, "a second element " + in_quotes(name));
    // clear() would walk over all the buckets that the last element's names had.
    std::unordered_set<std::string>().swap(properties_);
    header_.elements.push_back({std::string(name), std::uint64_t(*number), {}, trim(line)});
  }

  Type type(std::string_view word, std::string_view line) const {
    for (const TypeName& known : type_names)
      if (known.name == word) return known.type;
    fail(word.empty() ? end_of(line) : word,
         word.empty() ? "the property's type is missing" : "unknown type " + in_quotes(word),
         "types are: char, uchar, short, ushort, int, uint, float, double, or int8, uint8, int16, uint16, "
         "int32, "
         "uint32, float32, float64");
  }

  void property(std::string_view rest, std::string_view line) {
    if (header_.elements.empty()) fail(line, "a property before any element");
    Property property;
    std::string_view word = next_word(rest);
    if (word == "list") {
      property.list = true;
      word = next_word(rest);
      property.count = type(word, line);
      if (is_float(property.count))
        fail(word, "the length of a list is a whole number, not a " + std::string(word));
      word = next_word(rest);
    }
    property.type = type(word, line);
    const std::string_view type_word = word, name = next_word(rest);
    if (name.empty()) fail(end_of(line), "the property has no name");
    if (const std::string_view more = next_word(rest); !more.empty())
      fail(more, "unexpected " + in_quotes(more) + " behind the property's name");
    Element& element = header_.elements.back();
    property.name = name;
    if (!properties_.insert(property.name).second) fail(name, "a second property " + in_quotes(name));
    property.use = use_of(element.name, property);
    if (element.has(property.use)) property.use = Use::skip;  // by another name: the first one counts
    if (property.use == Use::indices && is_float(property.type))
      fail(type_word, "indices of vertices are whole numbers, not of type " + in_quotes(type_word));
    element.properties.push_back(std::move(property));
  }

  static Use use_of(const std::string& element, const Property& property) {
    const auto find = [&](const auto& table) {
      for (const Known& known : table)
        if (known.name == property.name) return known.use;
      return Use::skip;
    };
    if (element == "vertex" && !property.list) return find(vertex_numbers);
    if (element == "face") return property.list ? find(face_lists) : find(face_numbers);
    if (element == "tristrips" && property.list && find(face_lists) == Use::indices) return Use::indices;
    return Use::skip;
  }

  void check() const {
    const Element* const vertex = header_.find("vertex");
    if (!vertex) fail(end_of(header_.file.text), "the file has no element 'vertex'");
    for (const auto& [use, name] : {std::pair(Use::x, "x"), std::pair(Use::y, "y"), std::pair(Use::z, "z")})
      if (!vertex->has(use)) fail(vertex->line, std::string("the vertices have no property '") + name + "'");
    if (vertex->count >= none)
      fail(vertex->line, counted(vertex->count, "vertex", "vertices") + " are more than can be numbered");
    for (const char* name : {"face", "tristrips"}) {
      const Element* const element = header_.find(name);
      if (element && element->count > 0 && !element->has(Use::indices))
        fail(element->line, "element " + in_quotes(name) + " has no list 'vertex_indices'");
    }
  }

  Header& header_;
  bool has_format_ = false;
  std::unordered_set<std::string> elements_, properties_;  ///< Names: of all, and of the element at hand.
};

// ---- the numbers behind it: two sources with the same functions

/// A place to read on from. Copies remember where they are.
class Binary {
 public:
  Binary(const std::string& path, std::string_view bytes, std::size_t begin, bool little)
      : path_(path), bytes_(bytes), at_(begin), little_(little) {}

  void begin_element(const Element& element) {
    element_ = &element;
    std::uint64_t least = 0;  // bytes of a row
    for (const Property& p : element.properties) least += size_of(p.list ? p.count : p.type);
    if (least > 0 && element.count > left() / least)
      throw InputError(file_error(path_, "the file is too short: " + counted(element.count, "row", "rows") +
                                             " of element " + in_quotes(element.name) + " take " +
                                             std::to_string(least) + " bytes each at least, but only " +
                                             std::to_string(left()) + " follow byte " + std::to_string(at_)));
  }
  bool empty_rows() const { return element_->properties.empty(); }
  void begin_row(std::uint64_t row) { row_ = row; }
  void end_row() {}

  double number(Type type) {
    const char* const p = take(size_of(type));
    switch (type) {
      case Type::int8:
        return load_number<std::int8_t>(p, little_);
      case Type::uint8:
        return load_number<std::uint8_t>(p, little_);
      case Type::int16:
        return load_number<std::int16_t>(p, little_);
      case Type::uint16:
        return load_number<std::uint16_t>(p, little_);
      case Type::int32:
        return load_number<std::int32_t>(p, little_);
      case Type::uint32:
        return load_number<std::uint32_t>(p, little_);
      case Type::float32:
        return load_number<float>(p, little_);
      case Type::float64:
        return load_number<double>(p, little_);
    }
    return 0;
  }
  std::int64_t integer(Type type) { return std::int64_t(number(type)); }  // of 32 bits at most: exact
  std::uint64_t list_size(const Property& list) {
    const std::int64_t count = integer(list.count);
    if (count < 0) fail("a list of length " + std::to_string(count));
    if (std::uint64_t(count) > left() / size_of(list.type))
      fail("a list of " + counted(std::uint64_t(count), "number", "numbers") + ", but only " +
           std::to_string(left()) + " bytes follow");
    return std::uint64_t(count);
  }
  void skip(Type type, std::uint64_t count) { take(size_of(type) * count); }
  void skip_rows() {
    const bool lists = std::any_of(element_->properties.begin(), element_->properties.end(),
                                   [](const Property& p) { return p.list; });
    if (empty_rows()) return;
    std::uint64_t size = 0;
    for (const Property& p : element_->properties) size += size_of(p.type);
    if (!lists) return void(take(std::size_t(size * element_->count)));
    for (row_ = 0; row_ < element_->count; ++row_)
      for (const Property& p : element_->properties) skip(p.type, p.list ? list_size(p) : 1);
  }

  /// About the number that was read last.
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(file_error(path_, "at byte " + std::to_string(last_) + ", in " + element_->name + " " +
                                           std::to_string(row_) + ": " + message));
  }
  Diagnostic warning(std::string message) const { return file_warning(path_, std::move(message)); }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const char* take(std::size_t size) {
    if (size > left()) {
      throw InputError(file_error(path_, "the file ends at byte " + std::to_string(bytes_.size()) +
                                             ", within " + element_->name + " " + std::to_string(row_) +
                                             " of " + std::to_string(element_->count)));
    }
    last_ = at_;
    at_ += size;
    return bytes_.data() + last_;
  }

  const std::string& path_;
  std::string_view bytes_;
  std::size_t at_, last_ = 0;
  bool little_;
  const Element* element_ = nullptr;
  std::uint64_t row_ = 0;
};

class Ascii {
 public:
  explicit Ascii(const TextFile& file) : file_(file), rest_(file.text) {}

  void begin_element(const Element& element) {
    element_ = &element;
    // A number takes two characters, itself and what parts it from the next.
    const std::uint64_t least = 2 * std::uint64_t(element.properties.size());
    if (least > 0 && element.count > (rest_.size() + 1) / least)
      throw InputError(error_at(file_, rest_.substr(0, 0),
                                "the file is too short: " + counted(element.count, "line", "lines") +
                                    " of element " + in_quotes(element.name) + " cannot stand in " +
                                    counted(rest_.size(), "byte", "bytes")));
  }
  bool empty_rows() const { return element_->properties.empty(); }
  void begin_row(std::uint64_t row) {
    for (;;) {
      if (rest_.empty())
        throw InputError(error_at(file_, end_of(file_.text),
                                  "the file ends behind " + std::to_string(row) + " of " +
                                      counted(element_->count, "line", "lines") + " of element " +
                                      in_quotes(element_->name)));
      line_ = line_at(rest_, 0, '\n');
      rest_.remove_prefix(std::min(line_.size() + 1, rest_.size()));
      words_ = line_;
      skip_blanks();
      if (!words_.empty()) return;
    }
  }
  void end_row() {
    skip_blanks();
    if (!words_.empty() && surplus_.data() == nullptr) surplus_ = words_;
  }

  double number(Type) {
    const std::string_view word = next();
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop == end && error == std::errc() && std::isfinite(value)) return value;
    if (const auto slow = parse_number(word)) return *slow;
    // Scanners write nan where they have seen nothing; MSVC wrote 1.#QNAN.
    const std::string lower = lower_case(word.substr(0, 16));
    const std::string_view text = std::string_view(lower).substr(lower[0] == '-' || lower[0] == '+');
    if (text.starts_with("nan") || text.starts_with("inf") || text.starts_with("1.#")) return nan;
    if (error == std::errc::result_out_of_range) return nan;
    fail(in_quotes(word) + " is not a number");
  }
  std::int64_t integer(Type) {
    const std::string_view word = next();
    std::int64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop == end && error == std::errc()) return value;
    if (const auto slow = parse_integer(word)) return *slow;
    if (const auto number = parse_number(word); number && std::floor(*number) == *number)
      return std::int64_t(std::clamp(*number, -9e18, 9e18));
    fail(in_quotes(word) + " is not a whole number");
  }
  std::uint64_t list_size(const Property& list) {
    const std::int64_t count = integer(list.count);
    if (count < 0) fail("a list of length " + std::to_string(count));
    if (std::uint64_t(count) > words_.size())
      fail("a list of " + counted(std::uint64_t(count), "number", "numbers") +
           " does not stand in this line");
    return std::uint64_t(count);
  }
  void skip(Type, std::uint64_t count) {
    while (count-- > 0) next();
  }
  void skip_rows() {
    if (!empty_rows())
      for (std::uint64_t row = 0; row < element_->count; ++row) begin_row(row);
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(error_at(file_, last_, message));
  }
  Diagnostic warning(std::string message) const {
    return warning_at(file_, surplus_.data() ? surplus_ : end_of(file_.text), std::move(message));
  }
  bool has_surplus() const { return surplus_.data() != nullptr; }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  void skip_blanks() {
    std::size_t i = 0;
    while (i < words_.size() && is_blank(words_[i])) ++i;
    words_.remove_prefix(i);
  }
  std::string_view next() {
    skip_blanks();
    if (words_.empty())
      throw InputError(error_at(file_, end_of(line_),
                                "this line holds too few numbers for element " + in_quotes(element_->name)));
    std::size_t i = 1;
    while (i < words_.size() && !is_blank(words_[i])) ++i;
    last_ = words_.substr(0, i);
    words_.remove_prefix(i);
    return last_;
  }

  const TextFile& file_;
  std::string_view rest_, line_, words_, last_, surplus_;
  const Element* element_ = nullptr;
};

// ---- the model

class PlyReader {
 public:
  PlyReader(const std::string& path, const ImportOptions& options) : path_(path), options_(options) {}

  Model read() {
    check_file_size(path_, options_.limits);
    bytes_ = read_file(path_);
    HeaderReader(path_, bytes_, header_).read();
    if (header_.format == Format::ascii) {
      bytes_.erase(0, header_.size);
      if (const std::size_t zero = bytes_.find('\0'); zero != std::string::npos)
        throw InputError(file_error(path_, "the header says ascii, but byte " +
                                               std::to_string(header_.size + zero) +
                                               " is zero, which is no text"));
      TextFile body = text_file(path_, std::move(bytes_));
      body.first_line = header_.lines + 1;
      Ascii source(body);
      read_elements(source);
      if (source.has_surplus())
        model_.warnings.push_back(
            source.warning("this line holds more numbers than the header names; they are ignored"));
      return finish();
    }
    Binary source(path_, bytes_, header_.size, header_.format == Format::little_endian);
    read_elements(source);
    std::string().swap(bytes_);  // = {} would keep the memory
    return finish();
  }

 private:
  [[noreturn]] void fail(std::string message, std::string hint = {}) const {
    throw InputError(file_error(path_, std::move(message), std::move(hint)));
  }
  void warn(std::string message) { model_.warnings.push_back(file_warning(path_, std::move(message))); }

  /// Faces need the vertices' positions; where they stand before them, they are read afterwards.
  template <class Source> void read_elements(Source& source) {
    split_ = faces_split_vertices();
    std::vector<std::pair<Source, const Element*>> later;
    bool has_vertices = false;
    for (const Element& element : header_.elements) {
      source.begin_element(element);
      const bool faces = element.has(Use::indices);
      if (element.name == "vertex") {
        read_vertices(source, element);
        has_vertices = true;
      } else if (faces && has_vertices) {
        read_faces(source, element);
      } else {
        if (faces) later.push_back({source, &element});
        source.skip_rows();
      }
    }
    for (auto& [at, element] : later) read_faces(at, *element);
  }

  /// Whether faces have what belongs to them alone, and not to their vertices.
  bool faces_split_vertices() const {
    const Element* const face = header_.find("face");
    if (!face) return false;
    return face->has(Use::texcoords) || (colors_of(*face).any && !colors_of(*header_.find("vertex")).any);
  }

  template <class Source> void read_vertices(Source& source, const Element& element) {
    const auto count = std::size_t(element.count);
    has_normals_ = element.has(Use::nx) && element.has(Use::ny) && element.has(Use::nz);
    has_uvs_ = element.has(Use::u) && element.has(Use::v);
    const Colors colors = colors_of(element);
    mesh_.vertices.reserve(count);
    if (has_normals_) mesh_.normals.reserve(count);
    if (has_uvs_) mesh_.uvs.reserve(count);
    if (colors.any) mesh_.colors.reserve(count);
    Row row{};
    for (std::size_t i = 0; i < count; ++i) {
      source.begin_row(i);
      for (const Property& p : element.properties) {
        if (p.list) source.skip(p.type, source.list_size(p));
        else row[std::size_t(p.use)] = source.number(p.type);
      }
      source.end_row();
      const auto number = [&](Use use) { return float(row[std::size_t(use)]); };
      const Vec3<float> position{number(Use::x), number(Use::y), number(Use::z)};
      if (!is_finite(position)) ++without_place_;
      mesh_.vertices.push_back(position);
      if (has_normals_) mesh_.normals.push_back(unit({row[3], row[4], row[5]}));
      if (has_uvs_) mesh_.uvs.push_back(finite({number(Use::u), number(Use::v)}));
      if (colors.any) mesh_.colors.push_back(color(row, colors));
    }
  }

  static bool is_finite(const Vec3<float>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  }
  static Vec2<float> finite(Vec2<float> uv) {
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Vec2<float>{};
  }
  static Vec3<float> unit(const Vec3<double>& n) {
    const double largest = max_abs(n);  // NaN fails the comparison
    if (!(largest > 0) || !std::isfinite(n.x + n.y + n.z)) return {};
    return cast<float>(normalize(n / largest));
  }

  // ---- colours

  struct Colors {
    bool any = false, alpha = false;
    std::array<Type, 4> types{};
  };
  static Colors colors_of(const Element& element) {
    Colors colors;
    colors.any = element.has(Use::red) && element.has(Use::green) && element.has(Use::blue);
    colors.alpha = element.has(Use::alpha);
    if (!colors.any) return colors;
    constexpr Use uses[] = {Use::red, Use::green, Use::blue, Use::alpha};
    for (std::size_t i = 0; i < (colors.alpha ? 4u : 3u); ++i) colors.types[i] = element.find(uses[i])->type;
    return colors;
  }
  std::array<float, 4> color(const Row& row, const Colors& colors) const {
    std::array<float, 4> result{1, 1, 1, 1};
    for (std::size_t i = 0; i < (colors.alpha ? 4u : 3u); ++i) {
      const Type type = colors.types[i];
      const double value = row[std::size_t(Use::red) + i];
      if (is_float(type)) {
        result[i] = value > 0 ? float(std::min(value, i == 3 ? 1.0 : 1e6)) : 0.0f;  // NaN, too
        continue;
      }
      const double share = std::clamp(value / (type == Type::uint16 ? 65535 : 255), 0.0, 1.0);
      if (i == 3) result[i] = float(share);
      else if (type == Type::uint16) result[i] = float(linear_from_srgb(share));
      else result[i] = linear_of_code_[std::size_t(share * 255 + 0.5)];
    }
    return result;
  }
  static std::array<float, 256> make_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < 256; ++i) table[i] = float(linear_from_srgb(double(i) / 255));
    return table;
  }

  // ---- faces

  template <class Source> void read_faces(Source& source, const Element& element) {
    const bool strips = element.name == "tristrips";
    Colors colors = colors_of(element);
    if (colors.any && !mesh_.colors.empty()) {
      warn("vertices and faces have colours; those of the faces are ignored");
      colors.any = false;
    }
    const bool texcoords = element.has(Use::texcoords);
    face_uvs_ |= texcoords;
    face_colors_ |= colors.any;
    has_faces_ |= element.count > 0;
    const bool numbered = element.has(Use::texture) && header_.textures.size() > 1;
    if (!strips && triangles_.empty())
      triangles_.reserve(std::size_t(std::min<std::uint64_t>(element.count, options_.limits.primitives)));
    Row row{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      source.begin_row(i);
      wedge_.clear();
      for (const Property& p : element.properties) {
        if (p.use == Use::indices) read_indices(source, p, strips);
        else if (p.use == Use::texcoords) read_texcoords(source, p);
        else if (p.list) source.skip(p.type, source.list_size(p));
        else row[std::size_t(p.use)] = source.number(p.type);
      }
      source.end_row();
      std::uint32_t color_number = none;
      if (colors.any) {
        const auto c = color(row, colors);
        const auto bits = [&](std::size_t k) { return std::bit_cast<std::uint32_t>(c[k]); };
        color_number = face_color_table_.index_of({bits(0), bits(1), bits(2), bits(3)});
      }
      const std::size_t before = triangles_.size();
      if (strips) add_strips();
      else add_face(color_number);
      if (triangles_.size() > options_.limits.primitives)
        source.fail("more than " + counted(options_.limits.primitives, "triangle", "triangles") +
                    ", which is the limit");
      if (numbered) {
        const double number = row[std::size_t(Use::texture)];
        const bool known = number >= 0 && number < double(header_.textures.size());
        texture_of_.resize(before);
        texture_of_.resize(triangles_.size(), known ? std::uint32_t(number) : 0);
      }
    }
  }

  template <class Source> void read_indices(Source& source, const Property& list, bool strips) {
    const std::uint64_t count = source.list_size(list);
    const std::size_t defined = mesh_.vertices.size();
    indices_.clear();
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t index = source.integer(list.type);
      // -1 ends a strip; unsigned types write it as their largest number.
      if (strips && (index == -1 || index == std::int64_t(none))) {
        indices_.push_back(none);
        continue;
      }
      if (index < 0 || std::uint64_t(index) >= defined)
        source.fail((strips ? "the strip" : "the face") + std::string(" refers to vertex ") +
                    std::to_string(index) + ", but there are " + std::to_string(defined) +
                    ", which count from 0");
      indices_.push_back(std::uint32_t(index));
    }
  }

  template <class Source> void read_texcoords(Source& source, const Property& list) {
    const std::uint64_t count = source.list_size(list);
    for (std::uint64_t i = 0; i < count; ++i) wedge_.push_back(float(source.number(list.type)));
  }

  void add_face(std::uint32_t color) {
    const std::size_t n = indices_.size();
    if (n < 3) return void(++without_area_);
    points_.clear();
    for (const std::uint32_t i : indices_) {
      if (without_place_ > 0 && !is_finite(mesh_.vertices[i])) return void(++unplaced_faces_);
      points_.push_back(cast<double>(mesh_.vertices[i]));
    }
    if (split_) split_corners(color);
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (cross(points_[b] - points_[a], points_[c] - points_[a]) == Vec3<double>{}) ++without_area_;
      else triangles_.push_back({indices_[a], indices_[b], indices_[c]});
    };
    if (n == 3) add(0, 1, 2);
    else if (n == 4 && is_convex_quad()) add(0, 1, 2), add(0, 2, 3);
    else
      for (const auto& t : triangulate(points_)) add(t[0], t[1], t[2]);
  }

  bool is_convex_quad() const {
    const Vec3<double> normal = newell_normal(points_);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto &a = points_[(i + 3) % 4], &b = points_[i], &c = points_[(i + 1) % 4];
      if (!(dot(cross(b - a, c - b), normal) > 0)) return false;
    }
    return true;
  }

  /// From vertices to corners: a vertex with what this face alone gives it.
  void split_corners(std::uint32_t color) {
    const bool uvs = wedge_.size() == 2 * indices_.size();
    if (!uvs && !wedge_.empty()) ++wrong_wedges_;
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      Vec2<float> uv{};
      if (uvs) uv = finite({wedge_[2 * i], wedge_[2 * i + 1]});
      indices_[i] = corner_of(
          {indices_[i], std::bit_cast<std::uint32_t>(uv.x), std::bit_cast<std::uint32_t>(uv.y), color});
    }
  }
  std::uint32_t corner_of(const VertexKey& key) {
    if (corners_.size() == none - 1) fail("more corners of faces than can be numbered");
    return corners_.index_of(key);
  }

  void add_strips() {
    std::size_t begin = 0;  // of the strip at hand
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      if (indices_[i] == none) begin = i + 1;
      if (i < begin + 2) continue;
      const bool even = (i - begin) % 2 == 0;
      const std::uint32_t a = indices_[i - (even ? 2 : 1)], b = indices_[i - (even ? 1 : 2)], c = indices_[i];
      const auto p = [&](std::uint32_t k) { return cast<double>(mesh_.vertices[k]); };
      const Vec3<double> n = cross(p(b) - p(a), p(c) - p(a));
      // Strips turn corners by triangles without area; those are no news.
      if (a == b || b == c || c == a) continue;
      const auto index = [&](std::uint32_t k) { return split_ ? corner_of({k, 0, 0, none}) : k; };
      if (!std::isfinite(n.x + n.y + n.z)) ++unplaced_faces_;
      else if (n == Vec3<double>{}) ++without_area_;
      else triangles_.push_back({index(a), index(b), index(c)});
    }
  }

  // ---- what becomes of it

  Model finish() {
    model_.illumination = ModelId::blinn_phong;
    const std::string name = std::filesystem::path(path_).filename().string();
    ignore_alpha_of_nothing();
    if (!has_faces_) {
      finish_cloud(name);
      return std::move(model_);
    }
    if (triangles_.empty())
      fail(without_area_ + unplaced_faces_ == 0 ? "the file has no faces" : "no face has an area");
    if (unplaced_faces_ > 0)
      warn(counted(unplaced_faces_, "face", "faces") +
           " left out: a vertex has coordinates that are no numbers");
    if (without_area_ > 0)
      warn(counted(without_area_, "face", "faces") + " or parts of them left out: they have no area");
    if (wrong_wedges_ > 0)
      warn(counted(wrong_wedges_, "face has", "faces have") +
           " a list 'texcoord' that does not hold two numbers for each corner; there they are 0");
    mesh_.triangles = std::move(triangles_);
    if (split_) take_corners();
    drop_unused_vertices();
    if (!has_normals_) add_creased_normals(mesh_, crease);
    Shape shape;
    shape.name = name;
    add_materials(shape);
    shape.primitives = std::move(mesh_);
    model_.shapes.push_back(std::move(shape));
    return std::move(model_);
  }

  /// Some programs write an alpha that they never set.
  void ignore_alpha_of_nothing() {
    const auto clear = [](const std::array<float, 4>& c) { return c[3] == 0; };
    if (mesh_.colors.empty() || !std::all_of(mesh_.colors.begin(), mesh_.colors.end(), clear)) return;
    for (auto& c : mesh_.colors) c[3] = 1;
    warn("every vertex has an alpha of 0, which would show nothing; alpha is ignored");
  }

  void finish_cloud(const std::string& name) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) {
      if (without_place_ > 0 && !is_finite(mesh_.vertices[i])) continue;
      mesh_.vertices[kept] = mesh_.vertices[i];
      if (!mesh_.colors.empty()) mesh_.colors[kept] = mesh_.colors[i];
      ++kept;
    }
    mesh_.vertices.resize(kept);
    if (!mesh_.colors.empty()) mesh_.colors.resize(kept);
    if (kept == 0) fail("the file has neither faces nor points");
    if (kept > options_.limits.primitives)
      fail(counted(kept, "point", "points") + ", and the limit is " +
           std::to_string(options_.limits.primitives));
    if (without_place_ > 0)
      warn(counted(without_place_, "point", "points") + " left out: the coordinates are no numbers");
    add_points(model_, name, mesh_.vertices, mesh_.colors);
  }

  /// From here on, the mesh has a vertex for each different corner.
  void take_corners() {
    const std::vector<VertexKey> keys = corners_.take_keys();
    const std::vector<VertexKey> colors = face_color_table_.take_keys();
    const auto gather = [&](auto& list) {
      if (list.empty()) return;
      auto gathered = std::decay_t<decltype(list)>();
      gathered.reserve(keys.size());
      for (const auto& key : keys) gathered.push_back(list[key[0]]);
      list = std::move(gathered);
    };
    gather(mesh_.vertices);
    gather(mesh_.normals);
    gather(mesh_.colors);
    gather(mesh_.uvs);
    const auto number = [](std::uint32_t bits) { return std::bit_cast<float>(bits); };
    if (face_uvs_) {
      mesh_.uvs.clear();
      for (const auto& key : keys) mesh_.uvs.push_back({number(key[1]), number(key[2])});
      has_uvs_ = true;
    }
    if (!face_colors_) return;
    for (const auto& key : keys) {
      const VertexKey white{std::bit_cast<std::uint32_t>(1.0f), std::bit_cast<std::uint32_t>(1.0f),
                            std::bit_cast<std::uint32_t>(1.0f), std::bit_cast<std::uint32_t>(1.0f)};
      const VertexKey& c = key[3] == none ? white : colors[key[3]];
      mesh_.colors.push_back({number(c[0]), number(c[1]), number(c[2]), number(c[3])});
    }
  }

  /// Scans hold points that no face uses, and far away; they would set the size of the model.
  void drop_unused_vertices() {
    std::vector<std::uint32_t> new_index(mesh_.vertices.size(), none);
    for (const auto& triangle : mesh_.triangles)
      for (const std::uint32_t i : triangle) new_index[i] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t& index : new_index)
      if (index != none) index = count++;
    if (count == new_index.size()) return;
    const auto pack = [&](auto& list) {
      if (list.empty()) return;
      for (std::size_t i = 0; i < new_index.size(); ++i)
        if (new_index[i] != none) list[new_index[i]] = list[i];
      list.resize(count);
      list.shrink_to_fit();
    };
    pack(mesh_.vertices);
    pack(mesh_.normals);
    pack(mesh_.uvs);
    pack(mesh_.colors);
    for (auto& triangle : mesh_.triangles)
      for (std::uint32_t& i : triangle) i = new_index[i];
  }

  void add_materials(Shape& shape) {
    const bool textured = has_uvs_ && !header_.textures.empty();
    const std::size_t count = textured ? (texture_of_.empty() ? 1 : header_.textures.size()) : 1;
    const Material plain = textured || !mesh_.colors.empty() ? coloring_material() : neutral_material();
    for (std::size_t i = 0; i < count; ++i) {
      Material material = plain;
      if (count > 1) material.name = "texture " + std::to_string(i + 1);
      if (textured) add_texture(material, header_.textures[i]);
      model_.materials.push_back(std::move(material));
    }
    if (count == 1) return;
    texture_of_.resize(mesh_.triangles.size());
    shape.material_of_primitive = std::move(texture_of_);
  }

  void add_texture(Material& material, std::string_view name) {
    const NamedFile found = find_named_file(path_, name, options_);
    if (found.path.empty()) {
      model_.warnings.push_back(
          warning_at(header_.file, name,
                     found.outside ? "texture " + in_quotes(name) + " lies outside of the model's folder"
                                   : "texture " + in_quotes(name) + " is not there"));
      return;
    }
    Texture texture;
    texture.source.name = texture.source.file = found.path;
    texture.source.place = place_of(header_.file, name);
    TextureMap map;
    map.texture = std::uint32_t(model_.textures.size());
    model_.textures.push_back(std::move(texture));
    material.maps.push_back({MapSlot::ambient, map});
    material.maps.push_back({MapSlot::diffuse, map});
  }

  std::string path_;
  const ImportOptions& options_;
  std::string bytes_;
  Header header_;
  Model model_;

  Mesh mesh_;  ///< Its vertices as the file has them.
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> texture_of_;  ///< Of each triangle, where there are several.
  bool has_normals_ = false, has_uvs_ = false, has_faces_ = false;
  bool split_ = false, face_uvs_ = false, face_colors_ = false;
  VertexTable corners_;             ///< Keys: vertex, u and v of the face, colour of the face.
  PositionTable face_color_table_;  ///< Keys: the bits of R, G, B, alpha.
  std::size_t without_place_ = 0, without_area_ = 0, unplaced_faces_ = 0, wrong_wedges_ = 0;
  std::array<float, 256> linear_of_code_ = make_table();

  // The face at hand; kept for their memory.
  std::vector<std::uint32_t> indices_;
  std::vector<float> wedge_;
  std::vector<Vec3<double>> points_;
};

}  // namespace

Model import_ply(const std::string& path, const ImportOptions& options) {
  return PlyReader(path, options).read();
}

}  // namespace lambent
