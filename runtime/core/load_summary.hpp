// What limits a run, in one sentence: how long PEs wait, what perfect balance would save, what the
// largest element allows a balancer, and what the runtime and its messages cost. The numbers are
// shares of the time T that the run took, from the measured loads of the PEs:
//
//     wait      1 − mean(busy) / T                     balance   (max(busy) − mean(busy)) / T
//     runtime   mean(busy outside of elements) / T     element   (max(busy) − max(mean(busy), largest)) / T
//
// Loads are sums over the run: where the work moves from PE to PE while it goes on, a balancer may
// save more than `balance`, which then stands in `wait`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tess {

/// What was measured on one PE, in seconds.
struct PeLoad {
  double seconds = 0;  ///< since the measurement began
  double busy = 0;     ///< of these, not waiting for messages
  double speed = 1;    ///< relative to other PEs
  /// What elements and the main program took of `busy`; it is below 0 if it was not measured.
  double in_elements = -1;
  double largest = 0;     ///< in the code of the element here that took most
  std::string element{};  ///< its name; empty: elements were not measured
};

/// Shares of the time of the run, 0 … 1; below 0: not measured.
struct LoadSummary {
  double wait = -1, balance = -1, runtime = -1;
  double element = -1;  ///< what any balancer could save at most
  std::string largest;  ///< name of the largest element
};

[[nodiscard]] LoadSummary summarise(const std::vector<PeLoad>& pes);

/// "PEs wait 31 % of the time; perfect balance would save 27 %; the largest element, Block[3,4],
/// allows 18 %; the runtime and its messages cost 2 %".
[[nodiscard]] std::string describe(const LoadSummary& summary);

}  // namespace tess
