#pragma once
// How a sheet takes pictures: as three numbers for each pixel.

#include <array>

#include "lambent/image.h"

namespace lambent {

/// Where in a pixel R, G and B stand; of a picture with a single channel, that one three times.
using ColorChannels = std::array<std::size_t, 3>;

/// Throws InputError where the picture has no such channels, or not as many values as it should.
ColorChannels color_channels_of(const Image& picture);

/// An error that has no place in a file.
[[noreturn]] void refuse(const std::string& message, const std::string& hint = "");

}  // namespace lambent
