// The load of the next phase from those of the past ones: by element key, so that an element that
// migrates, or goes and comes back, is met with its own history.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <string_view>
#include <vector>

namespace tess::balance {

enum class Prediction {
  last,            ///< as in the last phase in which it was there
  moving_average,  ///< mean of the phases within the window in which it was there
  linear_trend,    ///< least squares through these, continued to the next phase; never below 0
};

/// By name: last, moving_average, linear_trend. Throws Error that lists the names for any other.
[[nodiscard]] Prediction parse_prediction(std::string_view name);

class Predictor {
 public:
  /// `window`: how many loads of an element count, at least 1. `forget_after`: phases without an
  /// element after which its history goes, so that memory is bounded by what is alive.
  explicit Predictor(Prediction kind, std::size_t window = 5, std::size_t forget_after = 100);

  /// The measured loads of one more phase; those that are not known are left out.
  void record(const Snapshot& measured);

  /// The load of the next phase; nothing is known of an element that no phase has had: 0.
  [[nodiscard]] double load(const ElementKey& key) const;

  /// The snapshot with predicted loads in place of measured ones; an element that no phase has had
  /// keeps what stands there. What has a history is of known load.
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
  boost::unordered_flat_map<ElementKey, History, ElementKeyHash> history_;
};

}  // namespace tess::balance
