#include "apps/kit/file_names.hpp"

#include "apps/kit/write_file.hpp"
#include "runtime/core/error.hpp"

#include <utility>

namespace kit {
namespace {

[[noreturn]] void refuse(const FileNames::Taken& written, const FileNames::Taken& other) {
  tess::fail(tess::ErrorCode::bad_argument, written.what, " ", written.path, " would overwrite ",
             other.what, " ", other.path, "; give another file");
}

}  // namespace

void FileNames::reads(std::string what, std::string path) {
  const Taken now{std::move(what), std::move(path), false};
  for (const Taken& other : taken_)
    if (other.is_written && is_same_file(now.path, other.path)) refuse(other, now);
  taken_.push_back(now);
}

void FileNames::writes(std::string what, std::string path) {
  const Taken now{std::move(what), std::move(path), true};
  for (const Taken& other : taken_)
    if (is_same_file(now.path, other.path)) refuse(now, other);
  taken_.push_back(now);
}

void FileNames::writes_picture(const std::string& what, const std::string& svg) {
  if (svg.empty()) return;
  writes(what, svg);
  writes(what + " " + svg + ":", data_path(svg));
}

}  // namespace kit
