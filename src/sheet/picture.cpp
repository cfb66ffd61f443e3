#include "sheet/picture.h"

#include <algorithm>

#include "lambent/diagnostics.h"

namespace lambent {

void refuse(const std::string& message, const std::string& hint) {
  Diagnostic diagnostic;
  diagnostic.message = message;
  diagnostic.hint = hint;
  throw InputError(diagnostic);
}

ColorChannels color_channels_of(const Image& picture) {
  const std::vector<std::string>& names = picture.channels;
  const std::size_t values = std::size_t(picture.width) * std::size_t(picture.height) * names.size();
  if (picture.width < 0 || picture.height < 0 || picture.data.size() != values)
    refuse("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
           " pixels holds " + std::to_string(picture.data.size()) + " values");
  if (names.size() == 1) return {0, 0, 0};
  ColorChannels channels{};
  constexpr const char* wanted[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto found = std::find(names.begin(), names.end(), wanted[c]);
    if (found == names.end()) {
      std::string listed;
      for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
      refuse("a sheet shows the channels R, G and B, or a single one; a picture has " +
             (listed.empty() ? "none" : listed));
    }
    channels[c] = std::size_t(found - names.begin());
  }
  return channels;
}

}  // namespace lambent
