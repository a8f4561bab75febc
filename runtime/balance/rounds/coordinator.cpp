#include "runtime/balance/rounds/coordinator.hpp"

#include "runtime/balance/honour.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/rounds/internals.hpp"
#include "runtime/balance/unknown_loads.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace tess::balance {
namespace {

constexpr double counts_in_vain = 0.1;  // share of the imbalance that a round left
constexpr double noise = 0.01;    // share of the average: smaller differences of loads are ignored
constexpr double persists = 0.5;  // share of the predicted gain that shows that loads persist
constexpr double most_patience = 1e12;  // so that it stays finite

double slowest(const Snapshot& s, const Assignment& placement) {
  return measure(s, placement).max_over_average * average_time(s);
}

std::map<std::string, double> by_entry(const std::vector<PeReport>& reports) {
  std::map<std::string, double> result;
  for (const PeReport& report : reports)
    for (const auto& [action, seconds] : report.seconds_by_action)
      result[plain_name(Registry::at(action).name())] += seconds;
  return result;
}

/// Reports do not give the name of a built-in strategy to the user's own.
std::string name_of(const BalanceOptions& options, bool is_users) {
  const bool built_in = std::ranges::count(strategy_names(), options.strategy) > 0;
  return is_users && built_in ? "own" : options.strategy;
}

}  // namespace

Coordinator::Coordinator(BalanceOptions options, Strategy users)
    : options_(std::move(options)),
      name_(name_of(options_, users != nullptr)),
      strategy_(users ? make_strategy(std::move(users), name_)
                      : make_strategy(options_.strategy, options_.seed)) {
  const Prediction prediction = parse_prediction(options_.prediction);
  if (prediction != Prediction::last) predictor_.emplace(prediction, options_.window);
}

bool Coordinator::worth(const PhaseSums& phase) {
  const bool collects = loses_enough(phase);
  if (!collects && predictor_) predictor_->pass();  // decide() records the others
  return collects;
}

bool Coordinator::loses_enough(const PhaseSums& phase) {
  if (phase.n_measured == 0) return false;
  if (judges_) return true;
  const double average = phase.known_average();
  if (std::exchange(measures_distributed_, false) && average > 0)
    history_.back().measured = phase.slowest / average;
  const double above_floor = std::max(0.0, phase.slowest - (floor_ + noise) * average);
  const double in_vain = std::max(0.0, phase.slowest - (1 + noise) * average) - above_floor;
  lost_ += above_floor + counts_in_vain * in_vain;
  return lost_ > patience_ * (cost_ + harm_);
}

void Coordinator::learn(double promised, double gain, double harm) {
  const bool persistent = gain >= persists * promised;
  patience_ = persistent ? 1 : std::min(2 * patience_, most_patience);
  harm_ = persistent ? 0 : std::max(harm, 0.0);
}

Assignment Coordinator::before_last_round(const Snapshot& measured) const {
  Assignment placement = measured.elements.pe;
  for (std::size_t i = 0; i < placement.size(); ++i)
    if (const auto at = moved_from_.find(measured.elements.key[i]); at != moved_from_.end())
      placement[i] = at->second;
  return placement;
}

void Coordinator::judge_last_round(const Snapshot& measured, double now) {
  if (history_.empty() || moved_from_.empty()) return;
  Round& last = history_.back();
  const double average = average_time(measured);
  if (!(average > 0)) return;
  const double without = slowest(measured, before_last_round(measured));
  last.measured = now / average;
  last.gain = 1 - now / without;
  if (judges_) learn(promised_, last.gain, now - without);
}

Assignment Coordinator::choose(const Snapshot& measured, Round& round) {
  const bool automatic = options_.when == BalanceWhen::automatic;
  if (judges_) {
    judges_ = false;
    floor_ = round.before;
    if (history_.back().gain < -noise) {
      round.rolled_back = true;
      const Assignment before = before_last_round(measured);
      floor_ = measure(measured, before).max_over_average;
      return honour(measured, before);
    }
    round.skipped = true;
    return measured.elements.pe;
  }
  searched_ = true;
  const Snapshot predicted = predictor_ ? predictor_->predict(measured) : Snapshot{};
  const Snapshot& expected = predictor_ ? predicted : measured;
  const auto began = std::chrono::steady_clock::now();
  Assignment wanted = strategy_(expected);
  round.strategy_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  round.predicted = measure(expected, wanted).max_over_average;
  const double stays = slowest(expected, expected.elements.pe);
  promised_ = stays > 0 ? 1 - slowest(expected, wanted) / stays : 0;
  if (automatic && slowest(expected, wanted) >= stays) {
    floor_ = round.before;
    round.skipped = true;
    return measured.elements.pe;
  }
  return wanted;
}

std::vector<std::vector<Move>> Coordinator::decide(const std::vector<PeReport>& reports) {
  const Snapshot measured = snapshot_of(reports, options_);
  validate(measured);
  if (predictor_) predictor_->record(measured);
  Round round;
  round.number = history_.size();
  round.strategy = name_;
  round.n_elements = measured.elements.size();
  round.n_unknown = measured.elements.size() - n_known_loads(measured);
  round.seconds_by_entry = by_entry(reports);
  round.before = measure(measured, measured.elements.pe).max_over_average;
  judge_last_round(measured, round.before * average_time(measured));
  const bool blind = round.n_elements > 0 && round.n_unknown == round.n_elements;
  round.skipped = blind;
  searched_ = false;
  const Assignment wanted = blind ? measured.elements.pe : choose(measured, round);
  const Metrics metrics = measure(measured, wanted);
  if (round.skipped || round.rolled_back) round.predicted = metrics.max_over_average;
  round.n_moved = metrics.n_moves;
  round.moved_bytes = metrics.moved_bytes;
  lost_ = 0;

  moved_from_.clear();
  std::vector<std::vector<Move>> moves(reports.size());
  std::size_t at = 0;
  for (std::size_t pe = 0; pe < reports.size(); ++pe) {
    for (std::size_t i = 0; i < reports[pe].keys.size(); ++i, ++at) {
      if (wanted[at] == pe_at(pe)) continue;
      moves[pe].push_back({i, wanted[at]});
      moved_from_.emplace(measured.elements.key[at], pe_at(pe));
    }
  }
  judges_ = options_.when == BalanceWhen::automatic && round.n_moved != 0 && !round.rolled_back;
  history_.push_back(std::move(round));
  return moves;
}

void Coordinator::record_distributed(Round round) {
  round.number = history_.size();
  round.strategy = name_;
  // `automatic` may run this round many phases after the last: worth() saw the phase after that.
  if (!history_.empty() && options_.when != BalanceWhen::automatic)
    history_.back().measured = round.before;
  floor_ = round.predicted;
  lost_ = 0;
  searched_ = true;
  measures_distributed_ = options_.when == BalanceWhen::automatic && round.n_moved != 0;
  history_.push_back(std::move(round));
}

const Round& Coordinator::finish(double round_seconds, double phase_seconds) {
  Round& round = history_.back();
  round.round_seconds = round_seconds;
  round.phase_seconds = phase_seconds;
  if (searched_) cost_ = round_seconds;
  return round;
}

}  // namespace tess::balance
