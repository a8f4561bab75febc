#include "apps/lb_lab/cells/cells.hpp"

#include "apps/lb_lab/cells/worker.hpp"
#include "apps/lb_lab/run/balanced.hpp"
#include "apps/lb_lab/workload/serial.hpp"

#include <fmt/format.h>

namespace lb_lab {
namespace {

tess::Task start_and_wait(tess::ArrayProxy<Worker> workers, Outcome& outcome) {
  const tess::Time began = tess::now();
  outcome.began = tess::seconds(began);
  outcome.answer = co_await workers.reduce<&Worker::begin>();
  outcome.seconds = tess::seconds(tess::now() - began);
}

tess::Task run_cells(const Experiment& experiment, tess::GroupProxy<Station> stations,
                     Outcome& outcome) {
  tess::ArrayProxy<Worker> workers;
  tess::BalancerProxy balancer;
  co_await tess::epoch([&] {
    const std::int32_t n = experiment.plan.problem.domain.n_elements();
    workers = tess::create<Worker>(tess::range(n), stations);
    if (balances(experiment)) balancer = start_balancing(workers, experiment, outcome);
  });
  co_await tess::epoch([&] { const tess::Task waits = start_and_wait(workers, outcome); });
  if (balances(experiment)) outcome.rounds = balancer.history();
}

std::string describe_cells(const Problem& p) {
  return fmt::format(
      "{} x {} cells of {} bytes; {}", p.domain.width, p.domain.height, p.cell_bytes,
      workload_of(p).traffic == Traffic::silent
          ? "elements are independent: no messages between them"
          : fmt::format("edges and {} bytes to each neighbour per iteration", p.message_bytes));
}

}  // namespace

const Kind cells_kind{Speeds::given, &serial_answer_of_cells, &total_seconds_of_cells,
                      &describe_cells, &run_cells};

}  // namespace lb_lab
