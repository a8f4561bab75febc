#include "apps/lb_lab/output/draw.hpp"

#include "apps/kit/rows.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace lb_lab {
namespace {

constexpr std::size_t most_rows = 32;     // PEs of a timeline
constexpr std::size_t most_points = 160;  // of a curve: as many as one sees

/// A PE's time in the drawn iterations: its work, rounds on top, idle between.
void draw_pe(std::size_t pe, const PeRecord& record, const std::vector<Interval>& rounds,
             double began, double end, kit::Timeline& timeline) {
  const auto bar = [&](double from, double to, kit::Activity activity) {
    if (from < to) timeline.bars.push_back({pe, from - began, to - began, activity});
  };
  double at = began;
  std::size_t next = 0;
  const auto rest_until = [&](double until) {  // idle, but for rounds
    for (; next < rounds.size() && rounds[next].begin < until; ++next) {
      const double from = std::max(at, rounds[next].begin), to = std::min(until, rounds[next].end);
      if (from >= to) continue;
      bar(at, from, kit::Activity::idle);
      bar(from, to, kit::Activity::balancing);
      at = to;
    }
    bar(at, until, kit::Activity::idle);
    at = std::max(at, until);
  };
  for (const Interval& busy : record.busy) {
    if (next > 0) --next;  // a round may reach over several intervals
    rest_until(busy.begin);
    bar(std::max(at, busy.begin), busy.end, kit::Activity::busy);
    at = std::max(at, busy.end);
  }
  if (next > 0) --next;
  rest_until(end);
}

/// Means over as many iterations each as it takes.
kit::Series curve_of(const Row& row) {
  kit::Series curve{.name = row.strategy, .style = kit::Style::lines};
  const std::vector<double>& values = row.imbalance_of_iteration;
  const std::size_t window = (values.size() + most_points - 1) / most_points;
  for (std::size_t first = 0; first < values.size(); first += window) {
    const std::size_t n = std::min(window, values.size() - first);
    double sum = 0;
    for (std::size_t t = first; t < first + n; ++t) sum += values[t];
    const auto count = static_cast<double>(n);
    curve.points.push_back({static_cast<double>(first) + (count - 1) / 2, sum / count});
  }
  return curve;
}

kit::Timeline timeline_of(const Outcome& outcome, const Row& row) {
  kit::Timeline timeline;
  const std::size_t n = std::min(most_rows, outcome.records.size());
  timeline.title = fmt::format(
      "{}, {} chares per PE, {}: the first iterations{}", row.workload, row.per_pe, row.strategy,
      n < outcome.records.size() ? fmt::format(", {} of {} PEs", n, outcome.records.size()) : "");
  const std::vector<std::vector<Interval>> rounds = balancing_times(outcome);
  double end = outcome.began;
  for (const PeRecord& record : outcome.records)
    if (!record.busy.empty()) end = std::max(end, record.busy.back().end);
  for (std::size_t pe = 0; pe < n; ++pe) {
    timeline.rows.push_back(fmt::format("PE {}", pe));
    draw_pe(pe, outcome.records[pe], rounds[pe], outcome.began, end, timeline);
  }
  return timeline;
}

}  // namespace

void Drawings::add(const Outcome& outcome, const Row& row) {
  runs_.push_back({row, timeline_of(outcome, row)});
}

void Drawings::write(const std::string& directory) const {
  const auto path = [&](const std::string& name) {
    return fmt::format("{}/{}-{}.svg", directory, workload_, name);
  };
  const auto faster = [](const Run& a, const Run& b) {
    return a.row.seconds_total < b.row.seconds_total;
  };
  const Run& best = *std::ranges::min_element(runs_, faster);

  kit::Chart time{
      .title = fmt::format("{} on {} PEs: the same work in more chares", workload_, best.row.n_pes),
      .x_label = "chares per PE",
      .y_label = "ms per iteration",
      .x_log = true};
  kit::Chart balance{.title = fmt::format("{} on {} PEs, {} chares per PE", workload_,
                                          best.row.n_pes, best.row.per_pe),
                     .x_label = "iteration",
                     .y_label = "max/average"};
  const Run* drawn = nullptr;  // the fastest that was balanced at the best cut
  for (const Run& run : runs_) {
    const Row& row = run.row;
    const double per_pe = row.per_pe;
    if (kit::Point* const point =
            kit::add_point(time, row.strategy, per_pe, 1e3 * row.seconds_total / row.n_iterations))
      point->high = 1e3 * std::ranges::max(row.seconds_of_runs) / row.n_iterations;
    if (std::ranges::count(time.x_ticks, per_pe) == 0) time.x_ticks.push_back(per_pe);
    if (row.per_pe != best.row.per_pe) continue;
    balance.series.push_back(curve_of(row));
    if (row.strategy == "none") {
      kit::write_svg(path("timeline-none"), run.timeline);
    } else if (drawn == nullptr || faster(run, *drawn)) {
      drawn = &run;
    }
  }
  kit::write_svg(path("time"), time);
  kit::write_svg(path("imbalance"), balance);
  if (drawn != nullptr) kit::write_svg(path("timeline-" + drawn->row.strategy), drawn->timeline);
}

}  // namespace lb_lab
