#include "apps/kit/output/file_names.hpp"

#include "apps/kit/output/write_file.hpp"
#include "runtime/core/error.hpp"

namespace kit {

void FileNames::reads(std::string what, std::string path) {
  take({std::move(what), std::move(path), false});
}

void FileNames::writes(std::string what, std::string path) {
  take({std::move(what), std::move(path), true});
}

void FileNames::take(Taken file) {
  for (const Taken& other : taken_) {
    if ((!file.is_written && !other.is_written) || !is_same_file(file.path, other.path)) continue;
    const Taken& written = file.is_written ? file : other;
    const Taken& lost = file.is_written ? other : file;
    tess::fail(tess::ErrorCode::bad_argument, written.what, " ", written.path, " would overwrite ",
               lost.what, " ", lost.path, "; give another file");
  }
  taken_.push_back(std::move(file));
}

void FileNames::writes_picture(const std::string& what, const std::string& svg) {
  if (svg.empty()) return;
  writes(what, svg);
  writes(what + " " + svg + ":", data_path(svg));
}

}  // namespace kit
