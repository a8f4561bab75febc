// One run of a scaling study: a scene, a simulated machine, and what a step took there.
#pragma once

#include "apps/collide_scaling/costs.hpp"
#include "runtime/machine/machine.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace collide_scaling {

/// What the simulated clock counts.
enum class Work {
  measured,  ///< the processor time of everything that runs
  model,     ///< a fixed time per message, and one per item of each part: repeats bit for bit
};

struct Case {
  bool is_strong = false;  ///< crowd of `n_triangles`; otherwise `n_triangles` per PE in two planes
  std::uint64_t n_triangles = 65536;
  std::int32_t n_pes = 1;
  std::int32_t steps = 4;   ///< the first makes the voxels, and does not count
  double voxel_size = 0;    ///< 0: chosen
  double gap = 0.2;         ///< one plane is so far above the other
  bool two_owners = false;  ///< per PE, each of every other model: both receive their pairs
  /// Of so many triangles one is there, a square number: the voxels and their messages are the
  /// same, with fewer objects, and an item costs so many times as much.
  std::int32_t thinned = 1;
  std::string balance = "none";
  std::int32_t period = 5;  ///< steps between two rounds of the balancer

  Work work = Work::model;
  SimulatedCosts costs;  ///< Work::model charges them
  std::int32_t message_ns = 580;
  std::int32_t latency_ns = 2000;
  double bandwidth = 4.2e9;
  std::int32_t per_process = 1;
};

/// A step, in seconds since all objects were submitted.
struct StepTimes {
  double seconds = 0;     ///< until the collision is done
  double first_hits = 0;  ///< when the last PE has its first hits: the exchange is over
  double last_hits = 0;   ///< when the last voxel has been searched
  std::uint64_t n_pairs = 0;
};

struct Row {
  Case given;
  StepTimes step;              ///< of each number the median over the steps
  double balance_seconds = 0;  ///< in rounds of the balancer, per step
  std::uint64_t n_moves = 0;
  double voxel_size = 0;
  double wall_seconds = 0;  ///< which the whole run took
};

/// Runs on a simulated machine of its own.
[[nodiscard]] Row run_case(const Case& given);
/// Runs on this machine, which has n_pes PEs. Only process 0 gets the values of the row.
[[nodiscard]] Row run_case(const Case& given, std::unique_ptr<tess::Machine> machine);

}  // namespace collide_scaling
