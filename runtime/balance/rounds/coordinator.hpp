// The decisions of the coordinator, without messages: the moves of a round from the reports of the
// PEs, and whether a round pays off. It keeps the history.
//
// `automatic` is the ski rental algorithm: the time lost to imbalance since the last round is added
// up, and a round runs once it exceeds the last measured cost of a round. So at most twice the loss
// of the best decision in hindsight is lost, without knowing how long the run lasts. Imbalance that
// the last round could not remove counts a tenth; otherwise a single heavy element would cause
// useless rounds for ever. After a round loads are collected once more: the loads of the next phase
// under the placement before the round show the gain, and a negative gain undoes the moves.
//
// That holds while loads persist. If a round gained less than half of what it predicted, they do
// not: the next round waits until twice as much is lost, counted from its cost plus the seconds
// that its moves cost the phase after it. So loads that change at random cause ever fewer rounds. A
// round that gains what it predicted ends this. The gain of a distributed round is not known, since
// no PE has the loads of all elements: it is neither undone nor judged.
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
  /// `users` is the user's own strategy, or empty for the one that the options name.
  Coordinator(BalanceOptions options, Strategy users);

  [[nodiscard]] const BalanceOptions& options() const { return options_; }

  /// For `automatic`: true if loads should be collected for decide() at this barrier. False while
  /// no load is known.
  [[nodiscard]] bool worth(const PhaseSums& phase);

  /// The moves of a round, per PE; none while no load is known.
  [[nodiscard]] std::vector<std::vector<Move>> decide(const std::vector<PeReport>& reports);

  /// Records the result of a distributed strategy.
  void record_distributed(Round round);

  /// Ends the last round and returns it, with the seconds of the round and of the phase before it.
  const Round& finish(double round_seconds, double phase_seconds);

  [[nodiscard]] const std::vector<Round>& history() const { return history_; }

 private:
  using Placement = boost::unordered_flat_map<ElementKey, PeId, ElementKeyHash>;

  [[nodiscard]] bool loses_enough(const PhaseSums& phase);
  [[nodiscard]] Assignment before_last_round(const Snapshot& measured) const;
  void judge_last_round(const Snapshot& measured, double now);
  [[nodiscard]] Assignment choose(const Snapshot& measured, Round& round);

  void learn(double promised, double gain, double harm);

  const BalanceOptions options_;
  const std::string name_;  // of the strategy, in the history
  Strategy strategy_;
  std::optional<Predictor> predictor_;  // none: the next phase is expected to be like the last
  std::vector<Round> history_;
  Placement moved_from_;   // placement before the last round
  bool searched_ = false;  // the last round ran a strategy
  double cost_ = 0;        // seconds of the last round that ran one
  double promised_ = 0;    // its predicted gain
  double harm_ = 0;        // seconds by which its moves prolonged the next phase
  double patience_ = 1;    // how many times its cost has to be lost before the next round
  double lost_ = 0;        // seconds lost to imbalance since the last round
  double floor_ = 1;       // max/average after the last round
  bool judges_ = false;  // automatic: the last round moved elements, and its gain is not known yet
  bool measures_distributed_ = false;  // the phase after a distributed round ends next
};

}  // namespace tess::balance
