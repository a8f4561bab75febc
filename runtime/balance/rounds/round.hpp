// The results of one balance round: predicted before, measured after.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace tess::balance {

/// max/average is the time of the slowest PE over the time if work could be divided freely.
struct Round {
  std::uint64_t number = 0;
  std::string strategy;
  std::size_t n_elements = 0;
  std::size_t n_unknown = 0;  ///< elements of these with unknown load, which stay
  std::size_t n_moved =
      0;  ///< beside work (periodic) some of a central round's may have ended before
  std::uint64_t moved_bytes = 0;  ///< packed size of the moved elements
  double before = 1;              ///< max/average as measured in the phase that ended
  double predicted = 1;           ///< the strategy's prediction, after its moves
  /// Measured in the next phase; 0 until its end, and for a central round that moved nothing.
  double measured = 0;
  /// The share of the slowest PE's time that the round saved in the next phase, compared with the
  /// same phase without its moves; 0 until its end, and for a distributed strategy.
  double gain = 0;
  double strategy_seconds = 0;  ///< seconds of the strategy; 0 for a distributed one
  double round_seconds = 0;     ///< from the barrier (or the trigger) to the resume
  double phase_seconds = 0;     ///< from the last resume to the barrier
  bool skipped = false;         ///< nothing to gain, or no load is known yet
  bool rolled_back = false;     ///< automatic: the moves of the round before were undone
  /// Of all elements, in the phase; empty for a distributed strategy.
  std::map<std::string, double> seconds_by_entry;
};

/// "balance round 3 greedy: moved 12 of 64 (12 KiB), max/avg 1.49 -> 1.003 (predicted), 0.18 ms
/// (strategy 0.05 ms); round 2 measured 1.01, gain 30 %".
[[nodiscard]] std::string describe(const Round& round, const Round* last);

}  // namespace tess::balance
