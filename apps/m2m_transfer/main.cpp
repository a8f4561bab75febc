// m2m_transfer SOURCE TARGET: moves fields between two tetrahedral meshes, and prints the error of
// the result and the time of each phase.
#include "apps/m2m_transfer/driver.hpp"
#include "apps/m2m_transfer/options.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace m2m_transfer {
namespace {

/// The arguments without --stability.
std::vector<char*> without_stability(int argc, char** argv) {
  std::vector<char*> out(argv, argv + argc);
  const auto options_end = std::ranges::find(out, std::string_view("--"));
  out.erase(std::remove(out.begin(), options_end, std::string_view("--stability")), options_end);
  return out;
}

/// The process becomes m2m_stability, which stands beside this program: its cases are a program of
/// their own, so that a build of this one does not compile them. To be called before anything
/// starts; under mpirun the new program then joins the job. Returns if there is no such program.
void become_stability(std::vector<char*> arguments) {
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  arguments.push_back(nullptr);
  // The first argument is the name that errors and the help begin with: the one the user typed.
  execv((here / "m2m_stability").c_str(), arguments.data());
}

int run(tess::Setup& setup, int argc, char** argv) {
  DriverOptions options;
  tess::CommandLine line(
      "Moves fields between two tetrahedral meshes, and prints the error and the time.");
  if (!read_options(line, options, argc, argv)) return 0;
  if (options.stability)
    tess::fail(tess::ErrorCode::bad_argument, "--stability takes no value; leave it out");
  if (options.request.source.empty())
    tess::fail(tess::ErrorCode::bad_argument,
               "SOURCE is missing; give a source and a target mesh (--help lists the arguments)");
  return drive(setup, options);
}

}  // namespace
}  // namespace m2m_transfer

int main(int argc, char** argv) {
  const std::vector<char*> others = m2m_transfer::without_stability(argc, argv);
  const bool wants_stability = others.size() != static_cast<std::size_t>(argc);
  if (wants_stability) m2m_transfer::become_stability(others);
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    if (wants_stability)
      tess::fail(tess::ErrorCode::environment,
                 "--stability: m2m_stability is not beside this program; build it (cmake --build "
                 "--preset release --target m2m_stability)");
    return m2m_transfer::run(setup, argc, argv);
  });
}
