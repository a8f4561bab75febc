// One transfer from file to file: reads both meshes, samples the manufactured fields, runs the
// transfer, compares with the truth, and writes what was asked for. Everything that can be wrong
// with the input is found before a run starts.
#pragma once

#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

struct DriverOptions {
  std::string source, target;
  std::vector<std::string> fields{"gaussian"};
  std::int32_t n_chares = 0;
  std::int32_t per_pe = 8;
  std::string policy = "keep";
  std::string partition = "rcb";
  double voxel = 0;
  std::int32_t repeat = 1;
  std::string out, json;
  bool explain = false;
};

/// Returns the exit code. Throws Error for bad input.
int drive(Setup& setup, const DriverOptions& options);

}  // namespace tess::m2m
