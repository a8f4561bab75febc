// The task graphs of Task Bench (Slaughter et al., SC20): a grid of steps × points, in which the
// task (t, p) needs the outputs of some tasks of step t - 1. No messages here.
//
//     trivial              no inputs
//     no_comm              p
//     stencil_1d           p - 1, p, p + 1
//     stencil_1d_periodic  the same, on a ring
//     dom                  p - 1, p; a band of points
//     tree                 p / 2; twice as many points each step
//     fft                  p, p ± 2^k
//     all_to_all           all points
//     nearest              radix points around p
//     spread               radix points, far apart
//     random_nearest       some of the nearest, at random
//
// Which points a task needs is a function of its dependence set. A graph has few sets: fft has one
// per stage, spread and random_nearest have one per step of their period. The random edges are
// drawn by our own hash: they have the statistics of the original's, but are not the same edges.
#pragma once

#include "apps/task_bench/kernel.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace task_bench {

enum class Type : std::uint8_t {
  trivial,
  no_comm,
  stencil_1d,
  stencil_1d_periodic,
  dom,
  tree,
  fft,
  all_to_all,
  nearest,
  spread,
  random_nearest,
};

/// In the order of Type.
[[nodiscard]] const std::vector<std::string>& type_names();
[[nodiscard]] const std::string& name_of(Type type);
/// Throws tess::Error that lists the names for any other.
[[nodiscard]] Type parse_type(std::string_view name);
[[nodiscard]] bool has_period(Type type);

struct Graph {
  std::int32_t number = 0;  ///< among those that run at once
  Type type = Type::trivial;
  std::int64_t steps = 4;
  std::int32_t width = 4;
  std::int32_t radix = 3;   ///< of nearest, spread, random_nearest
  std::int32_t period = 0;  ///< of spread, random_nearest
  double fraction = 0.25;   ///< of random_nearest: edges that are there
  Kernel kernel;
  std::int64_t output_bytes = 16;
};

/// Points first … end - 1.
struct Points {
  std::int32_t first = 0;
  std::int32_t end = 0;
  [[nodiscard]] bool contains(std::int32_t point) const { return first <= point && point < end; }
};

/// The points that have a task at a step; none before the first.
[[nodiscard]] Points points_at(const Graph& graph, std::int64_t step);

[[nodiscard]] std::int32_t n_sets(const Graph& graph);
/// The dependence set from which the tasks of a step find their inputs in step - 1.
[[nodiscard]] std::int32_t set_at(const Graph& graph, std::int64_t step);

/// The points whose outputs a point needs; ascending. Those without a task at the step before are
/// among them.
[[nodiscard]] std::vector<std::int32_t> dependences(const Graph& graph, std::int32_t set,
                                                    std::int32_t point);
/// The points that need the output of a point: the inverse of dependences().
[[nodiscard]] std::vector<std::int32_t> dependents(const Graph& graph, std::int32_t set,
                                                   std::int32_t point);

/// The totals of a whole graph.
struct Totals {
  std::uint64_t n_tasks = 0;
  std::uint64_t n_dependences = 0;
  std::uint64_t n_iterations = 0;  ///< of the kernel
};
[[nodiscard]] Totals totals(const Graph& graph);

/// Throws tess::Error if the options of a graph are inconsistent.
void validate(const Graph& graph);

}  // namespace task_bench
