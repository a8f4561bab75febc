#include "runtime/base/open_file.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>

namespace tess::detail {

std::ifstream open_file(const std::string& path, const char* what) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))
    fail(ErrorCode::bad_file, path, ": is no file; give the path of ", what);
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(ErrorCode::bad_file, path, ": cannot be opened; give the path of ", what);
  return file;
}

std::string read_file(const std::string& path, const char* what) {
  std::ifstream file = open_file(path, what);
  file.seekg(0, std::ios::end);
  std::string bytes(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)), '\0');
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file)
    fail(ErrorCode::bad_file, path, ": cannot be read to its end; give the path of ", what);
  return bytes;
}

}  // namespace tess::detail
