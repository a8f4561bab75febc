// What one balance round did: predicted before, measured after.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tess::balance {

/// max/average: the time of the slowest PE over the time if work were a fluid.
struct Round {
  std::uint64_t number = 0;
  std::string strategy;
  std::size_t n_elements = 0;
  std::size_t n_unknown = 0;  ///< of these, elements whose load is not known yet: they stay
  std::size_t n_moved = 0;
  std::uint64_t moved_bytes = 0;  ///< packed; what a process boundary would see
  double before = 1;              ///< max/average as measured in the phase that ended
  double predicted = 1;           ///< the strategy's, after its moves
  double measured = 0;            ///< in the next phase; 0 until that ended
  /// The share of the slowest PE's time that the round saved in the next phase, against the same
  /// phase without its moves; 0 until that ended.
  double gain = 0;
  double strategy_seconds = 0;  ///< the strategy alone; a distributed one: 0, it is the round
  double round_seconds = 0;     ///< from the barrier (or the trigger) to the resume
  double phase_seconds = 0;     ///< from the last resume to the barrier
  bool skipped = false;         ///< nothing to gain, or no load is known yet
  bool rolled_back = false;     ///< automatic: the moves of the round before were undone
  std::map<std::string, double> seconds_by_entry;  ///< of all elements in the phase
};

/// "balance round 3 greedy: moved 12 of 64 (12 KiB), max/avg 1.49 -> 1.003 (predicted), 0.18 ms
/// (strategy 0.05 ms); round 2 measured 1.01, gain 30 %".
[[nodiscard]] std::string describe(const Round& round, const Round* last);

}  // namespace tess::balance
