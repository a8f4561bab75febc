// Real meshes and surfaces that are not part of the project. Tests that want one skip with a
// printed reason where the folder is missing: `const auto path = shared_data("nalu/x.exo"); if
// (!path) return;`
#pragma once

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>

namespace tess::test {

/// The path of a file under the data folder, or nothing, with the reason printed. TESS_DATA
/// overrides the folder.
inline std::optional<std::string> shared_data(std::string_view name) {
  const char* chosen = std::getenv("TESS_DATA");
  const auto path = std::filesystem::path(chosen != nullptr ? chosen : TESS_SHARED_DATA) / name;
  if (std::filesystem::exists(path)) return path.string();
  std::cout << "skipped: " << path.string()
            << " is not on this machine (set TESS_DATA to its folder)\n";
  return std::nullopt;
}

}  // namespace tess::test
