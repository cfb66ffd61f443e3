#include "import/gltf_rules.h"

#include <charconv>
#include <fstream>

#include "import/gltf_schema.h"
#include "import/paths.h"
#include "import/text_file.h"

namespace lambent::gltf {

namespace {

bool lists(const Json& names, std::string_view name) {
  for (const Json& entry : names)
    if (entry.get_ref<const std::string&>() == name) return true;
  return false;
}

class Rules {
 public:
  Rules(const Json& root, Remarks& remarks) : root_(root), remarks_(remarks) {}

  void check() {
    asset();
    extensions();
    each("buffers", [&](const Json& json, const std::string& at) { buffer(json, at); });
    each("bufferViews", [&](const Json& json, const std::string& at) { buffer_view(json, at); });
    remarks_.throw_errors();  // what follows measures by them
    each("accessors", [&](const Json& json, const std::string& at) { accessor(json, at); });
    each("images", [&](const Json& json, const std::string& at) { image(json, at); });
    each("cameras", [&](const Json& json, const std::string& at) { camera(json, at); });
    const Json& all_lights = member(extension(root_, "KHR_lights_punctual"), "lights");
    for (std::size_t i = 0; i < all_lights.size(); ++i)
      light(all_lights[i], std::string("/extensions/KHR_lights_punctual/lights") / i);
  }

 private:
  template <class Do> void each(const char* list, Do what) {
    const Json& all = member(root_, list);
    for (std::size_t i = 0; i < all.size(); ++i) what(all[i], ("/" + std::string(list)) / i);
  }

  struct Version {
    int major = 0, minor = 0;
    bool operator<(const Version& other) const {
      return major != other.major ? major < other.major : minor < other.minor;
    }
  };
  static std::optional<Version> version(const std::string& text) {
    Version result;
    const char* end = text.data() + text.size();
    const auto major = std::from_chars(text.data(), end, result.major);
    if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
    const auto minor = std::from_chars(major.ptr + 1, end, result.minor);
    if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
    return result;
  }
  void asset() {
    const Json& asset = root_["asset"];
    const std::string written = text(asset, "version"), least = text(asset, "minVersion", "2.0");
    const auto is = version(written), needed = version(least);
    if (!is) return remarks_.error("/asset/version", in_quotes(written) + " is no version", "as \"2.0\"");
    if (!needed)
      return remarks_.error("/asset/minVersion", in_quotes(least) + " is no version", "as \"2.0\"");
    if (is->major != 2)
      return remarks_.error("/asset/version", "glTF " + in_quotes(written) + " is not supported, only 2.0");
    if (*is < *needed)
      return remarks_.error("/asset/minVersion", "is later than the file's own version, " + written);
    if (Version{2, 0} < *needed)
      remarks_.warn("/asset/minVersion",
                    "the file is meant for readers of glTF " + least + "; it is read as 2.0");
  }

  void extensions() {
    const Json &used = member(root_, "extensionsUsed"), &needed = member(root_, "extensionsRequired");
    for (std::size_t i = 0; i < needed.size(); ++i) {
      const std::string& name = needed[i].get_ref<const std::string&>();
      const std::string at = std::string("/extensionsRequired") / i;
      if (!lists(used, name)) remarks_.error(at, in_quotes(name) + " is missing in extensionsUsed");
      if (!is_understood(name))
        remarks_.error(at, "the file needs the extension " + in_quotes(name) + ", which is not supported");
    }
    for (std::size_t i = 0; i < used.size(); ++i) {
      const std::string& name = used[i].get_ref<const std::string&>();
      const std::string at = std::string("/extensionsUsed") / i;
      if (!is_understood(name))
        remarks_.warn(at,
                      "the extension " + in_quotes(name) + " is not supported; the file is shown without it");
      if (name == "KHR_mesh_quantization" && !lists(needed, name))
        remarks_.error(at, "'KHR_mesh_quantization' must also be in extensionsRequired");
    }
  }

  void buffer(const Json& json, const std::string& at) {
    const Json& uri = member(json, "uri");
    if (uri.is_null() || !is_data_uri(uri.get_ref<const std::string&>())) return;
    std::string complaint;
    const auto data = read_data_uri(uri.get_ref<const std::string&>(), complaint);
    if (!data) return remarks_.error(at + "/uri", complaint);
    if (data->media_type != "application/octet-stream" && data->media_type != "application/gltf-buffer")
      remarks_.error(at + "/uri",
                     "the media type of a buffer must be application/octet-stream or "
                     "application/gltf-buffer, not " +
                         in_quotes(data->media_type));
  }

  void buffer_view(const Json& json, const std::string& at) {
    const std::uint64_t offset = whole(json, "byteOffset", 0), length = whole(json, "byteLength", 0),
                        all = whole(root_["buffers"][whole(json, "buffer", 0)], "byteLength", 0);
    if (offset > all || length > all - offset)
      remarks_.error(at, "its bytes " + std::to_string(offset) + " to " + std::to_string(offset + length) +
                             " do not fit into the buffer's " + std::to_string(all));
    const std::uint64_t stride = whole(json, "byteStride", 4);
    if (stride % 4 != 0) remarks_.error(at + "/byteStride", "must be a multiple of 4");
    if (member(json, "byteStride").is_number() && stride > length)
      remarks_.error(at + "/byteStride", "is larger than the view's " + std::to_string(length) + " bytes");
  }

  void accessor(const Json& json, const std::string& at) {
    const Layout layout = layout_of(json);
    const std::uint64_t count = whole(json, "count", 0), offset = whole(json, "byteOffset", 0);
    for (const char* bound : {"min", "max"})
      if (const Json& list = member(json, bound);
          !list.is_null() && list.size() != std::size_t(layout.components()))
        remarks_.error(at / std::string_view(bound),
                       "must have " + std::to_string(layout.components()) + " elements");
    if (flag(json, "normalized", false) && layout.component_size == 4)
      remarks_.error(at + "/normalized", "only bytes and shorts can be normalized");
    if (layout.columns > 1 && offset % 4 != 0)
      remarks_.error(at + "/byteOffset", "must be a multiple of 4 for matrices");
    if (const Json& view = member(json, "bufferView"); !view.is_null()) {
      const Json& buffer_view = root_["bufferViews"][view.get<std::size_t>()];
      const bool strided = member(buffer_view, "byteStride").is_number();
      const std::uint64_t stride =
          strided ? whole(buffer_view, "byteStride", 0) : std::uint64_t(layout.stride());
      if (stride < std::uint64_t(layout.size()))
        remarks_.error(at, "an element has " + std::to_string(layout.size()) +
                               " bytes, more than the byteStride " + std::to_string(stride) +
                               " of its bufferView");
      fits(buffer_view, offset, count, stride, std::uint64_t(layout.size()), layout.component_size, at);
    } else if (!member(json, "byteOffset").is_null()) {
      remarks_.error(at + "/byteOffset", "has no meaning without a bufferView");
    }
    if (const Json& sparse = member(json, "sparse"); !sparse.is_null()) {
      const std::uint64_t replaced = whole(sparse, "count", 0);
      if (replaced > count)
        remarks_.error(at + "/sparse/count", "is larger than the accessor's " + std::to_string(count));
      const Json &indices = sparse["indices"], &values = sparse["values"];
      const int size = component_size(int(whole(indices, "componentType", 5125)));
      sparse_fits(indices, replaced, size, size, size, at + "/sparse/indices");
      sparse_fits(values, replaced, layout.stride(), layout.size(), layout.component_size,
                  at + "/sparse/values");
    }
  }
  void sparse_fits(const Json& part, std::uint64_t count, int stride, int size, int alignment,
                   const std::string& at) {
    const Json& view = root_["bufferViews"][whole(part, "bufferView", 0)];
    if (!member(view, "byteStride").is_null() || !member(view, "target").is_null())
      remarks_.error(at, "its bufferView must have no byteStride and no target");
    fits(view, whole(part, "byteOffset", 0), count, std::uint64_t(stride), std::uint64_t(size), alignment,
         at);
  }
  void fits(const Json& view, std::uint64_t offset, std::uint64_t count, std::uint64_t stride,
            std::uint64_t size, int alignment, const std::string& at) {
    const std::uint64_t length = whole(view, "byteLength", 0);
    // Numbers of 2^53 times a stride do not overflow.
    if (offset > length || count - 1 > length / stride || (count - 1) * stride + size > length - offset)
      remarks_.error(at, std::to_string(count) + " elements from byte " + std::to_string(offset) +
                             " on do not fit into the bufferView's " + std::to_string(length) + " bytes");
    if ((whole(view, "byteOffset", 0) + offset) % std::uint64_t(alignment) != 0)
      remarks_.error(at, "its first byte must be a multiple of " + std::to_string(alignment) +
                             ", the size of its numbers");
  }

  void image(const Json& json, const std::string& at) {
    const bool named = !member(json, "uri").is_null(), inside = !member(json, "bufferView").is_null();
    if (named == inside) return remarks_.error(at, "needs either 'uri' or 'bufferView'");
    if (inside && member(json, "mimeType").is_null())
      remarks_.error(at, "needs 'mimeType' beside 'bufferView'");
    if (inside &&
        !member(root_["bufferViews"][json["bufferView"].get<std::size_t>()], "byteStride").is_null())
      remarks_.error(at, "its bufferView must have no byteStride");
    if (!named) return;
    const std::string& uri = json["uri"].get_ref<const std::string&>();
    std::string complaint;
    if (is_data_uri(uri) && !read_data_uri(uri, complaint)) remarks_.error(at + "/uri", complaint);
    if (!is_data_uri(uri) && !percent_decoded(uri))
      remarks_.error(at + "/uri",
                     in_quotes(uri) + " is malformed: % must be followed by two hexadecimal digits");
  }

  void camera(const Json& json, const std::string& at) {
    const std::string type = text(json, "type");
    const Json &perspective = member(json, "perspective"), &orthographic = member(json, "orthographic");
    if (member(json, type.c_str()).is_null()) return remarks_.error(at, "needs '" + type + "'");
    if (!perspective.is_null() && !orthographic.is_null())
      return remarks_.error(at, "has both 'perspective' and 'orthographic'");
    const Json& settings = json[type];
    for (const char* size : {"xmag", "ymag"})
      if (number(settings, size, 1) == 0)
        remarks_.error(at / std::string_view(type) / std::string_view(size), "must not be 0");
    if (number(settings, "zfar", 1e300) <= number(settings, "znear", 0))
      remarks_.error(at / std::string_view(type) / std::string_view("zfar"), "must be larger than znear");
  }

  void light(const Json& json, const std::string& at) {
    if (text(json, "type") != "spot") return;
    const Json& spot = member(json, "spot");
    if (spot.is_null()) return remarks_.error(at, "needs 'spot'");
    if (number(spot, "outerConeAngle", 0.7853981633974483) <= number(spot, "innerConeAngle", 0))
      remarks_.error(at + "/spot/outerConeAngle", "must be larger than innerConeAngle");
  }

  const Json& root_;
  Remarks& remarks_;
};

/// The first bytes of an image, as far as they are there.
std::string first_bytes(const Json& image, Buffers& buffers, const ImportOptions& options,
                        const std::string& file) {
  constexpr std::size_t enough = 16;
  if (const Json& view = member(image, "bufferView"); !view.is_null()) {
    const auto bytes = buffers.view(view.get<std::size_t>());
    return bytes ? std::string(bytes->substr(0, enough)) : std::string();
  }
  const std::string uri = text(image, "uri");
  std::string complaint;
  if (is_data_uri(uri)) return read_data_uri(uri, complaint)->bytes.substr(0, enough);
  const std::string path = has_scheme(uri) ? "" : find_named_file(file, *percent_decoded(uri), options).path;
  std::string bytes(enough, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), enough);
  bytes.resize(stream ? enough : std::size_t(stream.gcount()));
  return bytes;
}

}  // namespace

bool is_used(const Json& root, std::string_view extension) {
  return lists(member(root, "extensionsUsed"), extension);
}

void check_rules(const Json& root, Remarks& remarks) {
  Rules(root, remarks).check();
  remarks.throw_errors();
  check_scene_rules(root, remarks);
}

void check_images(const Json& root, Buffers& buffers, const ImportOptions& options, Remarks& remarks) {
  const Json& images = member(root, "images");
  const bool webp = is_used(root, "EXT_texture_webp");
  std::vector<std::string> types;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::string at = std::string("/images") / i, uri = text(images[i], "uri");
    const std::string is = image_type(first_bytes(images[i], buffers, options, remarks.file()));
    std::string said = text(images[i], "mimeType"), complaint;
    if (!is.empty() && !said.empty() && is != said)
      remarks.error(at + "/mimeType", "says " + in_quotes(said) + ", but the image is " + is);
    if (is_data_uri(uri)) {
      const std::string type = read_data_uri(uri, complaint)->media_type;
      if (!is.empty() && type.starts_with("image/") && is != type)
        remarks.error(at + "/uri", "says " + in_quotes(type) + ", but the image is " + is);
      if (said.empty()) said = type;
    }
    types.push_back(is.empty() ? said : is);
    if (types.back() == "image/webp" && !webp) remarks.error(at, "WebP needs the extension EXT_texture_webp");
  }
  const Json& textures = member(root, "textures");
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const std::string at = std::string("/textures") / i;
    const auto is_webp = [&](const Json& source) { return types[source.get<std::size_t>()] == "image/webp"; };
    if (const Json& source = member(textures[i], "source"); !source.is_null() && is_webp(source))
      remarks.error(at + "/source", "must be PNG or JPEG, not WebP");
    if (const Json& source = member(extension(textures[i], "EXT_texture_webp"), "source");
        !source.is_null() && !types[source.get<std::size_t>()].empty() && !is_webp(source))
      remarks.error(at + "/extensions/EXT_texture_webp/source",
                    "must be WebP, not " + types[source.get<std::size_t>()]);
  }
}

}  // namespace lambent::gltf
