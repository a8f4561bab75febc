// Runs the protocol scenarios over many seeds:
//
//     protocol_fuzz --scenario tour --seeds 0:9999        all seeds from 0 to 9999, PEs by the seed
//     protocol_fuzz --scenario tour --seeds 17:17 --pes 4
//     mpirun -n 3 protocol_fuzz --seeds 0:99              on the processes of the job, in real time:
//                                                         the scenarios that can, 1 to 3 PEs each
//
// A failure prints the command that repeats it; the last line is "N passed, N failed".
#include "apps/kit/seeds.hpp"
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/command_line.hpp"
#include "runtime/machine/mpi.hpp"

#include <csignal>
#include <cstdio>
#include <fmt/core.h>
#include <unistd.h>

namespace {

using tess::fuzz::Scenario;
using tess::fuzz::Trial;

// The running trial and the command that repeats it, for a run that ends the process.
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

/// The job that mpirun started; none otherwise.
struct Job {
  std::unique_ptr<tess::Machine> first;  // keeps MPI from one trial to the next
  [[nodiscard]] std::int32_t n_processes() const { return first ? first->n_processes() : 1; }
  [[nodiscard]] bool speaks() const { return !first || first->process().value == 0; }
};

bool passes(const Job& job, const Scenario& scenario, std::uint64_t seed, std::int32_t n_pes,
            std::uint64_t& n_checks) {
  repeat = fmt::format("protocol_fuzz --scenario {} --seeds {}:{} --pes {}", scenario.name, seed,
                       seed, n_pes);
  if (job.first) {
    n_pes *= job.n_processes();
    repeat = fmt::format("mpirun -n {} {}", job.n_processes(), repeat);
  }
  Trial trial(seed, n_pes, job.first ? Trial::On::job : Trial::On::simulated, job.n_processes());
  running = &trial;
  scenario.run(trial);
  running = nullptr;
  n_checks += trial.n_checks();
  if (trial.failures().empty()) return true;
  std::printf("FAILED %s\n", repeat.c_str());
  print_failures(trial);
  return false;
}

int fuzz(int argc, char** argv) {
  std::string name = "all", given_seeds = "0:99";
  std::int32_t n_pes = 0;
  tess::CommandLine line("Protocol scenarios on the simulated machine in adversarial order");
  line.option("--scenario NAME", name, "a scenario, or all");
  line.option("--seeds FROM:TO", given_seeds, "of the runs, both included");
  line.option("--pes", n_pes,
              "PEs (default: 1, 2, 3, 4, 7 or 8 by the seed; of each process: 1, 2 or 3)")
      .between(1, 4096);
  std::string scenarios = "Scenarios:\n";
  for (const Scenario& one : tess::fuzz::scenarios())
    scenarios += fmt::format("  {:<18} {}\n", one.name, one.claim);
  if (!line.parse(argc, argv, scenarios)) return 0;
  const kit::Seeds seeds = kit::parse_seeds(given_seeds);
  if (name != "all" && !tess::fuzz::scenario(name).in_jobs && tess::under_mpirun())
    tess::fail(tess::ErrorCode::bad_argument, "--scenario: ", name,
               " needs the memory of one process; without mpirun it runs on a simulated machine");
  Job job;
  if (tess::under_mpirun()) job.first = tess::fuzz::make_job_machine(1);

  tess::set_check_abort(&end_on_check);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE}) std::signal(signal, &on_crash);
  std::uint64_t n_passed = 0, n_failed = 0;
  for (const Scenario& one : tess::fuzz::scenarios()) {
    if (name != "all" ? name != one.name : job.first && !one.in_jobs) continue;
    std::uint64_t n_checks = 0;
    for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
      const std::int32_t drawn =
          job.first ? 1 + static_cast<std::int32_t>(seed % 3) : tess::fuzz::pes_of_seed(seed);
      ++(passes(job, one, seed, n_pes != 0 ? n_pes : drawn, n_checks) ? n_passed : n_failed);
    }
    // A process of a job checks a part, and a given number of PEs may leave little to check.
    if (job.first || n_pes != 0) continue;
    const std::string too_few =
        tess::fuzz::too_few_checks(one, seeds.last - seeds.first + 1, n_checks);
    if (too_few.empty()) continue;
    std::printf("FAILED %s\n", too_few.c_str());
    ++n_failed;
  }
  if (job.speaks() || n_failed != 0)
    std::printf("%llu passed, %llu failed\n", static_cast<unsigned long long>(n_passed),
                static_cast<unsigned long long>(n_failed));
  return n_failed == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return fuzz(argc, argv); });
}
