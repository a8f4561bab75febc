// The command that repeats what runs, printed if a signal or a check that fails ends the process.
#pragma once

#include "runtime/core/check.hpp"

#include <csignal>
#include <initializer_list>
#include <string>
#include <unistd.h>

namespace tess::fuzz {

inline std::string last_words;  ///< a whole line

inline void print_last_words() {
  [[maybe_unused]] const auto n = ::write(STDERR_FILENO, last_words.data(), last_words.size());
}

inline void print_last_words_on(std::initializer_list<int> signals) {
  set_check_abort(&print_last_words);
  for (const int signal : signals)
    std::signal(signal, [](int which) {
      print_last_words();
      std::signal(which, SIG_DFL);
      std::raise(which);
    });
}

}  // namespace tess::fuzz
