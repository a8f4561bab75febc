#include "apps/lb_lab/run/experiment.hpp"

#include "apps/lb_lab/run/kind.hpp"
#include "runtime/balance/strategy.hpp"

#include <algorithm>

namespace lb_lab {
namespace {

double speed_of(const Plan& plan, std::size_t pe) {
  return plan.speeds.empty() ? 1 : plan.speeds[pe];
}

}  // namespace

tess::balance::Strategy noting(const tess::BalanceOptions& options,
                               std::vector<tess::balance::Phase>& phases) {
  return [named = tess::balance::make_strategy(options.strategy, options.seed),
          &phases](const tess::balance::Snapshot& snapshot) {
    phases.push_back({phases.size(), snapshot});
    return named(snapshot);
  };
}

tess::Task run(const Experiment& experiment, Outcome& outcome) {
  tess::GroupProxy<Station> stations;
  co_await tess::epoch([&] { stations = tess::create<Station>(tess::each_pe, experiment.plan); });
  co_await workload_of(experiment.plan.problem).kind->run(experiment, stations, outcome);
  outcome.records = co_await stations.reduce<&Station::give_record>();
  for (std::size_t pe = 0; pe < outcome.loads.size(); ++pe)
    outcome.loads[pe].speed = speed_of(experiment.plan, pe);
}

double imbalance(const Outcome& outcome, const Plan& plan, std::int32_t first, std::int32_t last) {
  double slowest = 0, average = 0;
  for (std::int32_t t = first; t < last; ++t) {
    double most = 0, work = 0, speed = 0;
    for (std::size_t pe = 0; pe < outcome.records.size(); ++pe) {
      const std::vector<double>& mine = outcome.records[pe].seconds;
      const auto at = static_cast<std::size_t>(t);
      const double time = at < mine.size() ? mine[at] : 0;
      most = std::max(most, time);
      work += time * speed_of(plan, pe);
      speed += speed_of(plan, pe);
    }
    slowest += most;
    average += work / speed;
  }
  return average > 0 ? slowest / average : 1;
}

double ideal_seconds(const Outcome& outcome, const Plan& plan) {
  double work = 0, speed = 0;
  for (std::size_t pe = 0; pe < outcome.records.size(); ++pe) {
    for (const double time : outcome.records[pe].seconds) work += time * speed_of(plan, pe);
    speed += speed_of(plan, pe);
  }
  return work / speed;
}

std::vector<std::vector<Interval>> balancing_times(const Outcome& outcome) {
  std::vector<std::vector<Interval>> times(outcome.records.size());
  std::size_t n_phases = 0;
  for (const PeRecord& record : outcome.records)
    n_phases = std::max(n_phases, record.waits_from.size());
  if (n_phases == 0) {
    double end = outcome.began;
    for (const tess::balance::Round& round : outcome.rounds) {
      const double begin = end + round.phase_seconds;
      end = begin + round.round_seconds;
      for (std::vector<Interval>& mine : times) mine.push_back({begin, end});
    }
    return times;
  }
  for (std::size_t phase = 0; phase < n_phases; ++phase) {
    double begin = 0;
    for (const PeRecord& record : outcome.records)
      if (phase < record.waits_from.size()) begin = std::max(begin, record.waits_from[phase]);
    for (std::size_t pe = 0; pe < times.size(); ++pe) {
      const std::vector<double>& resumes = outcome.records[pe].resumes_at;
      if (phase < resumes.size() && resumes[phase] > begin)
        times[pe].push_back({begin, resumes[phase]});
    }
  }
  return times;
}

}  // namespace lb_lab
