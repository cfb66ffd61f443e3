#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

#include "image/formats.h"

namespace lambent {
namespace {

/// The file that OpenEXR writes, in memory.
class Output : public Imf::OStream {
 public:
  explicit Output(const std::string& name) : Imf::OStream(name.c_str()) {}
  void write(const char* data, int size) override {
    const std::size_t end = position_ + std::size_t(size);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + position_, data, std::size_t(size));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = std::size_t(position); }

  std::string bytes;

 private:
  std::size_t position_ = 0;
};

/// Names of channels and attributes are 1 to 255 bytes, and end with a zero byte.
bool is_exr_name(const std::string& name) {
  return !name.empty() && name.size() <= 255 && name.find('\0') == std::string::npos;
}

/// What the format keeps for itself: a text under one of these names would make the file unreadable.
bool is_reserved(const std::string& name) {
  static const char* const reserved[] = {"channels",
                                         "chunkCount",
                                         "compression",
                                         "dataWindow",
                                         "deepImageState",
                                         "displayWindow",
                                         "lineOrder",
                                         "maxSamplesPerPixel",
                                         "pixelAspectRatio",
                                         "preview",
                                         "screenWindowCenter",
                                         "screenWindowWidth",
                                         "tiles",
                                         "type",
                                         "version"};
  return std::find(std::begin(reserved), std::end(reserved), name) != std::end(reserved);
}

/// How many of `threads` a file keeps busy, 0: the caller alone. OpenEXR's workers are the whole process's:
/// there may be more of them for somebody else, and they are never made fewer.
int workers(const Image& image, int threads) {
  constexpr std::size_t worth_sharing = std::size_t(1) << 16;  // values: a millisecond and more
  const int count = threads > 0 ? threads : int(std::thread::hardware_concurrency());
  if (count <= 1 || image.data.size() < worth_sharing) return 0;
  static std::mutex changing;
  const std::lock_guard lock(changing);
  if (Imf::globalThreadCount() < count) Imf::setGlobalThreadCount(count);
  return count;
}

}  // namespace

std::string encode_exr(const Image& image, const Metadata& metadata, const std::string& path, int threads) {
  for (const std::string& name : image.channels)
    if (!is_exr_name(name))
      throw picture_error(path, "a channel's name has 1 to 255 bytes in EXR, not '" + name + "'");
  for (const auto& [key, value] : metadata) {
    if (!is_exr_name(key))
      throw picture_error(path, "a metadata key has 1 to 255 bytes in EXR, not '" + key + "'");
    if (is_reserved(key)) throw picture_error(path, "the metadata key '" + key + "' is reserved by EXR");
  }
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    // Measured on pictures with 44 and 102 channels: two thirds of the time of level 4, OpenEXR's own, and 2
    // to 3 % larger.
    header.zipCompressionLevel() = 3;
    for (const auto& [key, value] : metadata) header.insert(key, Imf::StringAttribute(value));

    Imf::FrameBuffer pixels;
    const std::size_t pixel_bytes = image.channels.size() * sizeof(float);
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
      header.channels().insert(image.channels[c], Imf::Channel(Imf::FLOAT));
      // The frame buffer serves reading, too, and so is not const; writing only looks.
      char* first = reinterpret_cast<char*>(const_cast<float*>(image.data.data() + c));
      pixels.insert(image.channels[c],
                    Imf::Slice(Imf::FLOAT, first, pixel_bytes, pixel_bytes * std::size_t(image.width)));
    }
    Output output(path);
    {
      Imf::OutputFile file(output, header, workers(image, threads));
      file.setFrameBuffer(pixels);
      file.writePixels(image.height);
    }  // the end of the file is written here
    return std::move(output.bytes);
  } catch (const std::exception& error) {
    throw Failure("cannot write " + path + ": " + error.what());
  }
}

}  // namespace lambent
