#pragma once
// Whole files, read and written at once.

#include <string>

namespace lambent {

/// All bytes of a file. Throws InputError ("cannot open a.png: No such file or directory").
std::string read_bytes(const std::string& path);

/// Write `bytes` to `path` so that the name stands for the old file or for the whole new one, never for a
/// part: they go to a temporary name in the same folder, which is renamed. Links are followed; what is no
/// regular file (a pipe, a device) is written to directly. Throws Failure; then nothing is left behind, and
/// what stood there stays.
void write_bytes(const std::string& path, const std::string& bytes);

}  // namespace lambent
