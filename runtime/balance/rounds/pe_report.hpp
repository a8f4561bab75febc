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
  std::vector<double> seconds;         ///< measured here, at this PE's speed
  std::vector<std::uint8_t> measured;  ///< 0: not for a whole phase, `seconds` says nothing
  std::vector<std::uint8_t> migratable;
  std::vector<std::uint64_t> size_bytes;
  std::vector<std::array<double, 3>> positions;
  std::vector<Parcel> parcels;
  std::vector<std::pair<std::uint32_t, double>> seconds_by_action;
  double background = 0;  ///< seconds busy outside of these elements
};

/// Reports in PE order. Parcels to elements without a report are left out; loads that are not
/// known are taken to be the mean of the others.
[[nodiscard]] Snapshot snapshot_of(const std::vector<PeReport>& reports,
                                   const BalanceOptions& options);

/// A phase without its elements: enough to see whether a round is worth it.
struct PhaseSums {
  double slowest = 0;  ///< seconds of the PE that took longest
  double work = 0;     ///< seconds at speed 1, of all
  double speed = 0;    ///< of all
  double load = 0;     ///< the part of `work` that elements of known load did
  std::uint64_t n_measured = 0;
  std::uint64_t n_unknown = 0;  ///< elements whose load is not known; no time here counts them

  /// What is taken for a load that is not known.
  [[nodiscard]] double mean_load() const {
    return n_measured == 0 ? 0 : load / static_cast<double>(n_measured);
  }
  /// Seconds that every PE would need if work were a fluid.
  [[nodiscard]] double average_time() const {
    return (work + mean_load() * static_cast<double>(n_unknown)) / speed;
  }
};

/// Merges the sums of two PEs.
struct MergeSums {
  PhaseSums operator()(PhaseSums a, const PhaseSums& b) const {
    return {a.slowest > b.slowest ? a.slowest : b.slowest,
            a.work + b.work,
            a.speed + b.speed,
            a.load + b.load,
            a.n_measured + b.n_measured,
            a.n_unknown + b.n_unknown};
  }
};

}  // namespace tess::balance
