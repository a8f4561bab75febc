// Opens files that are read from beginning to end.
#pragma once

#include <fstream>
#include <string>

namespace tess::detail {

/// Opens a regular file for reading in binary mode. Throws Error(bad_file) if it cannot be opened,
/// and for pipes and devices, which may never end. `what` names the kind of file in the remedy,
/// such as "a field file".
[[nodiscard]] std::ifstream open_file(const std::string& path, const char* what);

/// All bytes of such a file.
[[nodiscard]] std::string read_file(const std::string& path, const char* what);

}  // namespace tess::detail
