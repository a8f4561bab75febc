// The bytes of a file, mapped for reading while this object lives, without a byte order mark. Only the
// readers use it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tess::m2m {

class FileBytes {
 public:
  /// Maps the file. Throws Error (bad_file) if it is missing, unreadable, not a regular file, or
  /// empty.
  explicit FileBytes(const std::string& path);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::string_view view() const noexcept { return view_; }
  /// The bytes are not needed in memory for now.
  void release(std::size_t begin, std::size_t n) const noexcept;

 private:
  const char* begin_ = nullptr;
  std::size_t size_ = 0;
  std::string_view view_;
};

}  // namespace tess::m2m
