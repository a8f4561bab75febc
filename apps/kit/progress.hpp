// A line on a terminal that reports the progress of long work, rewritten in place. It costs the
// work one store per phase: a sleeping thread does the rest, and only if the output is a terminal.
// Nothing is shown before the work has taken a second.
#pragma once

#include <atomic>
#include <chrono>
#include <concepts>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <thread>

namespace kit {

/// Seconds until all of `n_parts` parts are done, if part `part` (from 1) began `began` seconds
/// after the first and has lasted `lasted` seconds: the parts to come take as long as those before
/// on average. None while the first part runs.
[[nodiscard]] std::optional<double> seconds_left(std::uint32_t part, std::uint32_t n_parts,
                                                 double began, double lasted) noexcept;

class Progress {
 public:
  /// Shows nothing if `terminal` is none, or null.
  explicit Progress(std::FILE* terminal, std::chrono::milliseconds first = std::chrono::seconds(1),
                    std::chrono::milliseconds next = std::chrono::milliseconds(250));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Work enters a phase: a text that outlives this object. Any thread.
  void phase(const char* name) noexcept {
    phase_.store(name, std::memory_order_relaxed);  // partner: show(); nothing else is read by it
  }
  /// Work enters its part `part` (from 1) of `n_parts`. Any thread.
  template <std::integral Part, std::integral N>
  void part(Part part, N n_parts) noexcept {
    part_.store(static_cast<std::uint64_t>(part) << 32U | static_cast<std::uint32_t>(n_parts),
                std::memory_order_relaxed);
  }
  /// Removes the line, so that other text can be printed; it may come again.
  void clear();

 private:
  void show();

  std::FILE* terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<const char*> phase_{"starting"};
  std::atomic<std::uint64_t> part_{0};
  std::mutex line_;
  bool shown_ = false;  // under line_
  // Under line_: the part that was shown last, and when it and the first were.
  std::uint64_t part_shown_ = 0;
  double first_part_began_ = 0;
  double part_began_ = 0;
  std::condition_variable_any wake_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace kit
