// How a program ends that finds its own result wrong.
#pragma once

#include "runtime/run.hpp"

#include <cstdio>
#include <string>

namespace kit {

/// One line on standard error, after the results, and exit code 1.
inline void end_with(const std::string& error) {
  std::fprintf(stderr, "%s\n", error.c_str());
  tess::exit(1);
}

}  // namespace kit
