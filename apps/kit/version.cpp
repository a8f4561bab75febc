#include "apps/kit/version.hpp"

#include "apps/kit/build.hpp"

#include <fmt/format.h>

namespace kit {

const char* version() {
  return version_of_build;
}

const char* build_commit() {
  return commit_of_build;
}

const char* build_preset() {
  return preset_of_build;
}

std::string version_text(const std::string& program) {
  return fmt::format("{} (Tessera) {}, commit {}, preset {}, g++ {}\n", program, version_of_build,
                     commit_of_build, preset_of_build, __VERSION__);
}

}  // namespace kit
