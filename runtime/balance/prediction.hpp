// Predicts the loads of the next phase from those of past ones. Histories are kept by element key,
// so an element that migrates, or leaves and returns, keeps its history.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <string_view>
#include <vector>

namespace tess::balance {

enum class Prediction {
  last,            ///< the load of the last phase with the element
  moving_average,  ///< the mean over the phases of the window with the element
  linear_trend,    ///< least squares through these, extended to the next phase; never below 0
};

/// The prediction of this name: last, moving_average, linear_trend. Throws Error that lists the
/// names for any other.
[[nodiscard]] Prediction parse_prediction(std::string_view name);

class Predictor {
 public:
  /// `window`: the number of loads of an element that count, at least 1. `forget_after`: the number
  /// of phases without an element after which its history is removed, so that memory stays bounded.
  explicit Predictor(Prediction kind, std::size_t window = 5, std::size_t forget_after = 100);

  /// Records the measured loads of one more phase; unknown loads are left out.
  void record(const Snapshot& measured);

  /// One more phase, whose loads are not recorded.
  void pass() { ++n_phases_; }

  /// The load of the next phase; 0 for an element without history.
  [[nodiscard]] double load(const ElementKey& key) const;

  /// The snapshot with predicted loads in place of measured ones. An element without history keeps
  /// its entry. An element with history has a known load.
  [[nodiscard]] Snapshot predict(Snapshot snapshot) const;

  [[nodiscard]] std::size_t n_known() const { return history_.size(); }

 private:
  struct Sample {
    std::size_t phase = 0;
    double load = 0;
  };
  using History = std::vector<Sample>;  // oldest first, at most window_
  [[nodiscard]] double next(const History& history) const;

  Prediction kind_;
  std::size_t window_;
  std::size_t forget_after_;
  std::size_t n_phases_ = 0;
  std::size_t purged_at_ = 0;  // the phase in which old histories were removed last
  boost::unordered_flat_map<ElementKey, History, ElementKeyHash> history_;
};

}  // namespace tess::balance
