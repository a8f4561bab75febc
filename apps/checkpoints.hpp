// The options of a program that writes checkpoints, and when it pauses for the next one:
//
//     apps::Checkpoints checkpoints;
//     checkpoints.add_options(line);                  // --checkpoint, --checkpoint-every, --restart
//     …
//     checkpoints.check();                            // after the command line was parsed
//     …
//     while (step < n_steps) {                        // in the main coroutine
//       const auto until = checkpoints.pause_after(step, n_steps);
//       …                                             // run to `until`, and await it
//       if (checkpoints.is_due(step = until, n_steps)) co_await tess::checkpoint(checkpoints.folder(), state);
//     }
#pragma once

#include "apps/command_line.hpp"
#include "runtime/core/duration.hpp"

#include <cstdint>
#include <string>

namespace apps {

class Checkpoints {
 public:
  void add_options(CommandLine& line);
  /// Throws tess::Error for values that cannot be used.
  void check();

  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] const std::string& restart_folder() const { return restart_; }
  [[nodiscard]] bool restarts() const { return !restart_.empty(); }

  /// The step at which the program pauses next; `last` if it writes no checkpoint before.
  [[nodiscard]] std::int32_t pause_after(std::int32_t step, std::int32_t last);
  /// True if a checkpoint is to be written now that `step` steps of `last` are done; none is after
  /// the last.
  [[nodiscard]] bool is_due(std::int32_t step, std::int32_t last);

 private:
  using Clock = std::chrono::steady_clock;

  std::string folder_, restart_, every_ = "100";
  std::int32_t steps_ = 0;  // 0: by time
  std::chrono::duration<double> period_{0};
  Clock::time_point written_ = Clock::now();  // the last checkpoint, or the start
  Clock::time_point paused_ = Clock::now();
  std::int32_t length_ = 0;  // steps between two pauses
};

}  // namespace apps
