// Writing reports to files: whole, or an error that names the path and the reason.
#pragma once

#include <string>
#include <string_view>

namespace plot {

/// Throws tess::Error (environment) that names the path and why it cannot be written.
void write_file(const std::string& path, std::string_view content);

/// Where the data of a picture goes: NAME.csv for NAME.svg. Throws tess::Error (bad_argument) for a
/// path that does not end in .svg.
[[nodiscard]] std::string data_path(const std::string& svg_path);

}  // namespace plot
