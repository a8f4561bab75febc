#include "m2m/io/file_bytes.hpp"

#include "runtime/base/words.hpp"
#include "runtime/core/error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace tess::m2m {

FileBytes::FileBytes(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    fail(ErrorCode::bad_file, path, ": cannot be opened (", std::generic_category().message(errno),
         "); check the path");
  }
  struct ::stat status {};
  const bool known = ::fstat(descriptor, &status) == 0;
  if (!known || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    fail(ErrorCode::bad_file, path, ": is not a regular file; give the path of a mesh");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) {
    ::close(descriptor);
    fail(ErrorCode::bad_file, path, ": is empty; write the file again");
  }
  void* const bytes = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
  const int error = errno;
  ::close(descriptor);
  if (bytes == MAP_FAILED) {
    fail(ErrorCode::environment, path, ": mmap of ", size_, " bytes failed (",
         std::generic_category().message(error), ")");
  }
  begin_ = static_cast<const char*>(bytes);
  view_ = tess::detail::without_byte_order_mark({begin_, size_});
}

FileBytes::~FileBytes() {
  ::munmap(const_cast<char*>(begin_), size_);
}

void FileBytes::release(std::size_t begin, std::size_t n) const noexcept {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  begin += static_cast<std::size_t>(view_.data() - begin_);
  const std::size_t first = begin / page * page;
  ::madvise(const_cast<char*>(begin_) + first, begin + n - first, MADV_DONTNEED);
}

}  // namespace tess::m2m
