// The quality of an assignment: imbalance, moves, traffic between PEs. An unknown load counts as the
// mean of the others.
#pragma once

#include "runtime/balance/snapshot.hpp"
#include "runtime/core/load_summary.hpp"

namespace tess::balance {

struct Metrics {
  double max_over_average = 1;  ///< time of the slowest PE over the ideal time; 1 without load
  std::size_t n_moves = 0;
  std::uint64_t moved_bytes = 0;
  std::uint64_t external_bytes = 0;  ///< bytes of edges between different PEs
};

/// Improvements of the slowest PE by a smaller part may be noise of the loads: no element moves.
inline constexpr double least_gain = 0.005;

/// The seconds that every PE would need if work could be divided freely: (work + background ×
/// speed) / speed, summed first.
[[nodiscard]] double average_time(const Snapshot& snapshot);
[[nodiscard]] Metrics measure(const Snapshot& snapshot, const Assignment& assignment);

/// The communication matrix: the bytes that elements on PE [i] send to those on PE [j].
[[nodiscard]] std::vector<std::vector<std::uint64_t>> bytes_between(const Snapshot& snapshot,
                                                                    const Assignment& assignment);

/// What each PE works in such a phase, which ends when the slowest has ended; for summarise().
[[nodiscard]] std::vector<PeLoad> loads_of_pes(const Snapshot& snapshot,
                                               const Assignment& assignment);

}  // namespace tess::balance
