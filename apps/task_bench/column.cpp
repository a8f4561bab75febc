#include "apps/task_bench/column.hpp"

#include <cstdio>
#include <fmt/format.h>

namespace task_bench {
namespace {

/// Ends the run: an input is not what the graph says.
void fail(const std::string& what) {
  std::fprintf(stderr, "task_bench: wrong input: %s\n", what.c_str());
  tess::exit(1);
}

}  // namespace

Column::Column(const Graph& graph)
    : graph_(graph),
      inputs_(graph, index().x),
      scratch_(static_cast<std::size_t>(
          graph.kernel.type == KernelType::memory_bound ? graph.kernel.scratch_bytes : 0)) {}

void Column::begin(const Run& run) {
  run_ = run;
  graph_.kernel.iterations = run.iterations;
  count_ = {};
  synced_ = 0;
  runs_ = true;
  advance();
}

void Column::take(Output output) {
  if (!inputs_.put(output)) [[unlikely]] {
    fail(inputs_.complaint(output));
    return;
  }
  if (runs_ && inputs_.complete()) advance();
}

void Column::take_all(const std::vector<Output>& output) {
  for (const Output& one : output) {
    if (one == output.front()) continue;
    fail(inputs_.complaint(one));
    return;
  }
  take(output.front());
}

void Column::go_on() {
  run_task();
  advance();
}

void Column::resume_from_sync() {
  synced_ = inputs_.step();
  advance();
}

void Column::advance() {
  for (;;) {
    const std::int64_t step = inputs_.step();
    if (step == graph_.steps) {
      finish();
      return;
    }
    if (run_.sync_every != 0 && step != synced_ && step % run_.sync_every == 0) {
      runs_ = false;  // what arrives meanwhile waits
      at_sync();
      return;
    }
    runs_ = true;
    if (inputs_.varies() && !points_at(graph_, step).contains(index().x)) {
      inputs_.advance();
      continue;
    }
    if (!inputs_.complete()) return;
    if (inputs_.needs_no_other()) {
      runs_ = false;  // until its own message
      array()[index()].send<&Column::go_on>();
      return;
    }
    run_task();
  }
}

void Column::run_task() {
  const std::int64_t step = inputs_.step();
  if (!inputs_.right()) [[unlikely]] {
    fail(fmt::format("step {}, point {}: an input is not the output of its dependence", step,
                     index().x));
    return;
  }
  ++count_.n_tasks;
  count_.n_inputs += static_cast<std::uint64_t>(inputs_.n_needed());
  const Kernel& kernel = graph_.kernel;
  const std::int64_t iterations = iterations_of(kernel, graph_.number, step, index().x);
  if (run_.virtual_time != 0) {
    (void)tess::charge(std::chrono::nanoseconds(virtual_nanoseconds(kernel, iterations)));
  } else {
    execute(kernel, iterations, step, scratch_);
  }
  Output output{step, index().x};
  if (output == run_.spoiled) [[unlikely]]
    ++output.point;
  if (step + 1 < graph_.steps) hand_on(output);
  inputs_.advance();
  if (inputs_.step() < graph_.steps && inputs_.needs_itself() && !inputs_.put(output))
    fail(inputs_.complaint(output));
}

void Column::hand_on(const Output& output) {
  const Points next =
      inputs_.varies() ? points_at(graph_, output.step + 1) : Points{0, graph_.width};
  const auto columns = array();
  const std::int32_t me = index().x;
  const auto n = static_cast<std::size_t>((graph_.output_bytes + 15) / 16);
  for (const std::int32_t point : inputs_.consumers()) {
    if (point == me || !next.contains(point)) continue;
    if (n == 1) {
      columns[{point}].send<&Column::take>(output);
    } else {
      columns[{point}].send<&Column::take_all>(std::vector<Output>(n, output));
    }
  }
}

void Column::finish() {
  runs_ = false;
  inputs_.rewind();
  contribute(AddCounts{}, count_, run_.done);
}

}  // namespace task_bench
