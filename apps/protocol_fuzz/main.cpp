// The protocol scenarios over many seeds, by hand or for a night:
//
//     protocol_fuzz --scenario tour --seeds 0:9999        all seeds from 0 to 9999, P by the seed
//     protocol_fuzz --scenario tour --seeds 17:17 --pes 4
//
// A failure prints the command that repeats it; the last line is "N passed, N failed".
#include "apps/command_line.hpp"
#include "apps/protocol_fuzz/scenarios.hpp"

#include <charconv>
#include <csignal>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>

namespace {

using tess::fuzz::Scenario;
using tess::fuzz::Trial;

// The trial that runs and the command that repeats it, for an end without return.
std::string repeat;
const Trial* running = nullptr;

void print_failures(const Trial& trial) {
  for (const std::string& failure : trial.failures()) std::printf("  %s\n", failure.c_str());
  std::fflush(stdout);
}
void end_on_check() {
  std::printf("FAILED %s\n", repeat.c_str());
  if (running != nullptr) print_failures(*running);
}
void print_repeat() {
  const std::string line = "protocol_fuzz: repeat with: " + repeat + "\n";
  [[maybe_unused]] const auto n = ::write(STDERR_FILENO, line.data(), line.size());
}
void on_crash(int signal) {
  print_repeat();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

struct Seeds {
  std::uint64_t first = 0, last = 0;
};

Seeds parse_seeds(const std::string& given) {
  const std::size_t colon = given.find(':');
  const auto number = [&](std::size_t from, std::size_t to) {
    std::uint64_t value = 0;
    const char* end = given.data() + to;
    const auto [at, error] = std::from_chars(given.data() + from, end, value);
    if (error != std::errc() || at != end)
      tess::fail(tess::ErrorCode::bad_argument, "--seeds: ", given, " is not of the form FROM:TO");
    return value;
  };
  if (colon == std::string::npos) return {number(0, given.size()), number(0, given.size())};
  const Seeds seeds{number(0, colon), number(colon + 1, given.size())};
  if (seeds.last < seeds.first)
    tess::fail(tess::ErrorCode::bad_argument, "--seeds: ", given, " ends before it begins");
  return seeds;
}

bool passes(const Scenario& scenario, std::uint64_t seed, std::int32_t n_pes) {
  repeat = fmt::format(
      "protocol_fuzz --scenario {} --seeds {}:{} --pes {}", scenario.name, seed, seed, n_pes);
  Trial trial(seed, n_pes, Trial::On::simulated);
  running = &trial;
  scenario.run(trial);
  running = nullptr;
  if (trial.failures().empty()) return true;
  std::printf("FAILED %s\n", repeat.c_str());
  print_failures(trial);
  return false;
}

int fuzz(int argc, char** argv) {
  std::string name = "all", given_seeds = "0:99";
  std::int32_t n_pes = 0;
  apps::CommandLine line("Protocol scenarios on the simulated machine in adversarial order");
  line.option("--scenario", name, "a scenario, or all");
  line.option("--seeds", given_seeds, "FROM:TO, both included");
  line.option("--pes", n_pes, "PEs (default: 1, 2, 3, 4, 7 or 8 by the seed)").between(1, 4096);
  std::string scenarios = "Scenarios:\n";
  for (const Scenario& one : tess::fuzz::scenarios())
    scenarios += fmt::format("  {:<18} {}\n", one.name, one.claim);
  if (!line.parse(argc, argv, scenarios)) return 0;
  const Seeds seeds = parse_seeds(given_seeds);
  if (name != "all") (void)tess::fuzz::scenario(name);

  tess::set_check_abort(&end_on_check);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE}) std::signal(signal, &on_crash);
  std::uint64_t n_passed = 0, n_failed = 0;
  for (const Scenario& one : tess::fuzz::scenarios()) {
    if (name != "all" && name != one.name) continue;
    for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed)
      ++(passes(one, seed, n_pes != 0 ? n_pes : tess::fuzz::pes_of_seed(seed)) ? n_passed
                                                                               : n_failed);
  }
  std::printf("%llu passed, %llu failed\n",
              static_cast<unsigned long long>(n_passed),
              static_cast<unsigned long long>(n_failed));
  return n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return fuzz(argc, argv); });
}
