#include "import/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "import/paths.h"
#include "import/text_file.h"

namespace lambent::gltf {

namespace {

template <class T> double stored(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // may lie anywhere; glTF and the machine are little-endian
  return double(value);
}

double component_at(const char* bytes, int type) {
  switch (type) {
    case 5120:
      return stored<std::int8_t>(bytes);
    case 5121:
      return stored<std::uint8_t>(bytes);
    case 5122:
      return stored<std::int16_t>(bytes);
    case 5123:
      return stored<std::uint16_t>(bytes);
    case 5125:
      return stored<std::uint32_t>(bytes);
    default:
      return stored<float>(bytes);
  }
}

std::string decimal(double x) { return Json(x).dump(); }

}  // namespace

int component_size(int component_type) { return component_type <= 5121 ? 1 : component_type <= 5123 ? 2 : 4; }

Layout layout_of(const Json& accessor) {
  Layout layout;
  layout.component_type = int(whole(accessor, "componentType", 5126));
  layout.component_size = component_size(layout.component_type);
  const std::string type = text(accessor, "type", "SCALAR");
  const int n = type == "SCALAR" ? 1 : type.back() - '0';
  layout.rows = n;
  layout.columns = type.starts_with("MAT") ? n : 1;
  layout.column_stride = (n * layout.component_size + 3) / 4 * 4;
  return layout;
}

std::string name_of_format(const Json& accessor) {
  static constexpr const char* names[] = {"BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT",
                                          "",     "UNSIGNED_INT",  "FLOAT"};
  const int type = layout_of(accessor).component_type;
  return text(accessor, "type") + " of " + (flag(accessor, "normalized", false) ? "normalized " : "") +
         names[std::clamp(type - 5120, 0, 6)];
}

// ---- buffers

Buffers::Buffers(const Json& root, const Container& container, const ImportOptions& options, Remarks& remarks)
    : root_(root),
      container_(container),
      options_(options),
      remarks_(remarks),
      buffers_(member(root, "buffers").size()),
      total_(container.bytes.size()) {}

std::optional<std::string_view> Buffers::bytes(std::size_t number) {
  Buffer& buffer = buffers_[number];
  if (!buffer.asked) {
    buffer.asked = true;
    load(number, buffer);
  }
  return buffer.bytes;
}

void Buffers::load(std::size_t number, Buffer& buffer) {
  const Json& json = root_["buffers"][number];
  const std::string at = std::string("/buffers") / number;
  const std::uint64_t length = whole(json, "byteLength", 0);
  const Json& uri = member(json, "uri");
  if (uri.is_null()) {
    if (number == 0 && container_.data()) buffer.bytes = *container_.data();
    else
      buffer.why_not = container_.binary
                           ? "the buffer has no uri, and is not the first one of a GLB with data"
                           : "the buffer has no uri";
  } else if (const std::string& name = uri.get_ref<const std::string&>(); is_data_uri(name)) {
    std::string complaint;
    auto data = read_data_uri(name, complaint);
    if (!data) remarks_.fail(at + "/uri", complaint);
    buffer.own = std::move(data->bytes);
    buffer.bytes = buffer.own;
  } else {
    load_file(name, at + "/uri", buffer);
  }
  if (!buffer.bytes) return;
  if (buffer.bytes->size() < length)
    remarks_.fail(at, "is to have " + std::to_string(length) + " bytes, but there are only " +
                          std::to_string(buffer.bytes->size()));
  total_ += buffer.own.size();
}

void Buffers::load_file(const std::string& uri, const std::string& at, Buffer& buffer) {
  const auto name = percent_decoded(uri);
  if (!name)
    remarks_.fail(at, in_quotes(uri) + " is malformed: % must be followed by two hexadecimal digits");
  if (has_scheme(uri)) {
    buffer.why_not = in_quotes(uri) + " is no file beside this one";
    return;
  }
  NamedFile file = find_named_file(remarks_.file(), *name, options_);
  if (file.path.empty() && *name != uri) file = find_named_file(remarks_.file(), uri, options_);
  if (file.path.empty()) {
    buffer.why_not = "there is no file " + in_quotes(*name);
    if (file.outside) {
      buffer.why_not = in_quotes(*name) + " lies outside of the model's folder";
      buffer.hint = hint_for_outside;
    }
    return;
  }
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file.path, ignored);
  if (!ignored && size > options_.limits.file_bytes)
    remarks_.fail(at, in_quotes(file.path) + " has " + std::to_string(size) + " bytes; the limit is " +
                          std::to_string(options_.limits.file_bytes));
  const auto [found, is_new] = files_.try_emplace(file.path);
  if (is_new) {
    found->second = read_file(file.path);
    total_ += found->second.size();
  }
  buffer.bytes = found->second;
}

std::optional<std::string_view> Buffers::view(std::size_t number) {
  const Json& json = root_["bufferViews"][number];
  const auto all = bytes(whole(json, "buffer", 0));
  if (!all) return std::nullopt;
  return all->substr(whole(json, "byteOffset", 0), whole(json, "byteLength", 0));
}

void Buffers::read_again(std::uint64_t sparse_elements, const std::string& at) {
  constexpr std::uint64_t most_times = 16, harmless = 1 << 20;
  sparse_elements_ += sparse_elements;
  if (sparse_elements_ > harmless && sparse_elements_ / most_times > total_)
    remarks_.fail(at, "what shares its elements makes them more than " + std::to_string(most_times) +
                          " times the file's bytes");
}

bool Buffers::is_open(std::size_t accessor) const {
  const Json& json = root_["accessors"][accessor];
  const auto open = [&](const Json& view) {
    if (view.is_null()) return false;
    const std::size_t buffer = whole(root_["bufferViews"][view.get<std::size_t>()], "buffer", 0);
    return member(root_["buffers"][buffer], "uri").is_null() && !(buffer == 0 && container_.data());
  };
  const Json& sparse = member(json, "sparse");
  return open(member(json, "bufferView")) || (!sparse.is_null() && (open(sparse["indices"]["bufferView"]) ||
                                                                    open(sparse["values"]["bufferView"])));
}

bool Buffers::has_accessor(std::size_t accessor) {
  const Json& json = root_["accessors"][accessor];
  const auto is_there = [&](const Json& view_index) {
    return view_index.is_null() || view(view_index.get<std::size_t>()).has_value();
  };
  const Json &base = member(json, "bufferView"), &sparse = member(json, "sparse");
  if (base.is_null() && sparse.is_null()) return false;
  if (!is_there(base)) return false;
  return sparse.is_null() ||
         (is_there(sparse["indices"]["bufferView"]) && is_there(sparse["values"]["bufferView"]));
}

// ---- accessors

Accessor::Accessor(const Json& root, std::size_t number, Buffers& buffers, Remarks& remarks) {
  const Json& json = root["accessors"][number];
  const std::string at = std::string("/accessors") / number;
  layout_ = layout_of(json);
  count_ = whole(json, "count", 0);
  normalized_ = flag(json, "normalized", false);
  stride_ = std::size_t(layout_.stride());
  const Json& view = member(json, "bufferView");
  if (view.is_null()) {
    // Zeroes cost the file nothing, and what is made of them costs memory.
    if (count_ > buffers.total() + 1024)
      remarks.fail(at, "has " + std::to_string(count_) +
                           " elements without a bufferView, more than the file has bytes");
  } else {
    const std::size_t index = view.get<std::size_t>();
    const auto bytes = buffers.view(index);
    const Json& buffer_view = root["bufferViews"][index];
    if (!bytes) {
      const std::size_t buffer = whole(buffer_view, "buffer", 0);
      remarks.fail(std::string("/buffers") / buffer, buffers.why_not(buffer), buffers.hint(buffer));
    }
    data_ = bytes->data() + whole(json, "byteOffset", 0);
    stride_ = whole(buffer_view, "byteStride", stride_);
  }
  if (const Json& sparse = member(json, "sparse"); sparse.is_object())
    read_sparse(sparse, at + "/sparse", buffers, remarks);
}

void Accessor::read_sparse(const Json& sparse, const std::string& at, Buffers& buffers, Remarks& remarks) {
  const std::size_t count = whole(sparse, "count", 0);
  buffers.read_again(count, at);
  const Json &indices = sparse["indices"], &values = sparse["values"];
  const auto index_bytes = buffers.view(whole(indices, "bufferView", 0)),
             value_bytes = buffers.view(whole(values, "bufferView", 0));
  if (!index_bytes || !value_bytes) remarks.fail(at, "its buffer has no bytes");
  const int type = int(whole(indices, "componentType", 5125)), size = component_size(type);
  const char* first = index_bytes->data() + whole(indices, "byteOffset", 0);
  replaced_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = std::uint32_t(component_at(first + i * std::size_t(size), type));
    if (index >= count_)
      remarks.fail(at + "/indices", "index " + std::to_string(i) + " is " + std::to_string(index) +
                                        ", but there are " + std::to_string(count_) + " elements");
    if (!replaced_.empty() && index <= replaced_.back())
      remarks.fail(at + "/indices", "index " + std::to_string(i) + " is not larger than the one before");
    replaced_.push_back(index);
  }
  replacements_ = value_bytes->data() + whole(values, "byteOffset", 0);
}

const char* Accessor::bytes_of(std::size_t element) const {
  if (!replaced_.empty()) {
    const auto found = std::lower_bound(replaced_.begin(), replaced_.end(), element);
    if (found != replaced_.end() && *found == element)
      return replacements_ + std::size_t(found - replaced_.begin()) * std::size_t(layout_.stride());
  }
  return data_ ? data_ + element * stride_ : nullptr;
}

double Accessor::raw(std::size_t element, int component) const {
  const char* bytes = bytes_of(element);
  if (!bytes) return 0;
  const int column = component / layout_.rows, row = component % layout_.rows;
  return component_at(bytes + column * layout_.column_stride + row * layout_.component_size,
                      layout_.component_type);
}

double Accessor::value(std::size_t element, int component) const {
  const double x = raw(element, component);
  if (!normalized_) return x;
  switch (layout_.component_type) {
    case 5120:
      return std::max(x / 127, -1.0);
    case 5121:
      return x / 255;
    case 5122:
      return std::max(x / 32767, -1.0);
    case 5123:
      return x / 65535;
    default:
      return x;
  }
}

// ---- what the numbers must fulfil

namespace {

/// Exporters write min and max in decimals, or compute them before they round to float.
bool about_equal(double a, double b) {
  return std::abs(a - b) <= 1e-5 * std::max({std::abs(a), std::abs(b), 1e-3});
}

class DataCheck {
 public:
  DataCheck(const Json& root, Buffers& buffers, Remarks& remarks)
      : root_(root), buffers_(buffers), remarks_(remarks) {}

  void accessors() {
    const Json& all = member(root_, "accessors");
    effort(all);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (buffers_.has_accessor(i))
        accessor(all[i], Accessor(root_, i, buffers_, remarks_), std::string("/accessors") / i);
  }

  void indices() {
    const Json& meshes = member(root_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
        const Json& primitive = meshes[m]["primitives"][p];
        const Json &indices = member(primitive, "indices"),
                   &positions = member(primitive["attributes"], "POSITION");
        if (indices.is_null() || positions.is_null() || !buffers_.has_accessor(indices.get<std::size_t>()))
          continue;
        const std::uint64_t vertices = whole(root_["accessors"][positions.get<std::size_t>()], "count", 0);
        if (const std::uint32_t largest = largest_index(indices.get<std::size_t>()); largest >= vertices)
          remarks_.error(
              std::string("/meshes") / m / std::string_view("primitives") / p / std::string_view("indices"),
              "the largest index is " + std::to_string(largest) + ", but there are " +
                  std::to_string(vertices) + " vertices");
      }
  }

  void tangents() {
    const Json& meshes = member(root_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
        const Json& attributes = meshes[m]["primitives"][p]["attributes"];
        const std::string at =
            std::string("/meshes") / m / std::string_view("primitives") / p / std::string_view("attributes");
        if (const Json& index = member(attributes, "NORMAL"); !index.is_null())
          directions(index, at + "/NORMAL");
        if (const Json& index = member(attributes, "TANGENT"); !index.is_null())
          directions(index, at + "/TANGENT");
      }
  }

 private:
  /// Accessors may share bytes, but must not make the numbers of a small file many: they are all looked at.
  void effort(const Json& all) {
    constexpr std::uint64_t most_times = 256;
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!buffers_.has_accessor(i)) continue;
      const Json& counted = member(all[i], "bufferView").is_null() ? all[i]["sparse"] : all[i];
      bytes += whole(counted, "count", 0) * std::uint64_t(layout_of(all[i]).size());
      if (bytes / most_times > buffers_.total())
        remarks_.fail("/accessors", "together they have more than " + std::to_string(most_times) +
                                        " times the file's bytes");
    }
  }

  /// Normals and tangents.
  void directions(const Json& index, const std::string& at) {
    const auto number = index.get<std::size_t>();
    if (!buffers_.has_accessor(number) || !seen_.insert(number).second) return;
    const Accessor all(root_, number, buffers_, remarks_);
    bool odd = false;
    for (std::size_t i = 0; i < all.count(); ++i) {
      const double x = all.value(i, 0), y = all.value(i, 1), z = all.value(i, 2),
                   side = all.components() == 4 ? all.value(i, 3) : 1;
      if (std::abs(side) != 1)
        return remarks_.error(at, "the fourth number of vertex " + std::to_string(i) +
                                      " must be 1 or -1, not " + decimal(side));
      // As the validator has it; normalized bytes hold no better ones.
      odd |= std::abs(std::sqrt(x * x + y * y + z * z) - 1) > 0.02;
    }
    if (odd) remarks_.warn(at, "not all are of length 1; they are brought to it");
  }

  void accessor(const Json& json, const Accessor& accessor, const std::string& at) {
    const int components = accessor.components();
    const bool floats = accessor.layout().component_type == 5126;
    const Json &least = member(json, "min"), &most = member(json, "max");
    if (!floats && least.is_null() && most.is_null()) return;
    // Of zeroes with replacements, as morph targets are, one zero says as much as all.
    const std::vector<std::uint32_t>& replaced = accessor.replaced();
    const bool all = accessor.has_base();
    const std::size_t count = all ? accessor.count() : replaced.size();
    for (int c = 0; c < components; ++c) {
      double low = all || replaced.size() == accessor.count() ? accessor.raw(all ? 0 : replaced[0], c) : 0;
      double high = low;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = all ? k : replaced[k];
        const double x = accessor.raw(i, c);
        if (!std::isfinite(x))
          return remarks_.error(at, "element " + std::to_string(i) + " is not a finite number");
        low = std::min(low, x), high = std::max(high, x);
      }
      bound(least, c, low, at + "/min");
      bound(most, c, high, at + "/max");
    }
  }
  void bound(const Json& declared, int component, double actual, const std::string& at) {
    if (!declared.is_array() || declared.size() <= std::size_t(component)) return;
    const double said = declared[std::size_t(component)].get<double>();
    if (!about_equal(said, actual))
      remarks_.error(at / std::size_t(component),
                     "is " + decimal(said) + ", but the elements have " + decimal(actual));
  }

  /// Many primitives may share one accessor.
  std::uint32_t largest_index(std::size_t number) {
    const auto [found, is_new] = largest_.try_emplace(number, 0);
    if (is_new) {
      const Accessor indices(root_, number, buffers_, remarks_);
      for (std::size_t i = 0; i < indices.count(); ++i)
        found->second = std::max(found->second, indices.index(i));
    }
    return found->second;
  }

  std::map<std::size_t, std::uint32_t> largest_;
  std::set<std::size_t> seen_;
  const Json& root_;
  Buffers& buffers_;
  Remarks& remarks_;
};

}  // namespace

void check_data(const Json& root, Buffers& buffers, Remarks& remarks) {
  DataCheck check(root, buffers, remarks);
  check.accessors();
  remarks.throw_errors();
  check.indices();
  check.tangents();
}

}  // namespace lambent::gltf
