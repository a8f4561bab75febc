#include "m2m/io/new_file.hpp"

#include "runtime/core/error.hpp"

#include <cerrno>
#include <system_error>
#include <unistd.h>

namespace tess::m2m {

NewFile::NewFile(const std::string& path)
    : path_(path), part_(path + ".part" + std::to_string(::getpid())) {
  file_ = std::fopen(part_.c_str(), "wb");
  if (file_ == nullptr)
    fail(ErrorCode::bad_file, path_, ": cannot be written (",
         std::generic_category().message(errno), "); check that its folder exists and is writable");
}

NewFile::~NewFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!part_.empty()) ::unlink(part_.c_str());
}

void NewFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
    fail(ErrorCode::environment, path_, ": writing failed (",
         std::generic_category().message(errno), "); check that the disk has space");
}

void NewFile::finish() {
  std::FILE* const file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0)
    fail(ErrorCode::environment, path_, ": writing failed (",
         std::generic_category().message(errno), "); check that the disk has space");
  if (std::rename(part_.c_str(), path_.c_str()) != 0)
    fail(ErrorCode::bad_file, path_, ": cannot be replaced (",
         std::generic_category().message(errno), ")");
  part_.clear();
}

}  // namespace tess::m2m
