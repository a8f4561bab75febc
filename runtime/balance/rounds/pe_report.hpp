// The report of one PE to the coordinator of a round: its elements with their measured loads, and
// the messages that they sent. The reports of all PEs, in PE order, give the snapshot for a
// strategy.
#pragma once

#include "runtime/balance/snapshot.hpp"
#include "runtime/balance_options.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess::balance {

/// The messages from one element to another since the last collection.
struct Parcel {
  std::uint64_t from = 0;  ///< position among the PE's elements
  ElementKey to;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
};

/// Arrays have one entry per element of the PE; positions and indices may be empty instead.
struct PeReport {
  std::vector<ElementKey> keys;
  std::vector<Load> loads;
  std::vector<std::uint8_t> migratable;
  std::vector<std::uint64_t> size_bytes;
  std::vector<std::array<double, 3>> positions;
  std::vector<std::string> indices;  ///< empty unless asked for
  std::vector<Parcel> parcels;
  std::vector<std::pair<std::uint32_t, double>> seconds_by_action;
  double background = 0;  ///< seconds busy outside of these elements
};

/// Combines the reports, in PE order. Parcels to elements without a report are left out.
[[nodiscard]] Snapshot snapshot_of(const std::vector<PeReport>& reports,
                                   const BalanceOptions& options);

/// The sums of a phase without its elements: enough to decide whether a round pays off.
struct PhaseSums {
  double slowest = 0;  ///< seconds of the PE that took longest
  double work = 0;     ///< seconds at speed 1, sum of all PEs
  double speed = 0;    ///< sum of all PEs
  double load = 0;     ///< the part of `work` of elements with known load
  std::uint64_t n_measured = 0;
  std::uint64_t n_unknown = 0;  ///< elements with unknown load; no time here includes them

  /// The load that is assumed for an unknown one.
  [[nodiscard]] double mean_load() const {
    return n_measured == 0 ? 0 : load / static_cast<double>(n_measured);
  }
  /// The average of what is known, to compare `slowest` with.
  [[nodiscard]] double known_average() const { return work / speed; }
  [[nodiscard]] double max_over_average() const { return work > 0 ? slowest / known_average() : 1; }
  /// The seconds that every PE would need if work could be divided freely.
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
