// The files of a run: what it writes must not replace what it reads, nor what else it writes.
#pragma once

#include <string>
#include <vector>

namespace kit {

class FileNames {
 public:
  /// `what`: the option or argument that names an input, such as "SOURCE". An empty path is none;
  /// it may be a path that is not there. Throws as writes() if a file that is written has it.
  void reads(std::string what, std::string path);
  /// Throws tess::Error (bad_argument) that names both options and paths if the path is one of the
  /// others. `what`: "--json", or "--out r.pvtu:" for a file that follows from it.
  void writes(std::string what, std::string path);
  /// The same for a picture and its data beside it.
  void writes_picture(const std::string& what, const std::string& svg);

  struct Taken {
    std::string what, path;
    bool is_written;
  };
  [[nodiscard]] const std::vector<Taken>& taken() const { return taken_; }

 private:
  std::vector<Taken> taken_;
};

}  // namespace kit
