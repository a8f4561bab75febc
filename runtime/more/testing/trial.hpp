// One call of a test's program with one seed: which decisions its machines may take, and what they
// report back. The command that repeats it is text in the environment.
#pragma once

#include "runtime/more/testing/shrink.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::test::detail {

/// The value of TESS_TEST_REPEAT: "seed=17,keep=2f61b6e8,00a1b2c3", "seed=17,keep=none", "seed=17".
struct Repeat {
  std::uint64_t seed = 0;
  std::optional<DecisionIds> keep;  ///< absent: all
};

/// Throws Error that names the part.
[[nodiscard]] Repeat parse_repeat(std::string_view text);
[[nodiscard]] std::string repeat_text(const Repeat& repeat);
/// What the environment requests.
[[nodiscard]] std::optional<Repeat> requested_repeat();

struct Trial {
  std::optional<DecisionIds> keep{};  ///< sorted; absent: all
  bool in_words = false;

  // Filled by the machines.
  std::uint64_t n_runs = 0;
  DecisionIds taken{};
  std::vector<std::string> words{};      ///< of the runs that have ended
  std::function<void()> update_words{};  ///< adds those of the present run; empty between two
};

/// The trial of this thread; null outside of for_seeds().
[[nodiscard]] Trial* current_trial();

/// Makes a trial the current one during a scope.
class InTrial {
 public:
  explicit InTrial(Trial& trial);
  InTrial(const InTrial&) = delete;
  InTrial& operator=(const InTrial&) = delete;
  ~InTrial();

 private:
  Trial* const before_;
};

}  // namespace tess::test::detail
