#include "apps/plot/write_file.hpp"

#include "runtime/error.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace plot {

void write_file(const std::string& path, std::string_view content) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool whole = file != nullptr;
  if (whole) whole = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int error = errno;
  if (file != nullptr && std::fclose(file) != 0 && whole) {
    whole = false;
    error = errno;
  }
  if (!whole)
    tess::fail(tess::ErrorCode::environment,
               path,
               ": cannot be written (",
               std::generic_category().message(error),
               "); check that its folder exists and has room");
}

std::string data_path(const std::string& svg_path) {
  constexpr std::string_view ending = ".svg";
  if (!svg_path.ends_with(ending))
    tess::fail(tess::ErrorCode::bad_argument, svg_path, ": a picture's name must end in .svg");
  return svg_path.substr(0, svg_path.size() - ending.size()) + ".csv";
}

}  // namespace plot
