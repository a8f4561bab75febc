// The kind of workload in which the chares are blocks of cells (worker.hpp).
#include "apps/lb_lab/cells/worker.hpp"
#include "apps/lb_lab/run/kind.hpp"
#include "runtime/more/load_measurement.hpp"

#include <fmt/format.h>
#include <utility>

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
  tess::LoadMeasurement measurement;
  co_await measurement.begin();
  co_await tess::epoch([&] { const tess::Task waits = start_and_wait(workers, outcome); });
  co_await measurement.end(&outcome.loads);
  if (balances(experiment)) outcome.rounds = balancer.history();
}

/// The whole domain at once, with two time levels. It shares the next state of a cell with the
/// chares, but no code of blocks, halos, messages or migrations.
std::uint64_t serial_answer_of_cells(const Problem& p) {
  const Workload& workload = workload_of(p);
  const std::int32_t width = p.domain.width, height = p.domain.height;
  const bool looks = workload.traffic == Traffic::neighbours;
  std::vector<std::uint64_t> now(static_cast<std::size_t>(p.domain.n_cells())), next(now.size());
  const auto state = [&](std::int32_t x, std::int32_t y) -> std::uint64_t {
    if (!looks || x < 0 || y < 0 || x >= width || y >= height) return 0;
    return now[p.domain.number({x, y})];
  };
  const auto each = [&](const auto& what) {
    for (std::int32_t y = 0; y < height; ++y)
      for (std::int32_t x = 0; x < width; ++x) what(Cell{x, y}, p.domain.number({x, y}));
  };
  each([&](Cell cell, std::uint64_t i) { now[i] = workload.first(p, cell); });
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    each([&](Cell c, std::uint64_t i) {
      next[i] = workload.next(p, c, t,
                              {now[i], state(c.x - 1, c.y), state(c.x + 1, c.y),
                               state(c.x, c.y - 1), state(c.x, c.y + 1)});
    });
    std::swap(now, next);
  }
  std::uint64_t answer = 0;
  each([&](Cell cell, std::uint64_t i) {
    const std::vector<std::uint64_t> cargo = cargo_of(p, cell);
    answer += answer_of(p, cell, now[i], tess::hash_bytes(cargo.data(), 8 * cargo.size()));
  });
  return answer;
}

double total_seconds_of_cells(const Problem& p) {
  const Block whole{{0, 0}, p.domain.width, p.domain.height};
  double sum = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) sum += block_seconds(p, whole, t);
  return sum;
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
