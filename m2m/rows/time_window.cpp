#include "m2m/time_window.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// A sum of target steps may end beyond the last sample by so much of the times.
constexpr double rounding = 0x1p-40;

/// Adds what a weight of 0 takes nothing of: NaN at another time stays there.
void add(double weight, std::span<const double> values, std::span<double> to) {
  if (weight == 0) return;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += weight * values[i];
}

}  // namespace

TimeWindow::TimeWindow(std::size_t n_values, TimeMethod method, std::size_t n_samples)
    : method_(method), n_kept_(n_samples) {
  if (n_samples < 2)
    fail(ErrorCode::bad_argument, "a TimeWindow that keeps ", n_samples,
         " samples has no time between two of them: keep 2 or more");
  next_.values.resize(n_values);
  if (method == TimeMethod::hermite) next_.rates.resize(n_values);
}

void TimeWindow::accept(double time) {
  if (!std::isfinite(time) || (!samples_.empty() && time < last()))
    fail(ErrorCode::bad_argument, "a sample at time ", time, " follows ",
         samples_.empty() ? "none" : text("one at time ", last()),
         " in a TimeWindow: times are finite and ascend");
  next_.time = time;
  if (!samples_.empty() && last() == time) {
    samples_.back() = next_;
    return;
  }
  if (samples_.size() == n_kept_) {
    std::rotate(samples_.begin(), samples_.begin() + 1, samples_.end());
    samples_.back() = next_;  // in the memory of the oldest
  } else {
    samples_.push_back(next_);
  }
}

std::vector<double> TimeWindow::at(double time) const {
  std::vector<double> values(next_.values.size());
  at(time, values);
  return values;
}

void TimeWindow::at(double time, std::span<double> to) const {
  TESS_CHECK(to.size() == next_.values.size(), "a TimeWindow of ", next_.values.size(),
             " values is asked for ", to.size());
  if (samples_.empty())
    fail(ErrorCode::out_of_range, "values at time ", time,
         " are asked of a TimeWindow without samples: accept() one first");
  const double slack = rounding * std::max(std::abs(first()), std::abs(last()));
  if (!(time >= first() - slack && time <= last() + slack))
    fail(ErrorCode::out_of_range, "values at time ", time, " are asked of a TimeWindow from ",
         first(), " to ", last(), ": apply the coupling up to that time, or keep more than ",
         n_kept_, " samples");
  time = std::clamp(time, first(), last());
  std::ranges::fill(to, -0.0);  // plus x it is x, also for -0
  if (samples_.size() == 1) return add(1, samples_[0].values, to);
  // The interval from sample `left` to the next.
  const auto after = std::ranges::upper_bound(samples_, time, {}, &Sample::time);
  const std::size_t left = std::min<std::size_t>(static_cast<std::size_t>(after - samples_.begin()),
                                                 samples_.size() - 1) -
                           1;
  const Sample &a = samples_[left], &b = samples_[left + 1];
  const double step = b.time - a.time, s = (time - a.time) / step;
  if (method_ == TimeMethod::hermite) {
    const double rest = 1 - s;
    add((1 + 2 * s) * rest * rest, a.values, to);
    add(s * s * (3 - 2 * s), b.values, to);
    add(step * s * rest * rest, a.rates, to);
    add(-step * s * s * rest, b.rates, to);
    return;
  }
  std::size_t low = left, high = left + 2;
  if (method_ == TimeMethod::cubic) {
    high = std::min(std::max<std::size_t>(left + 3, 4), samples_.size());
    low = high < 4 ? 0 : high - 4;
  }
  for (std::size_t j = low; j < high; ++j) {  // Lagrange's polynomial
    double weight = 1;
    for (std::size_t k = low; k < high; ++k)
      if (k != j) weight *= (time - samples_[k].time) / (samples_[j].time - samples_[k].time);
    add(weight, samples_[j].values, to);
  }
}

}  // namespace tess::m2m
