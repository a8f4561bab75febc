// m2m_transfer SOURCE TARGET: moves fields between two tetrahedral meshes, and prints the error of
// the result and the time of each phase.
#include "apps/m2m_transfer/driver.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <unistd.h>

namespace {

bool asks_for_stability(int argc, char** argv) {
  char** const options_end = std::find(argv, argv + argc, std::string_view("--"));
  return std::find(argv, options_end, std::string_view("--stability")) != options_end;
}

/// The process becomes m2m_stability, which stands beside this program: its cases are a program of
/// their own, so that a build of this one does not compile them. To be called before anything
/// starts; under mpirun the new program then joins the job. Returns if there is no such program.
void become_stability(char** argv) {
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  // The first argument is the name that errors and the help begin with: the one the user typed.
  execv((here / "m2m_stability").c_str(), argv);
}

}  // namespace

int main(int argc, char** argv) {
  const bool wants_stability = asks_for_stability(argc, argv);
  if (wants_stability) become_stability(argv);
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    if (wants_stability)
      tess::fail(tess::ErrorCode::environment,
                 "--stability: m2m_stability is not beside this program; build it (cmake --build "
                 "--preset release --target m2m_stability)");
    return m2m_transfer::start(setup, argc, argv);
  });
}
