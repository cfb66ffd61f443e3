#pragma once
// The font's file, as the build found it, inside the library: no font is needed where the program runs, and
// text has the same bits everywhere.

#include <span>

namespace lambent {

/// DejaVuSans.ttf. LICENSE.DejaVu in the project's root says what may be done with it.
std::span<const unsigned char> font_file();

}  // namespace lambent
