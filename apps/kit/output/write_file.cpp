#include "apps/kit/output/write_file.hpp"

#include "runtime/core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <unistd.h>

namespace kit {
namespace fs = std::filesystem;

namespace {

/// What access() says of a path, `how` as W_OK; empty where it allows that.
std::string denial(const fs::path& path, int how) {
  if (::access(path.c_str(), how) == 0) return {};
  return std::generic_category().message(errno);
}

}  // namespace

std::string hindrance(const fs::path& file) {
  std::error_code error;
  const fs::file_status there = fs::status(file, error);
  if (fs::is_directory(there)) return "is a directory";
  if (fs::exists(there)) return denial(file, W_OK);
  if (there.type() == fs::file_type::none) return error.message();
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::exists(folder, error)) return "its folder " + folder.string() + " does not exist";
  if (!fs::is_directory(folder, error)) return folder.string() + " is not a directory";
  if (!file.has_filename()) return "names no file";
  return denial(folder, W_OK | X_OK);
}

void require_writable(const std::string& option, const std::string& path) {
  if (path.empty()) return;
  if (const std::string why = hindrance(path); !why.empty())
    tess::fail(tess::ErrorCode::environment, option, " ", path, ": cannot be written: ", why,
               "; give the path of a file in a folder that can be written");
}

void require_picture(const std::string& option, const std::string& path) {
  require_writable(option, path);
  if (!path.empty()) require_writable(option + " " + path + ":", data_path(path));
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  if (a.empty() || b.empty()) return false;
  std::error_code error;
  return std::filesystem::equivalent(a, b, error) ||
         std::filesystem::absolute(a).lexically_normal() ==
             std::filesystem::absolute(b).lexically_normal();
}

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
    tess::fail(tess::ErrorCode::environment, path, ": cannot be written (",
               std::generic_category().message(error),
               "); check that its folder exists and has room");
}

void make_folder(const std::string& option, const fs::path& path) {
  if (path.empty()) return;
  std::error_code error;
  fs::create_directories(path, error);
  const std::string why = error ? error.message() : denial(path, W_OK | X_OK);
  if (!why.empty())
    tess::fail(tess::ErrorCode::environment, option, ": ", path.string(),
               " cannot be made a folder to write to: ", why, "; give another");
}

std::string data_path(const std::string& svg_path) {
  constexpr std::string_view ending = ".svg";
  if (!svg_path.ends_with(ending))
    tess::fail(tess::ErrorCode::bad_argument, svg_path, ": a picture's name must end in .svg");
  return svg_path.substr(0, svg_path.size() - ending.size()) + ".csv";
}

}  // namespace kit
