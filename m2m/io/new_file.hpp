// A file that appears complete or not at all: it is written under another name in the same folder,
// then renamed. The writers of VTU and weights use it.
#pragma once

#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace tess::m2m {

class NewFile {
 public:
  /// `path` must outlive the object. Throws Error (bad_file) with the path if its folder is missing
  /// or not writable.
  explicit NewFile(const std::string& path);
  /// Removes what is there unless finish() was called.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Throws Error (environment) if the disk is full.
  void write(std::string_view bytes);
  template <class T>
  void write_numbers(std::span<const T> numbers) {
    write({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
  }
  void finish();

 private:
  const std::string& path_;
  std::string part_;
  std::FILE* file_ = nullptr;
};

}  // namespace tess::m2m
