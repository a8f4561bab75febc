// Runs the protocol scenarios over many seeds:
//
//     protocol_fuzz --scenario asks --seeds 0:9999        all seeds from 0 to 9999, PEs by the seed
//     protocol_fuzz --scenario asks --seeds 17 --pes 4
//     protocol_fuzz --threads --seeds 0:8                 on threads, in real time
//     mpirun -n 3 protocol_fuzz --seeds 0:99              on the processes of the job, in real time:
//                                                         the scenarios that can, 1 to 3 PEs each
//
// On the simulated machine a seed that fails is shrunk. A failure prints the command that repeats
// it, and the next scenario goes on; the last line is "N passed, N failed", of the scenarios.
#include "apps/kit/seeds.hpp"
#include "runtime/command_line.hpp"
#include "runtime/wire/machine/mpi.hpp"
#include "tests/fuzz/last_words.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fmt/core.h>

namespace {

using tess::fuzz::Case;
using tess::fuzz::On;
using tess::fuzz::Pes;
using tess::fuzz::Scenario;

struct Runs {
  std::string name = "all";
  std::string given_seeds{};
  int n_pes = 0;  // of each process; 0: by the seed
  bool threads = false;
  kit::Seeds seeds{};
  std::unique_ptr<tess::Machine> job{};  // keeps MPI from one run to the next

  [[nodiscard]] On on() const { return job ? On::job : threads ? On::threads : On::simulated; }
  [[nodiscard]] bool repeats() const { return std::getenv("TESS_TEST_REPEAT") != nullptr; }
};

int pes_of(const Scenario& scenario, On on, std::uint64_t seed) {
  if (on == On::job) return 1 + static_cast<int>(seed % 3);
  if (on == On::threads) return std::array{1, 2, 4}[seed % 3];
  if (scenario.pes == Pes::two_to_eight) return 2 + static_cast<int>(seed % 7);
  if (scenario.pes == Pes::one_to_forty) return 1 + static_cast<int>(seed % 40);
  return std::array{1, 2, 3, 4, 7, 8}[tess::mix(seed ^ 0x70657300U) % 6];
}

/// How many seeds a run without --seeds has.
std::uint64_t n_usual_seeds(const Scenario& scenario) {
#ifdef TESS_CHECKS_ALL
  constexpr std::uint64_t n_all = 30;
#else
  constexpr std::uint64_t n_all = 1000;
#endif
  const char* const given = std::getenv("TESS_SEEDS");
  return std::min<std::uint64_t>(given != nullptr ? std::strtoull(given, nullptr, 10) : n_all,
                                 scenario.is_slow ? 300 : n_all);
}

/// Returns what failed; empty if nothing did.
std::string run_one(const Runs& runs, const Scenario& scenario, std::uint64_t seed) {
  const int n_pes = runs.n_pes != 0 ? runs.n_pes : pes_of(scenario, runs.on(), seed);
  const int n_processes = runs.job ? runs.job->n_processes() : 1;
  const std::string command =
      fmt::format("{}protocol_fuzz{} --scenario {} --seeds {} --pes {}",
                  runs.job ? fmt::format("mpirun -n {} ", n_processes) : "",
                  runs.threads ? " --threads" : "", scenario.name, seed, n_pes);
  tess::fuzz::last_words = "protocol_fuzz: repeat with: " + command + "\n";
  (void)tess::fuzz::take_failures();  // of a run that a check ended, in a child process
  Case test = tess::fuzz::case_of(seed, n_pes * n_processes, runs.on(), n_processes);
  scenario.run(test);
  const std::string failures = tess::fuzz::take_failures();
  return failures.empty() || runs.on() == On::simulated
             ? failures
             : fmt::format("{}\n  repeat with: {}\n", failures, command);
}

/// Throws test::Failure.
void run_all(const Runs& runs, const Scenario& scenario) {
  kit::Seeds seeds = runs.seeds;
  if (runs.given_seeds.empty()) seeds = {0, n_usual_seeds(scenario) - 1};
  if (runs.repeats() && runs.given_seeds.empty()) seeds.last = ~std::uint64_t{0} - 1;
  const std::uint64_t n_checked = tess::fuzz::n_checks;
  const auto program = [&](std::uint64_t seed) { return run_one(runs, scenario, seed); };
  if (runs.on() != On::simulated) {  // to the last seed: other processes may see no failure
    std::string failures;
    for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) failures += program(seed);
    if (!failures.empty()) throw tess::test::Failure(failures);
    return;
  }
  const std::string one = runs.name == "all" ? fmt::format("--scenario={}", scenario.name) : "";
  tess::test::for_seeds(seeds.first, seeds.last + 1, program, {.name = one});
  // A given number of PEs may leave little to check.
  if (runs.repeats() || runs.n_pes != 0) return;
  const std::uint64_t n_seeds = seeds.last - seeds.first + 1, n = tess::fuzz::n_checks - n_checked,
                      least = n_seeds * (n_seeds < 30 ? 1 : scenario.usual_checks);
  tess::test::expect(n >= least, n, " statements are checked with ", n_seeds, " seeds; ", least,
                     " or more are usual: does it still run its program?");
}

int fuzz(int argc, char** argv) {
  Runs runs;
  tess::CommandLine line("Protocol scenarios on the simulated machine in adversarial order");
  line.option("--scenario NAME", runs.name, "a scenario, or all");
  line.option("--seeds FROM:TO", runs.given_seeds,
              "of the runs, both included (default: as many as TESS_SEEDS says, or 1000)");
  line.option("--pes", runs.n_pes, "PEs (default: by the seed), in a job of each process")
      .between(1, 4096);
  line.flag("--threads", runs.threads, "on threads instead, 1, 2 or 4");
  std::string names = "Scenarios:\n";
  for (const Scenario& one : tess::fuzz::scenarios())
    names += fmt::format("  {:<25} {}\n", one.name, one.claim);
  line.footer(names);
  if (!line.parse(argc, argv, "")) return 0;
  if (!runs.given_seeds.empty()) runs.seeds = kit::parse_seeds(runs.given_seeds);
  if (tess::under_mpirun()) runs.job = tess::fuzz::make_job_machine(1);
  if (runs.name != "all" && tess::fuzz::scenario(runs.name).on < runs.on())
    tess::fail(tess::ErrorCode::bad_argument, "--scenario: ", runs.name, " does not run ",
               runs.job ? "in a job" : "on threads",
               "; without that it runs on a simulated machine");
  if (runs.name == "all" && runs.n_pes != 0 && runs.on() == On::simulated)
    tess::fail(tess::ErrorCode::bad_argument, "--pes: say for which --scenario");

  tess::fuzz::print_last_words_on({SIGSEGV, SIGABRT, SIGBUS, SIGFPE});
  int n_passed = 0, n_failed = 0;
  for (const Scenario& one : tess::fuzz::scenarios()) {
    if (runs.name != "all" ? runs.name != one.name : one.on < runs.on()) continue;
    try {
      run_all(runs, one);
      ++n_passed;
    } catch (const tess::test::Failure& failure) {
      fmt::print("FAILED {}: {}\n", one.name, failure.what());
      std::fflush(stdout);
      ++n_failed;
    }
  }
  if (!runs.job || runs.job->process().value == 0 || n_failed != 0)
    fmt::print("{} passed, {} failed\n", n_passed, n_failed);
  return n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return fuzz(argc, argv); });
}
