// Random collision scenes against brute force:
//
//     collide_fuzz --seeds 0:9999            all seeds from 0 to 9999, both included: serially, and
//                                            on the chares of 1, 2, 4 and sometimes 20
//                                            simulated PEs
//     collide_fuzz --seeds 17 --only serial  one failure again
//
// A failure prints the scene and the command that repeats it, which for chares has as few messages
// delayed as were found; the last line is "N passed, N failed".
#include "apps/kit/seeds.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"
#include "runtime/more/testing.hpp"
#include "tests/fuzz/collide/comparison.hpp"
#include "tests/fuzz/last_words.hpp"

#include <cstdio>
#include <fmt/core.h>

namespace {

using collide_fuzz::Comparison;
using collide_fuzz::Look;

std::string compare_machines(const Look& look, Comparison& all) {
  all.failure.clear();
  for (const std::int32_t n_pes : {1, 2, 4, 20})  // so many that PEs do not speak to all others
    if (n_pes < 20 || look.seed % 20 == 0) compare_chares(look, n_pes, all);
  return all.failure;
}

/// True if it passes.
bool run(const Look& look, bool serial, Comparison& all) {
  const std::string command =
      fmt::format("collide_fuzz --seeds {} --only {}", look.seed, serial ? "serial" : "chares");
  tess::fuzz::last_words = "collide_fuzz: repeat with: " + command + "\n";
  std::string failure;
  try {
    if (serial) {
      all.failure.clear();
      compare_serial(look, all);
      failure = all.failure;
    } else {
      tess::test::for_seeds(look.seed, look.seed + 1,
                            [&](std::uint64_t) { return compare_machines(look, all); },
                            {.name = fmt::format("--seeds={}", look.seed)});
    }
  } catch (const std::exception& error) {
    failure = error.what();
  }
  if (failure.empty()) return true;
  fmt::print("FAILED {}\n  {}\n  {}\n", command, describe(look), failure);
  std::fflush(stdout);
  return false;
}

int fuzz(int argc, char** argv) {
  std::string given_seeds = "0:99", only;
  tess::CommandLine line("Random collision scenes against brute force");
  line.option("--seeds FROM:TO", given_seeds, "of the runs, both included");
  line.option("--only", only, "serial, or chares (default: both)").one_of({"serial", "chares"});
  if (!line.parse(argc, argv, "")) return 0;
  const kit::Seeds seeds = kit::parse_seeds(given_seeds);
  tess::fuzz::print_last_words_on(
      {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGHUP});
  Comparison all;
  int n_passed = 0, n_failed = 0;
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const Look look = collide_fuzz::look_of(seed);
    if (only != "chares") ++(run(look, true, all) ? n_passed : n_failed);
    if (only != "serial") ++(run(look, false, all) ? n_passed : n_failed);
  }
  fmt::print("{} answers with {} pairs compared; {} voxel sizes refused as too small\n",
             all.n_compared, all.n_pairs, all.n_refused);
  fmt::print("{} passed, {} failed\n", n_passed, n_failed);
  return n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return fuzz(argc, argv); });
}
