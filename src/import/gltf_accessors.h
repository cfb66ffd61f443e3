#pragma once
// Buffers, views of them, and accessors: how glTF stores its numbers (the specification, chapter 3.6).

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/gltf_file.h"
#include "import/gltf_json.h"
#include "import/model.h"

namespace lambent::gltf {

/// How an accessor's elements are laid out.
struct Layout {
  int component_type = 5126;  ///< 5120 to 5126, as OpenGL counts.
  int component_size = 4;     ///< Bytes.
  int rows = 1, columns = 1;  ///< Of a matrix; of a vector one column.
  int column_stride = 4;      ///< Bytes: columns of matrices begin at multiples of 4.
  int components() const { return rows * columns; }
  /// Bytes that one element takes, from its first to its last.
  int size() const { return (columns - 1) * column_stride + rows * component_size; }
  /// Bytes from one element to the next where no stride is given.
  int stride() const { return columns > 1 ? columns * column_stride : size(); }
};
Layout layout_of(const Json& accessor);
/// "VEC3 of UNSIGNED_BYTE", for messages.
std::string name_of_format(const Json& accessor);
/// Bytes of a number of this type: 1, 2 or 4.
int component_size(int component_type);

/// The file's bytes.
class Buffers {
 public:
  Buffers(const Json& root, const Container& container, const ImportOptions& options, Remarks& remarks);

  /// The bytes of a buffer, `byteLength` of them; nothing where there are none, and then `why_not` says why.
  /// Throws InputError where there are some and they do not suffice.
  std::optional<std::string_view> bytes(std::size_t buffer);
  const std::string& why_not(std::size_t buffer) const { return buffers_[buffer].why_not; }
  /// The remedy, or empty.
  const std::string& hint(std::size_t buffer) const { return buffers_[buffer].hint; }
  /// Whether an accessor names a buffer that the file itself leaves open: it has no uri.
  bool is_open(std::size_t accessor) const;
  /// The bytes of a buffer view; likewise.
  std::optional<std::string_view> view(std::size_t buffer_view);
  /// Whether all bytes of an accessor are there; false for one that is nothing but zeroes.
  bool has_accessor(std::size_t accessor);
  /// Says of a sparse accessor that its elements are read once more. Throws InputError where what shares
  /// them makes too many of few.
  void read_again(std::uint64_t sparse_elements, const std::string& at);
  /// All bytes that the file and its buffers have brought so far.
  std::uint64_t total() const { return total_; }

 private:
  struct Buffer {
    bool asked = false;
    std::string own;  ///< Of a data URI.
    std::optional<std::string_view> bytes;
    std::string why_not, hint;
  };
  void load(std::size_t number, Buffer& buffer);
  void load_file(const std::string& uri, const std::string& at, Buffer& buffer);

  const Json& root_;
  const Container& container_;
  const ImportOptions& options_;
  Remarks& remarks_;
  std::vector<Buffer> buffers_;
  std::map<std::string, std::string> files_;  ///< By path: several buffers may name one.
  std::uint64_t total_;
  std::uint64_t sparse_elements_ = 0;  ///< Read so far.
};

/// The elements of one accessor, read where they lie.
class Accessor {
 public:
  /// The bounds must have been checked (check_rules). Throws InputError where its bytes are missing, or where
  /// it has more elements than the file's bytes can be meant for.
  Accessor(const Json& root, std::size_t number, Buffers& buffers, Remarks& remarks);

  std::size_t count() const { return count_; }
  const Layout& layout() const { return layout_; }
  int components() const { return layout_.components(); }
  /// Elements that stand elsewhere, growing; those of an accessor without a base are all that is not zero.
  const std::vector<std::uint32_t>& replaced() const { return replaced_; }
  bool has_base() const { return data_ != nullptr; }
  /// A component as it is stored.
  double raw(std::size_t element, int component) const;
  /// The same, but what is `normalized` is brought to [0, 1] or [-1, 1].
  double value(std::size_t element, int component) const;
  /// For indices.
  std::uint32_t index(std::size_t element, int component = 0) const {
    return std::uint32_t(raw(element, component));
  }

 private:
  void read_sparse(const Json& sparse, const std::string& at, Buffers& buffers, Remarks& remarks);
  const char* bytes_of(std::size_t element) const;

  Layout layout_;
  std::size_t count_ = 0, stride_ = 0;
  bool normalized_ = false;
  const char* data_ = nullptr;  ///< None: all zero.
  std::vector<std::uint32_t> replaced_;
  const char* replacements_ = nullptr;
};

/// What an accessor's numbers must fulfil: finite, within its own min and max, which are themselves reached;
/// indices of vertices that there are, tangents with a side. All accessors whose bytes are there are
/// checked.
void check_data(const Json& root, Buffers& buffers, Remarks& remarks);

}  // namespace lambent::gltf
