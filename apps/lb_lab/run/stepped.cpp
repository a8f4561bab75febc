#include "apps/lb_lab/run/stepped.hpp"

namespace lb_lab {

tess::Task run_stepped(const Experiment& experiment, tess::GroupProxy<Station> stations,
                       Stepped& workload, Outcome& outcome) {
  const Plan& plan = experiment.plan;
  const std::int32_t n = plan.problem.n_iterations;
  tess::BalancerProxy balancer;
  co_await tess::epoch([&] { balancer = workload.create(); });
  co_await workload.begin();
  co_await tess::epoch([&] { stations.broadcast<&Station::first_begins>(); });

  outcome.began = tess::seconds(tess::now());
  for (std::int32_t t = 0; t < n; ++t) {
    co_await workload.step(t);
    co_await tess::epoch([&] { stations.broadcast<&Station::iteration_ends>(t); });
    if (plan.sync != Sync::at_period || (t + 1) % plan.period != 0 || t + 1 == n) continue;
    co_await balancer.round();
    const std::int32_t phase = (t + 1) / plan.period - 1;
    co_await tess::epoch([&] { stations.broadcast<&Station::round_ends>(phase); });
  }
  outcome.seconds = tess::seconds(tess::now()) - outcome.began;

  co_await workload.end();
  outcome.answer = co_await stations.reduce<&Station::give_answer>();
  if (balances(experiment)) outcome.rounds = balancer.history();
}

}  // namespace lb_lab
