// Random collision scenes against brute force:
//
//     collide_fuzz --seeds 0:9999            all seeds from 0 to 9999, both included: serially, and
//                                            on the chares of 1, 2, 4 and sometimes 20
//                                            simulated PEs
//     collide_fuzz --seeds 17 --only serial  one failure again
//
// A failure prints the seed and the scene; the last line is "N passed, N failed".
#include "apps/collide_fuzz/trial.hpp"
#include "apps/kit/seeds.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"

#include <csignal>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>
#include <vector>

namespace {

using collide_fuzz::Look;
using collide_fuzz::Outcome;

// What is written if a signal ends the process: the command that repeats the running trial.
std::string last_words;

void on_signal(int signal) {
  [[maybe_unused]] const auto n = ::write(STDERR_FILENO, last_words.data(), last_words.size());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

struct Tally {
  std::uint64_t n_passed = 0, n_failed = 0;
  std::uint64_t n_compared = 0, n_pairs = 0, n_refused = 0;

  template <class Trial>
  void add(const Look& look, const char* kind, const Trial& trial) {
    const std::string repeat = fmt::format("collide_fuzz --seeds {} --only {}", look.seed, kind);
    last_words = fmt::format("collide_fuzz: repeat with: {}\n", repeat);
    Outcome outcome;
    try {
      outcome = trial();
    } catch (const tess::Error& error) {
      outcome.failure = error.what();
    }
    n_compared += outcome.n_compared;
    n_pairs += outcome.n_pairs;
    n_refused += outcome.n_refused;
    ++(outcome.failure.empty() ? n_passed : n_failed);
    if (outcome.failure.empty()) return;
    std::printf("FAILED %s\n  %s\n  %s\n", repeat.c_str(), describe(look).c_str(),
                outcome.failure.c_str());
    std::fflush(stdout);
  }
};

int fuzz(int argc, char** argv) {
  std::string given_seeds = "0:99", only;
  tess::CommandLine line("Random collision scenes against brute force");
  line.option("--seeds FROM:TO", given_seeds, "of the runs, both included");
  line.option("--only", only, "serial, or chares (default: both)").one_of({"serial", "chares"});
  if (!line.parse(argc, argv, "")) return 0;
  const kit::Seeds seeds = kit::parse_seeds(given_seeds);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGHUP})
    std::signal(signal, &on_signal);
  Tally tally;
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const Look look = collide_fuzz::look_of(seed);
    if (only != "chares") tally.add(look, "serial", [&] { return collide_fuzz::try_serial(look); });
    if (only == "serial") continue;
    std::vector<std::int32_t> machines{1, 2, 4};
    if (seed % 20 == 0) machines.push_back(20);  // so many that PEs do not speak to all others
    for (const std::int32_t n_pes : machines)
      tally.add(look, "chares", [&] { return collide_fuzz::try_chares(look, n_pes); });
  }
  fmt::print("{} answers with {} pairs compared; {} voxel sizes refused as too small\n",
             tally.n_compared, tally.n_pairs, tally.n_refused);
  fmt::print("{} passed, {} failed\n", tally.n_passed, tally.n_failed);
  return tally.n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return fuzz(argc, argv); });
}
