// The files of a run: what it writes must not replace what it reads, nor what else it writes.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kit {

class FileNames {
 public:
  // Both throw tess::Error (bad_argument) that names both options and paths where a file would be
  // written that is one of the others. An empty path is none.

  /// `what`: the option or argument that names an input, such as "SOURCE". The path may be one that
  /// is not there.
  void reads(std::string what, std::string path);
  /// `what`: "--json", or "--out r.pvtu:" for a file that follows from it.
  void writes(std::string what, std::string path);
  /// Does the same for a picture and the data beside it.
  void writes_picture(const std::string& what, const std::string& svg);

  struct Taken {
    std::string what, path;
    bool is_written;
  };
  [[nodiscard]] const std::vector<Taken>& taken() const { return taken_; }

 private:
  void take(Taken file);

  std::vector<Taken> taken_;
};

}  // namespace kit
