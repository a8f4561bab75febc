#include "apps/kit/file_names.hpp"

#include "apps/kit/write_file.hpp"
#include "runtime/core/error.hpp"

namespace kit {

void FileNames::reads(std::string what, std::string path) {
  taken_.emplace_back(std::move(what), std::move(path));
}

void FileNames::writes(std::string what, std::string path) {
  for (const auto& [other, other_path] : taken_)
    if (is_same_file(path, other_path))
      tess::fail(tess::ErrorCode::bad_argument, what, " ", path, " would overwrite ", other, " ",
                 other_path, "; give another file");
  taken_.emplace_back(std::move(what), std::move(path));
}

void FileNames::writes_picture(const std::string& what, const std::string& svg) {
  if (svg.empty()) return;
  writes(what, svg);
  writes(what + " " + svg + ":", data_path(svg));
}

}  // namespace kit
