// Runs a test's program in a child process, without output. So a run that ends the process, by a
// failed check or a crash, is an ordinary failure, and no run sees what another left behind.
#pragma once

#include "runtime/more/testing.hpp"
#include "runtime/more/testing/trial.hpp"

#include <array>
#include <csignal>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tess::test::detail {

/// What a run of the program with one seed gave.
struct Outcome {
  std::string failure;               ///< empty if it passed
  std::optional<DecisionIds> taken;  ///< sorted; absent if the process ended without a word
  std::vector<std::string> words;
};

/// Runs it in this process. `trial` is filled.
[[nodiscard]] Outcome run_here(const Program& program, std::uint64_t seed, Trial& trial);

/// What is known of a run that ends here, in its midst.
[[nodiscard]] Outcome outcome_so_far(std::string failure, Trial& trial);

/// Runs it in a child process. Throws Error if there can be none.
[[nodiscard]] Outcome run_apart(const Program& program, std::uint64_t seed, const Trial& trial);

/// From now on a child process has so many seconds; 0: any number.
void limit_children(unsigned seconds);

/// A child whose time is over ends here. A run asks at every step.
void leave_if_late();

/// Signals of a program that crashes.
inline constexpr std::array crashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

/// The failure of a run whose TESS_CHECK failed.
inline constexpr const char* check_failure = "a check failed";

}  // namespace tess::test::detail
