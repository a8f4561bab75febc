#include "runtime/base/open_file.hpp"

#include "runtime/core/error.hpp"

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

}  // namespace tess::detail
