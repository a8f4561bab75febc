// One run of a scaling study: a scene, a simulated machine, and what a step took there.
#pragma once

#include <cstdint>
#include <string>

namespace collide_scaling {

/// What the simulated clock counts.
enum class Work {
  measured,  ///< the processor time of everything that runs
  model,     ///< a fixed time per message, and per pair a measured one: repeats bit for bit
};

struct Case {
  bool is_strong = false;  ///< crowd of `n_triangles`; otherwise `n_triangles` per PE in two planes
  std::uint64_t n_triangles = 65536;
  std::int32_t n_pes = 1;
  std::int32_t steps = 4;  ///< the first makes the voxels, and does not count
  double voxel_size = 0;   ///< 0: chosen
  /// Of so many triangles one is there, a square number: the voxels and their messages are the
  /// same, with fewer objects, and a pair costs so many times as much.
  std::int32_t thinned = 1;
  std::string balance = "none";
  std::int32_t period = 5;  ///< steps between two rounds of the balancer

  Work work = Work::model;
  double ns_per_pair = 0;  ///< of Work::model
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
  double searched = 0;    ///< time in the longest search of a PE, Work::model
  std::uint64_t n_pairs = 0;
};

struct Row {
  Case given;
  StepTimes step;              ///< of each number the median over the steps
  double balance_seconds = 0;  ///< in rounds of the balancer, per step
  std::uint64_t n_moves = 0;
  double voxel_size = 0;
  std::uint64_t n_voxels = 0;  ///< of all PEs, that were searched
  double wall_seconds = 0;     ///< of the simulation
};

/// Runs on a simulated machine of its own.
[[nodiscard]] Row run_case(const Case& given);

}  // namespace collide_scaling
