#include "runtime/balance/prediction.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::balance {

Prediction parse_prediction(std::string_view name) {
  if (name == "last") return Prediction::last;
  if (name == "moving_average") return Prediction::moving_average;
  if (name == "linear_trend") return Prediction::linear_trend;
  fail(ErrorCode::bad_argument, "no prediction '", name,
       "'; choose one of last, moving_average, linear_trend");
}

Predictor::Predictor(Prediction kind, std::size_t window, std::size_t forget_after)
    : kind_(kind), window_(window), forget_after_(forget_after) {
  if (window == 0) fail(ErrorCode::bad_argument, "prediction: window 0; give at least 1");
}

void Predictor::record(const Snapshot& measured) {
  ++n_phases_;
  for (std::size_t i = 0; i < measured.elements.size(); ++i) {
    const Load load = measured.elements.load[i];
    if (!load.is_known()) continue;
    History& history = history_[measured.elements.key[i]];
    if (history.size() == window_) history.erase(history.begin());
    history.push_back({n_phases_, load.seconds()});
  }
  // Searching all histories costs as much as recording, so it is done only now and then.
  if (n_phases_ < purged_at_ + forget_after_ / 4 + 1) return;
  purged_at_ = n_phases_;
  boost::unordered::erase_if(history_, [&](const auto& entry) {
    return entry.second.back().phase + forget_after_ < n_phases_;
  });
}

double Predictor::load(const ElementKey& key) const {
  const auto found = history_.find(key);
  return found == history_.end() ? 0.0 : next(found->second);
}

Snapshot Predictor::predict(Snapshot s) const {
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const auto found = history_.find(s.elements.key[i]);
    if (found == history_.end()) continue;
    s.elements.load[i] = next(found->second);
  }
  return s;
}

double Predictor::next(const History& history) const {
  if (kind_ == Prediction::last) return history.back().load;
  const auto n = static_cast<double>(history.size());
  double mean_phase = 0, mean_load = 0;
  for (const Sample& sample : history) {
    mean_phase += static_cast<double>(sample.phase) / n;
    mean_load += sample.load / n;
  }
  if (kind_ == Prediction::moving_average || history.size() == 1) return mean_load;
  double covariance = 0, variance = 0;
  for (const Sample& sample : history) {
    const double distance = static_cast<double>(sample.phase) - mean_phase;
    covariance += distance * (sample.load - mean_load);
    variance += distance * distance;
  }
  const double ahead = static_cast<double>(n_phases_ + 1) - mean_phase;
  return std::max(0.0, mean_load + covariance / variance * ahead);
}

}  // namespace tess::balance
