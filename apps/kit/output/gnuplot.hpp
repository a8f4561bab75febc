// Runs gnuplot as a child process: a script in, a picture out, both through unnamed temporary
// files, so that nothing depends on the names of files and no pipe can fill up. The user's start-up
// file is not read.
#pragma once

#include <string>

namespace kit {

struct Drawing {
  std::string svg{};
  std::string error{};   ///< gnuplot's message in one line; empty: none
  bool missing = false;  ///< there is no gnuplot on the PATH
};

/// Returns the drawing that `script` makes on gnuplot's standard output. Throws tess::Error where
/// no temporary file or process can be made.
[[nodiscard]] Drawing draw_with_gnuplot(const std::string& script);

}  // namespace kit
