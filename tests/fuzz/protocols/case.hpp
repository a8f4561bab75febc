// One scenario with one seed. The seed draws the machine (here, and nowhere else) and the
// scenario's random numbers, of which the scenario draws its size and shape; the scenario runs one
// or several programs, and states what must hold.
//
// The chares of most scenarios and their oracle share the memory of one process. An oracle is
// guarded by a mutex, so that the same scenario runs on the threads machine. On several processes
// (a job) each process draws the same from the seed and states what it sees; only scenarios that
// carry their oracle in messages run there.
#pragma once

#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace tess::fuzz {

using test::Result;

/// What runs a scenario; a scenario for a later one runs on the earlier ones, too.
enum class On : std::uint8_t { simulated, threads, job };

struct Case {
  std::uint64_t seed = 0;
  On on = On::simulated;
  Random random;            ///< of the scenario; not for use on a PE
  test::Machine machine{};  ///< on threads and in a job only its PEs and processes count

  /// A number of least … most.
  [[nodiscard]] int draw(int least, int most) {
    return least + static_cast<int>(random.below(static_cast<std::uint64_t>(most - least + 1)));
  }
  /// Runs `main` on PE 0 to the end of the run.
  template <class Main>
  Result run(Main main) const {
    return run_message(detail::as_message(std::move(main)));
  }
  /// The same; the run must end with exit code 0 and without a report.
  template <class Main>
  void run_clean(Main main) const;

 private:
  [[nodiscard]] Result run_message(std::function<void()> main) const;
};

/// The case of a seed, on so many PEs: of the whole job, a multiple of n_processes.
[[nodiscard]] Case case_of(std::uint64_t seed, int n_pes, On on, int n_processes = 1);

/// The processes that mpirun started, with so many PEs each; MPI is initialised by the first of
/// these and finalised by its end.
[[nodiscard]] std::unique_ptr<Machine> make_job_machine(int pes_per_process);

// What was stated in this process.

inline std::atomic<std::uint64_t> n_checks{0};
void add_failure(std::string failure);
/// The failures since the last call, a line for each of the first five; empty if there were none.
[[nodiscard]] std::string take_failures();

/// States what must hold; any thread.
template <class... Parts>
void expect(bool holds, const Parts&... parts) {
  n_checks.fetch_add(1, std::memory_order_relaxed);  // read after the run
  if (!holds) [[unlikely]]
    add_failure(text(parts...));
}
/// States how a run must have ended; its report is the scenario's to check.
void expect_exit(const Result& result, int exit_code = 0);
/// The messages that the report counts as not delivered.
[[nodiscard]] int n_not_delivered(const Result& result);

template <class Main>
void Case::run_clean(Main main) const {
  const Result result = run(std::move(main));
  expect_exit(result);
  expect(result.report.empty(), "the run reports ", result.failure());
}

/// Guards the oracle of the scenario that runs.
inline std::mutex oracle;
template <class F>
void locked(F change) {
  const std::lock_guard lock(oracle);
  change();
}

// What several scenarios draw.

/// A number of 0 … n − 1.
[[nodiscard]] inline int draw(Random& random, int n) {
  return static_cast<int>(random.below(static_cast<std::uint64_t>(n)));
}
[[nodiscard]] inline const std::string& any_of(const std::vector<std::string>& names,
                                               Random& random) {
  return names[random.below(names.size())];
}
/// Less than this, in nanoseconds.
[[nodiscard]] inline Time any_time(Random& random, std::uint64_t end) {
  return Time(static_cast<std::int64_t>(random.below(end)));
}
/// Any PE of the run.
[[nodiscard]] inline PeId any_pe(Random& random) {
  return PeId{draw(random, tess::n_pes())};
}
/// A map of indices to PEs that seems random.
struct ByLot {
  std::uint64_t salt = 0;
  PeId operator()(Index1 index, std::int32_t n_pes) const {
    return PeId{static_cast<std::int32_t>(mix(salt ^ static_cast<std::uint64_t>(index.x)) %
                                          static_cast<std::uint64_t>(n_pes))};
  }
};

}  // namespace tess::fuzz
