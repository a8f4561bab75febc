// Files on disk: read, and compressed or not by their names.
#include "runtime/balance/datafile/brotli.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace tess::balance {
namespace {

// A small file may not fill the memory: repeated JSON shrinks to a hundredth, seldom further.
constexpr std::size_t always_unpacked_bytes = std::size_t{64} << 20U;
constexpr std::size_t never_unpacked_bytes = std::size_t{4} << 30U;
constexpr std::size_t largest_ratio = 1000;

bool is_compressed(std::string_view path) {
  return path.ends_with(".br");
}

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    fail(ErrorCode::bad_file, path, ": cannot be read, or is empty; give an LBDatafile");
  return text.str();
}

}  // namespace

std::string lb_datafile_bytes(std::string_view path, const std::string& text) {
  return is_compressed(path) ? pack_brotli(text) : text;
}

std::vector<Phase> read_lb_datafiles(const std::vector<std::string>& paths) {
  std::vector<LbDatafile> files;
  for (const std::string& path : paths) {
    std::string bytes = content(path);
    if (is_compressed(path)) {
      const std::size_t most =
          std::clamp(bytes.size() * largest_ratio, always_unpacked_bytes, never_unpacked_bytes);
      bytes = unpack_brotli(path, bytes, most);
    }
    files.push_back({path, std::move(bytes)});
  }
  return parse_lb_datafiles(files);
}

}  // namespace tess::balance
