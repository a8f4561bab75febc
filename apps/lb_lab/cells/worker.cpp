#include "apps/lb_lab/cells/worker.hpp"

#include "runtime/more/monitor.hpp"

#include <utility>

namespace lb_lab {

Worker::Worker(tess::GroupProxy<Station> stations)
    : stations_(stations), patch_(plan().problem, plan().problem.domain.block(index().x)) {}

void Worker::begin(tess::Callback<std::uint64_t> answer) {
  answer_ = std::move(answer);
  array()[index()].send<&Worker::iterate>();
}

std::size_t Worker::send_edges() {
  const Problem& problem = plan().problem;
  if (workload_of(problem).traffic == Traffic::silent) return 0;
  std::size_t n = 0;
  for (const Side side : all_sides) {
    const std::int32_t to = problem.domain.neighbour(index().x, side);
    if (to < 0) continue;
    ++n;
    array()[{to}].send<&Worker::receive>(Edge{iteration_, opposite(side), patch_.edge(side),
                                              std::vector<std::uint8_t>(problem.message_bytes)});
  }
  return n;
}

tess::Task Worker::iterate() {
  for (std::size_t n = send_edges(); n > 0; --n) {
    const Edge edge = co_await edges_.take(iteration_);
    patch_.set_halo(edge.side, edge.states);
  }
  compute();
  go_on();
}

void Worker::compute() {
  Station& here = station();
  here.begins();
  const Problem& problem = plan().problem;
  patch_.advance(problem, iteration_);
  const double seconds = block_seconds(problem, patch_.block(), iteration_);
  patch_.take(here.work(seconds, patch_.word()));
  here.ends(iteration_);
  const std::int32_t columns = problem.domain.columns;
  tess::show_pixel("work of each block (s)", columns, problem.domain.rows, index().x % columns,
                   index().x / columns, seconds);
}

void Worker::go_on() {
  const Plan& all = plan();
  if (++iteration_ == all.problem.n_iterations) {
    contribute(tess::sum, patch_.answer(all.problem), answer_);
    destroy();
  } else if (all.sync == Sync::at_period && iteration_ % all.period == 0) {
    station().waits(iteration_ / all.period - 1);
    at_sync();
  } else {
    array()[index()].send<&Worker::iterate>();
  }
}

void Worker::resume_from_sync() {
  station().resumes(iteration_ / plan().period - 1);
  const tess::Task runs = iterate();
}

std::array<double, 3> Worker::balance_position() const {
  const Block& block = patch_.block();
  return {block.first.x + 0.5 * block.width, block.first.y + 0.5 * block.height, 0};
}

}  // namespace lb_lab
