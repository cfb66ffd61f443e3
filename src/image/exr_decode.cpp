#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "image/formats.h"

namespace lambent {
namespace {

/// The file that OpenEXR reads, in memory.
class Input : public Imf::IStream {
 public:
  Input(std::string_view bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char* data, int size) override {
    if (size < 0 || position_ > bytes_.size() || std::size_t(size) > bytes_.size() - position_)
      throw std::runtime_error("the file ends too early");
    std::memcpy(data, bytes_.data() + position_, std::size_t(size));
    position_ += std::size_t(size);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = std::size_t(position); }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

int first_flat_part(const Imf::MultiPartInputFile& file, const std::string& path) {
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    if (!header.hasType() || !Imf::isDeepData(header.type())) return part;
  }
  throw picture_error(path, "the EXR holds deep data only, which is not a picture",
                      "flatten it first, for example with OpenEXR's own tools");
}

/// Layer by layer ("diffuse.R" is R of the layer "diffuse"; the picture itself is the layer without a name),
/// the colours in their usual order, other channels after them as EXR sorts them: by name.
std::vector<std::string> ordered_channels(const Imf::ChannelList& list, const std::string& path) {
  std::vector<std::tuple<std::string, std::size_t, std::string>> keys;
  for (auto channel = list.begin(); channel != list.end(); ++channel) {
    const std::string name = channel.name();
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
      throw picture_error(path, "the channel '" + name + "' is stored at a lower resolution than the picture",
                          "luminance and chroma pictures are not read: convert it to R, G and B");
    const std::size_t dot = name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
    const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
    static constexpr std::string_view colors = "RGBA";
    keys.emplace_back(layer, last.size() == 1 ? std::min(colors.find(last), colors.size()) : colors.size(),
                      name);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::string> names;
  for (const auto& key : keys) names.push_back(std::get<2>(key));
  return names;
}

Metadata metadata_of(const Imf::Header& header, bool one_of_many) {
  Metadata metadata;
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    const std::string name = attribute.name();
    if (name == "type" || (one_of_many && name == "name")) continue;  // the format's own
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      metadata.emplace_back(name, text->value());
  }
  return metadata;
}

/// Sizes are judged by the header alone, before OpenEXR sets up what reading needs.
void check_header(const Imf::Header& header, std::size_t channels, std::uint64_t width, std::uint64_t height,
                  std::size_t file_size, const std::string& path) {
  // No compression of EXR's does better: DWA packs 64 flat values into one of 2 bytes, and deflate 1032 bytes
  // into one.
  check_size(width, height, channels, file_size, 32 * 1032, path);
  if (!header.hasTileDescription()) return;
  const Imf::TileDescription& tiles = header.tileDescription();
  constexpr std::uint64_t largest_tile = std::uint64_t(1) << 26;
  if (std::uint64_t(tiles.xSize) * tiles.ySize > largest_tile / channels)
    throw picture_error(path, "the EXR's tiles are too large: " + std::to_string(tiles.xSize) + " x " +
                                  std::to_string(tiles.ySize));
}

/// What `part` holds; never empty, and not beyond what its file can hold.
PictureHead head_of(const Imf::MultiPartInputFile& file, int part, std::size_t file_size,
                    const std::string& path) {
  const Imf::Header& header = file.header(part);
  const Imath::Box2i window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  PictureHead head;
  head.channels = ordered_channels(header.channels(), path);
  if (width <= 0 || height <= 0 || head.channels.empty())
    throw picture_error(path, "the EXR holds no picture");
  check_header(header, head.channels.size(), std::uint64_t(width), std::uint64_t(height), file_size, path);
  head.width = int(width);
  head.height = int(height);
  return head;
}

ReadImage read_part(Imf::MultiPartInputFile& file, std::size_t file_size, const std::string& path) {
  const int part = first_flat_part(file, path);
  const Imf::Header& header = file.header(part);
  const Imath::Box2i window = header.dataWindow();
  const PictureHead head = head_of(file, part, file_size, path);
  ReadImage result;
  Image& image = result.image;
  image.channels = head.channels;
  image.width = head.width;
  image.height = head.height;
  const std::size_t channels = image.channels.size(), width = std::size_t(head.width);
  const std::int64_t height = head.height;

  Imf::InputPart input(file, part);
  // The room is reserved but grows with what has been read: a damaged file fails before it has cost much.
  const std::size_t row_values = width * channels;
  image.data.reserve(row_values * std::size_t(height));
  Imf::FrameBuffer pixels;
  for (std::size_t c = 0; c < channels; ++c)
    pixels.insert(image.channels[c], Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window,
                                                      channels * sizeof(float), row_values * sizeof(float)));
  input.setFrameBuffer(pixels);
  constexpr std::int64_t strip = 256;  // the most lines that EXR compresses together
  for (std::int64_t y = 0; y < height; y += strip) {
    const std::int64_t end = std::min(y + strip, height);
    image.data.resize(row_values * std::size_t(end));
    input.readPixels(int(window.min.y + y), int(window.min.y + end - 1));
  }
  result.metadata = metadata_of(header, file.parts() > 1);
  return result;
}

/// OpenEXR's reason without the file's name, which the diagnostic's place says already.
std::string reason_of(const std::exception& error, const std::string& path) {
  const std::string text = error.what(), name = '"' + path + "\". ";
  const std::size_t at = text.find(name);
  return at == std::string::npos ? text : text.substr(at + name.size());
}

/// What `action` makes of the file; whatever OpenEXR has against it becomes an InputError.
template <class Action>
auto with_file(std::string_view bytes, const std::string& path, const Action& action) {
  try {
    Input input(bytes, path);
    // Threads: none. A broken table of chunks is not rebuilt: that searches the file for parts of a picture.
    Imf::MultiPartInputFile file(input, 0, false);
    return action(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw picture_error(path, "the picture does not fit into memory");
  } catch (const std::exception& error) {
    throw picture_error(path, "cannot read the EXR: " + reason_of(error, path));
  }
}

}  // namespace

bool is_exr(std::string_view bytes) { return bytes.substr(0, 4) == "\x76\x2f\x31\x01"; }

ReadImage decode_exr(std::string_view bytes, const std::string& path) {
  return with_file(bytes, path,
                   [&](Imf::MultiPartInputFile& file) { return read_part(file, bytes.size(), path); });
}

PictureHead exr_head(std::string_view bytes, const std::string& path) {
  return with_file(bytes, path, [&](const Imf::MultiPartInputFile& file) {
    return head_of(file, first_flat_part(file, path), bytes.size(), path);
  });
}

}  // namespace lambent
