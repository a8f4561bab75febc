// One point of a task graph through all steps: a chare. It runs the task of a step when the last
// input arrives, and sends the output to the points that need it. A task without inputs from other
// points is started by a message of the column to itself, so that each task is scheduled.
//
//     begin -> [ take … take -> run -> take of the consumers ]*  -> contribute
//
// With a balancer every column waits at the barrier once per so many steps.
#pragma once

#include "apps/task_bench/inputs.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace task_bench {

/// The totals of the tasks of a run or of one column.
struct Count {
  std::uint64_t n_tasks = 0;
  std::uint64_t n_inputs = 0;  ///< each held against its dependence
};
struct AddCounts {
  Count operator()(Count a, const Count& b) const {
    return {a.n_tasks + b.n_tasks, a.n_inputs + b.n_inputs};
  }
};

/// One run of a graph.
struct Run {
  std::int64_t iterations = 0;    ///< of the kernel
  std::int64_t sync_every = 0;    ///< steps between barriers; 0: none
  Output spoiled{-1, -1};         ///< a task that hands on a wrong output: to see it found
  std::uint8_t virtual_time = 0;  ///< the kernel is charged, not run
  tess::Callback<Count> done;
};

class Column final : public tess::Chare<Column, tess::Index1> {
 public:
  Column() = default;
  explicit Column(const Graph& graph);

  // Entry methods.
  void begin(const Run& run);
  void take(Output output);
  void take_all(const std::vector<Output>& output);
  void go_on();
  void resume_from_sync();

  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(graph_, run_, inputs_, count_, synced_, runs_, scratch_);
  }

 private:
  void advance();
  void run_task();
  void hand_on(const Output& output);
  void finish();

  Graph graph_;
  Run run_;
  Inputs inputs_;
  Count count_;
  std::int64_t synced_ = 0;  // the step of the last barrier
  bool runs_ = false;
  std::vector<std::byte> scratch_;
};

}  // namespace task_bench
