// Files that are read from their begin to their end.
#pragma once

#include <fstream>
#include <string>

namespace tess {

/// A regular file for reading, as bytes. Throws Error(bad_file) for what cannot be opened, and for
/// pipes and devices, which may never end. what: "a field file", for the remedy.
[[nodiscard]] std::ifstream open_file(const std::string& path, const char* what);

}  // namespace tess
