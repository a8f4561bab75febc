#include "apps/lb_lab/run/station.hpp"

#include "apps/lb_lab/workload/kernel.hpp"
#include "runtime/core/cpu_clock.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace lb_lab {
namespace {

// Intervals with less between them than this share of the shorter are one: a message's cost is no
// idle time.
constexpr double gap = 0.05;

double& entry(std::vector<double>& values, std::int32_t at, double fill) {
  const auto i = static_cast<std::size_t>(at);
  if (values.size() <= i) values.resize(i + 1, fill);
  return values[i];
}

}  // namespace

Station::Station(Plan plan)
    : plan_(std::move(plan)),
      speed_(plan_.speeds.empty() ? 1 : plan_.speeds[static_cast<std::size_t>(pe().value)]),
      slowness_(plan_.speeds.empty() ? 1 : std::ranges::max(plan_.speeds) / speed_) {
  const double before = clock();
  walked_ = walk(1, 1000);
  fixed_cost_ = tess::machine().virtual_time() && clock() <= before;
}

double Station::clock() const {
  return tess::seconds(tess::now());
}

double Station::cpu() const {
  return tess::machine().virtual_time() ? clock() : tess::thread_cpu_seconds();
}

std::uint64_t Station::work(double seconds, std::uint64_t word) {
  const double here = seconds / speed_;
  if (tess::charge(std::chrono::nanoseconds(std::llround(1e9 * here)))) return word;
  return walk(word, static_cast<std::uint64_t>(here * plan_.steps_a_second));
}

void Station::begins() {
  began_ = clock();
  cpu_at_begin_ = cpu();
}

void Station::ends(std::int32_t iteration) {
  entry(record_.seconds, iteration, 0) += cpu() - cpu_at_begin_;
  draw(iteration, {began_, clock()});
}

void Station::draw(std::int32_t iteration, const Interval& now) {
  if (iteration >= plan_.n_drawn) return;
  if (!record_.busy.empty() && now.begin - record_.busy.back().end < gap * (now.end - now.begin)) {
    record_.busy.back().end = now.end;
  } else {
    record_.busy.push_back(now);
  }
}

void Station::waits(std::int32_t phase) {
  entry(record_.waits_from, phase, -1) = clock();
}

void Station::resumes(std::int32_t phase) {
  double& at = entry(record_.resumes_at, phase, -1);
  if (at < 0) at = clock();
}

void Station::spend(double time) {
  if (!tess::charge(std::chrono::nanoseconds(std::llround(1e9 * time))))
    walked_ = walk(walked_, static_cast<std::uint64_t>(time * plan_.steps_a_second));
}

void Station::worked(double measured_seconds, double nominal_seconds) {
  if (fixed_cost_) {
    spend(nominal_seconds * slowness_);
  } else if (slowness_ > 1) {
    spend(measured_seconds * (slowness_ - 1));
  }
}

void Station::first_begins() {
  began_ = clock();
  busy_at_begin_ = tess::seconds(tess::busy_time());
  cpu_at_begin_ = cpu();
}

void Station::iteration_ends(std::int32_t iteration) {
  const double busy_before = busy_at_begin_, cpu_before = cpu_at_begin_, began = began_;
  first_begins();
  // CPU time includes the search for messages; of what other threads took, busy time may include up
  // to a millisecond.
  const double busy = std::min(busy_at_begin_ - busy_before, cpu_at_begin_ - cpu_before);
  entry(record_.seconds, iteration, 0) += busy;
  draw(iteration, {began, std::min(began + busy, began_)});
}

void Station::round_ends(std::int32_t phase) {
  entry(record_.waits_from, phase, -1) = began_;
  first_begins();
  entry(record_.resumes_at, phase, -1) = began_;
}

void Station::give_record(tess::Callback<std::vector<PeRecord>> target) {
  std::vector<PeRecord> mine;
  mine.push_back(record_);
  contribute(tess::in_order(tess::concatenate), std::move(mine), std::move(target));
}

}  // namespace lb_lab
