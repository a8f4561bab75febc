// What the program does, from the command line to the report: one transfer, or a study of several.
// PE 0 reads, judges and writes; what is wrong with the input is found before anything is sent.
#pragma once

#include "apps/m2m_transfer/problem.hpp"
#include "runtime/runtime.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tess::m2m {

struct DriverOptions {
  Request request;
  std::vector<std::string> policies{"keep"};
  std::optional<std::int32_t> repeat;  ///< absent: 1, in a study 3
  std::string out, json, picture;
  bool explain = false;
  std::optional<std::string> study;  ///< the folder of the study's report
};

/// Returns the exit code.
int drive(Setup& setup, const DriverOptions& options);

}  // namespace tess::m2m
