#include "apps/lb_lab/run/stepped.hpp"

#include "runtime/more/load_measurement.hpp"

namespace lb_lab {

tess::Task Stepped::run() {
  const Plan& plan = experiment_.plan;
  const std::int32_t n = plan.problem.n_iterations;
  tess::BalancerProxy balancer;
  co_await tess::epoch([&] { balancer = create(); });
  co_await begin();
  co_await tess::epoch([&] { stations_.broadcast<&Station::first_begins>(); });
  tess::LoadMeasurement measurement;
  co_await measurement.begin();

  outcome_.began = tess::seconds(tess::now());
  for (std::int32_t t = 0; t < n; ++t) {
    co_await step(t);
    co_await tess::epoch([&] { stations_.broadcast<&Station::iteration_ends>(t); });
    if (plan.sync != Sync::at_period || (t + 1) % plan.period != 0 || t + 1 == n) continue;
    co_await balancer.round();
    const std::int32_t phase = (t + 1) / plan.period - 1;
    co_await tess::epoch([&] { stations_.broadcast<&Station::round_ends>(phase); });
  }
  outcome_.seconds = tess::seconds(tess::now()) - outcome_.began;
  co_await measurement.end(&outcome_.loads);

  co_await end();
  outcome_.answer = co_await stations_.reduce<&Station::give_answer>();
  if (balances(experiment_)) outcome_.rounds = balancer.history();
}

}  // namespace lb_lab
