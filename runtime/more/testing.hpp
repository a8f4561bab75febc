// Testing for users: runs chares inside any test framework, on a simulated machine that delays
// messages and moves elements as its seed says, and repeats bit for bit.
//
// Sample: tests/samples/testing.cpp
//
//     tess::test::for_seeds(0, 200, [](std::uint64_t seed) {
//       int found = 0;
//       const tess::test::Machine machine{.pes = 4, .seed = seed};
//       machine.run([&]() -> tess::Task { return write_twice(found); }).require_success();
//       tess::test::expect(found == 20, "found ", found);
//     });
//
// A seed that fails is run again with fewer and fewer of these decisions, as long as it fails.
// for_seeds() then throws Failure, whose text says which decisions are left, in plain words, and
// gives the command that repeats that run:
//
//     TESS_TEST_REPEAT=seed=17,keep=2f61b6e8 ./my_tests
//
// Such a run repeats in the same build only. Everything here is for one thread, outside of a run.
#pragma once

#include "runtime/core/duration.hpp"
#include "runtime/core/text.hpp"
#include "runtime/run.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess::test {

/// What for_seeds() throws; also require_success().
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How a run ended.
struct Result {
  int exit_code = 0;
  std::vector<std::string> report;  ///< what the runtime would have printed to standard error
  std::string exception;  ///< the text of the exception that ended the run; empty if there was none

  /// True if the exit code is 0 and nothing was reported.
  [[nodiscard]] bool ok() const { return exit_code == 0 && report.empty(); }
  /// "exit code 1" and the report; empty if ok().
  [[nodiscard]] std::string failure() const;
  /// Throws Failure unless ok().
  void require_success() const;
};

struct Machine {
  int pes = 4;
  int per_process = 0;                     ///< PEs per process; 0: 1, 2 or all, as the seed says
  std::uint64_t seed = 0;                  ///< of all decisions
  std::chrono::nanoseconds cost{100};      ///< of a message
  std::chrono::nanoseconds latency{1000};  ///< of a message that is not delayed
  double reordering = 0.5;                 ///< probability that a message is delayed
  /// Probability that an element is moved after a message; absent: 0, 0.01, 0.1 or 0.5, as the seed
  /// says.
  std::optional<double> migration{};
  /// A run that needs more is a livelock, and ends with exit code 3. 0: no bound.
  std::uint64_t most_events = 5'000'000;  ///< about two per message
  std::chrono::nanoseconds most_time{};   ///< the same, in virtual time
  RuntimeOptions options{};               ///< all but the seed, migrations, signals and report

  /// Runs `main` on PE 0 of a new machine, to the end of the run. Throws Error for options that fit
  /// no machine.
  template <class Main>
  [[nodiscard]] Result run(Main main) const {
    return run_message(tess::detail::as_message(std::move(main)));
  }

 private:
  [[nodiscard]] Result run_message(std::function<void()> main) const;
};

struct SeedOptions {
  std::string name{};         ///< of the test case, for the printed command
  unsigned most_tries = 500;  ///< runs that look for fewer decisions
};

namespace detail {
/// A test's program: returns the description of a failure, empty if there is none.
using Program = std::function<std::string(std::uint64_t seed)>;
void for_seeds(std::uint64_t first, std::uint64_t end, const Program& program,
               const SeedOptions& options);
}  // namespace detail

/// Calls program(seed) for the seeds first … end − 1, up to the first that fails; then throws
/// Failure. The program runs one or several Machines. It fails if it throws, returns a Result that
/// is not ok() or a text that is not empty, or ends the process by a TESS_CHECK (in which case the
/// text goes to standard error). It must depend on nothing but the seed. The runs that look for
/// fewer decisions are in child processes, without output.
///
/// With TESS_TEST_REPEAT=seed=S[,keep=…] in the environment only that seed is run.
template <class F>
void for_seeds(std::uint64_t first, std::uint64_t end, F program, const SeedOptions& options = {}) {
  using Returned = std::invoke_result_t<F&, std::uint64_t>;
  static_assert(std::is_void_v<Returned> || std::is_same_v<Returned, Result> ||
                    std::is_convertible_v<Returned, std::string>,
                "the program of for_seeds() returns void, a tess::test::Result, or a text that "
                "describes the failure");
  detail::for_seeds(
      first, end,
      [&program](std::uint64_t seed) -> std::string {
        if constexpr (std::is_void_v<Returned>) {
          program(seed);
          return {};
        } else if constexpr (std::is_same_v<Returned, Result>) {
          return program(seed).failure();
        } else {
          return program(seed);
        }
      },
      options);
}

/// Throws Failure with this text unless the condition holds, also inside entry methods.
template <class... Parts>
void expect(bool holds, const Parts&... parts) {
  if (!holds) throw Failure(text(parts...));
}

}  // namespace tess::test
