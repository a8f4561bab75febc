// What the coordinator of an array's rounds decides, without a message: from the reports of the PEs
// the moves of a round, and whether a round is worth it. It keeps the history.
//
// automatic is ski rental: the time lost to imbalance since the last round is added up, and once it
// exceeds what a round cost when last measured, one runs. So at most twice the time of the best
// hindsight is lost, without knowing how long the run lasts. Imbalance that the last round could
// not remove counts a tenth, or a single heavy element would have rounds run in vain for ever.
// After a round comes one more collection: the next phase's loads under the placement before the
// round tell what the round gained, and if that was less than nothing the moves are undone.
#pragma once

#include "runtime/balance/prediction.hpp"
#include "runtime/balance/rounds/pe_report.hpp"
#include "runtime/balance/rounds/round.hpp"
#include "runtime/balance/strategy.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <optional>

namespace tess::balance {

/// An element that leaves its PE.
struct Move {
  std::uint64_t element = 0;  ///< position in its PE's report
  PeId to{};
};

class Coordinator {
 public:
  /// `users`: the user's own strategy, or empty for the one that the options name.
  Coordinator(BalanceOptions options, Strategy users);

  [[nodiscard]] const BalanceOptions& options() const { return options_; }

  /// automatic: whether to collect loads and decide() at this barrier. Not while no load is known.
  [[nodiscard]] bool worth(const PhaseSums& phase);

  /// The moves of a round, for each PE; none while no load is known.
  [[nodiscard]] std::vector<std::vector<Move>> decide(const std::vector<PeReport>& reports);

  /// A distributed strategy ran: what it says of itself.
  void record_distributed(Round round);

  /// The last round is over; returns it. `seconds`: of the round, and of the phase before it.
  const Round& finish(double round_seconds, double phase_seconds);

  [[nodiscard]] const std::vector<Round>& history() const { return history_; }

 private:
  using Placement = boost::unordered_flat_map<ElementKey, PeId, ElementKeyHash>;

  [[nodiscard]] Assignment before_last_round(const Snapshot& measured) const;
  void judge_last_round(const Snapshot& measured, double now);
  [[nodiscard]] Assignment choose(const Snapshot& measured, Round& round);

  const BalanceOptions options_;
  Strategy strategy_;
  std::optional<Predictor> predictor_;  // none: the last phase is what it is expected to be
  std::vector<Round> history_;
  Placement moved_from_;  // by the last round
  double cost_ = 0;       // seconds of the last round that asked the strategy
  double lost_ = 0;       // to imbalance, since the last round
  double floor_ = 1;      // max/average that the last round left
  bool judges_ = false;   // automatic: the last round moved, and its gain is not known yet
};

}  // namespace tess::balance
