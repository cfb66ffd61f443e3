#include "sheet/font_file.h"

// The assembler copies the file into the object; a C++ array of 760,000 numbers would take the compiler
// seconds.
asm(".pushsection .rodata\n"
    ".balign 16\n"
    ".globl lambent_font_begin\n"
    ".hidden lambent_font_begin\n"
    "lambent_font_begin:\n"
    ".incbin \"" LAMBENT_FONT_FILE
    "\"\n"
    ".globl lambent_font_end\n"
    ".hidden lambent_font_end\n"
    "lambent_font_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" {
[[gnu::visibility("hidden")]] extern const unsigned char lambent_font_begin[];
[[gnu::visibility("hidden")]] extern const unsigned char lambent_font_end[];
}

namespace lambent {

std::span<const unsigned char> font_file() { return {lambent_font_begin, lambent_font_end}; }

}  // namespace lambent
