// One trial: one seed, one number of PEs, one machine, and its expectations. A scenario draws its
// size and shape from the trial's random numbers, runs one or several programs, and states what
// must hold; the first few violations are kept as text.
//
// The chares of most scenarios and their oracle share the memory of one process. An oracle is
// guarded by a mutex, so that the same scenario runs on the threads machine. On several processes
// (a job) each process draws the same from the seed and states what it sees; only scenarios that
// carry their oracle in messages run there.
#pragma once

#include "runtime/runtime.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tess::fuzz {

/// How a run ended.
struct Ending {
  int exit_code = 0;
  std::string report;  ///< what the runtime printed to standard error, lines
};

class Trial {
 public:
  enum class On { simulated, threads, job };

  /// `n_pes` is the number of PEs of the whole job, a multiple of n_processes.
  Trial(std::uint64_t seed, std::int32_t n_pes, On machine, std::int32_t n_processes = 1);

  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  [[nodiscard]] std::int32_t n_pes() const { return n_pes_; }
  [[nodiscard]] bool on_threads() const { return machine_ == On::threads; }
  [[nodiscard]] bool in_job() const { return machine_ == On::job; }
  /// Draws of the scenario itself; not for use on a PE.
  [[nodiscard]] Random& random() { return random_; }
  /// A number of least … most.
  [[nodiscard]] int draw(int least, int most) {
    return least + static_cast<int>(random_.below(static_cast<std::uint64_t>(most - least + 1)));
  }

  /// Of the simulated machine: bytes under way from process to process.
  [[nodiscard]] std::uint64_t message_memory() const { return message_memory_; }

  /// Lets no message wait for credit.
  void give_memory() { message_memory_ = std::uint64_t{32} << 20U; }

  /// The runs that follow have so many PEs; in one process.
  void change_pes(std::int32_t n_pes) { n_pes_ = n_pes; }

  /// Turns forced migrations off.
  void forbid_forced_migration() { forced_migration_ = false; }

  /// Runs `main` on PE 0 to the end of the run.
  template <class Main>
  Ending run(Main main) {
    return run_message(detail::as_message(std::move(main)));
  }
  /// The same; the run must end with exit code 0 and without a report.
  template <class Main>
  void run_clean(Main main) {
    const Ending ending = run(std::move(main));
    expect(ending.exit_code == 0, "exit code ", ending.exit_code, "; ", ending.report);
    expect(ending.report.empty(), "report: ", ending.report);
  }

  /// States what must hold; any thread.
  template <class... Parts>
  void expect(bool holds, const Parts&... parts) {
    n_checks_.fetch_add(1, std::memory_order_relaxed);  // read after the run
    if (!holds) [[unlikely]]
      add_failure(text(parts...));
  }
  [[nodiscard]] const std::vector<std::string>& failures() const { return failures_; }
  /// How many statements were checked; a scenario that stops checking is no test.
  [[nodiscard]] std::uint64_t n_checks() const { return n_checks_; }

 private:
  Ending run_message(std::function<void()> main);
  void add_failure(std::string failure);

  const std::uint64_t seed_;
  std::int32_t n_pes_;
  const std::int32_t pes_of_process_;
  const On machine_;
  Random random_;
  std::uint64_t n_runs_ = 0;
  std::uint64_t message_memory_ = 0;
  bool forced_migration_ = true;
  std::atomic<std::uint64_t> n_checks_{0};
  std::mutex mutex_;
  std::vector<std::string> failures_;
};

/// Any PE of the run.
[[nodiscard]] inline PeId any_pe(Random& random) {
  return PeId{static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(tess::n_pes())))};
}
/// A map of indices to PEs that seems random.
struct ByLot {
  std::uint64_t salt = 0;
  PeId operator()(Index1 index, std::int32_t n_pes) const {
    return PeId{static_cast<std::int32_t>(mix(salt ^ static_cast<std::uint64_t>(index.x)) %
                                          static_cast<std::uint64_t>(n_pes))};
  }
};

/// The processes that mpirun started, with so many PEs each; MPI is initialised by the first of
/// these and finalised by its end.
[[nodiscard]] std::unique_ptr<Machine> make_job_machine(std::int32_t pes_per_process);

/// The number of PEs that a seed stands for where none is given: 1, 2, 3, 4, 7 or 8.
[[nodiscard]] std::int32_t pes_of_seed(std::uint64_t seed);

}  // namespace tess::fuzz
