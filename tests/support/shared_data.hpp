// Meshes and surfaces that tests read. A case that reads one has the tag [.][shared_data] or
// [.][meshes], and its program a line tess_cases(PROGRAM shared_data) in tests/CMakeLists.txt: then
// ctest runs these cases in an entry of their own, and reports it as skipped where the files are
// missing.
#pragma once

#include "tests/support/catch.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace tess::test {

/// The path of a real mesh or surface, which is not part of the project. TESS_DATA overrides the
/// folder. The case fails if the file is missing.
inline std::string shared_data(std::string_view name) {
  const char* chosen = std::getenv("TESS_DATA");
  const auto path = std::filesystem::path(chosen != nullptr ? chosen : TESS_SHARED_DATA) / name;
  INFO(path.string() << " is missing; set TESS_DATA to its folder");
  REQUIRE(std::filesystem::exists(path));
  return path.string();
}

/// The path of a mesh that make_meshes.sh generates with gmsh, for example "cube_0.08" or
/// "shaft_coarse". The case fails if the file is missing.
inline std::string made_mesh(std::string_view name) {
  const auto path = std::filesystem::path(TESS_MESHES) / (std::string(name) + ".msh");
  INFO(path.string() << " is missing; run ctest -R make_meshes");
  REQUIRE(std::filesystem::exists(path));
  return path.string();
}

}  // namespace tess::test
