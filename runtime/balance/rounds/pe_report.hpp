// What one PE tells the coordinator of a round: its elements with their measured loads, and what
// they sent. From the reports of all PEs, in PE order, the snapshot that a strategy sees.
#pragma once

#include "runtime/balance/rounds/options.hpp"
#include "runtime/balance/snapshot.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tess::balance {

/// What an element sent to another since the last collection.
struct Parcel {
  std::uint64_t from = 0;  ///< position among the PE's elements
  ElementKey to;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
};

/// Arrays have one entry an element of the PE; positions may be empty instead.
struct PeReport {
  std::vector<ElementKey> keys;
  std::vector<double> seconds;  ///< measured here, at this PE's speed
  std::vector<std::uint8_t> migratable;
  std::vector<std::uint64_t> size_bytes;
  std::vector<std::array<double, 3>> positions;
  std::vector<Parcel> parcels;
  std::vector<std::pair<std::uint32_t, double>> seconds_by_action;
  double background = 0;  ///< seconds busy outside of these elements
};

/// Reports in PE order. Parcels to elements that nobody reports are left out.
[[nodiscard]] Snapshot snapshot_of(const std::vector<PeReport>& reports,
                                   const BalanceOptions& options);

/// A phase without its elements: enough to see whether a round is worth it.
struct PhaseSums {
  double slowest = 0;  ///< seconds of the PE that took longest
  double work = 0;     ///< seconds at speed 1, of all
  double speed = 0;    ///< of all
};

/// Merges the sums of two PEs.
struct MergeSums {
  PhaseSums operator()(PhaseSums a, const PhaseSums& b) const {
    return {a.slowest > b.slowest ? a.slowest : b.slowest, a.work + b.work, a.speed + b.speed};
  }
};

}  // namespace tess::balance
