#pragma once
// Makes small glTF files for tests.

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lambent::test {

inline std::string base64(const std::string& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

/// A file with one buffer, to which accessors are added; `root` may be changed at will.
class GltfBuilder {
 public:
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}};

  /// An accessor of numbers of type T; answers its index. min and max are declared.
  template <class T>
  std::size_t add(const std::vector<T>& numbers, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1
                                   : type == "MAT4" ? 16
                                                    : std::size_t(type.back() - '0');
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    nlohmann::json accessor = {{"bufferView", root["bufferViews"].size()},
                               {"componentType", component_type<T>()},
                               {"count", numbers.size() / components},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", numbers.size() * sizeof(T)}});
    for (std::size_t c = 0; c < components; ++c) {
      T low = numbers[c], high = low;
      for (std::size_t i = c; i < numbers.size(); i += components)
        low = std::min(low, numbers[i]), high = std::max(high, numbers[i]);
      accessor["min"].push_back(low);
      accessor["max"].push_back(high);
    }
    const std::size_t at = bytes_.size();
    bytes_.resize(at + numbers.size() * sizeof(T));
    std::memcpy(&bytes_[at], numbers.data(), numbers.size() * sizeof(T));
    root["accessors"].push_back(accessor);
    return root["accessors"].size() - 1;
  }

  /// A mesh of one primitive, and a node of the scene that shows it; answers the node.
  std::size_t show(const nlohmann::json& primitive) {
    root["meshes"].push_back({{"primitives", {primitive}}});
    return add_node({{"mesh", root["meshes"].size() - 1}});
  }
  std::size_t add_node(const nlohmann::json& node) {
    root["nodes"].push_back(node);
    root["scenes"][0]["nodes"].push_back(root["nodes"].size() - 1);
    return root["nodes"].size() - 1;
  }

  const std::string& bytes() const { return bytes_; }
  /// As .gltf, with the buffer inside.
  std::string text() const {
    nlohmann::json all = root;
    if (!bytes_.empty())
      all["buffers"] = {
          {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
    return all.dump();
  }
  /// As .glb.
  std::string binary() const {
    nlohmann::json all = root;
    all["buffers"] = {{{"byteLength", bytes_.size()}}};
    std::string json = all.dump(), data = bytes_;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF";
    for (const std::size_t n : {std::size_t{2}, 12 + 8 + json.size() + 8 + data.size(), json.size()})
      append(file, n);
    file += "JSON" + json;
    append(file, data.size());
    return file + std::string("BIN\0", 4) + data;
  }

 private:
  template <class T> static int component_type() {
    if constexpr (std::is_same_v<T, float>) return 5126;
    else if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    else if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    else if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    else if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    else return 5125;
  }
  static void append(std::string& file, std::size_t n) {
    for (int i = 0; i < 4; ++i) file += char(n >> (8 * i) & 0xff);
  }

  std::string bytes_;
};

}  // namespace lambent::test
