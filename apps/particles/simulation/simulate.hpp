// One run of a scene on the runtime: fields are built, particles sent to their blocks, and moved
// stretch by stretch, each closed by an epoch. Except for times, the result does not depend on PEs,
// processes, blocks or schedule.
#pragma once

#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/station.hpp"
#include "runtime/balance.hpp"
#include "runtime/runtime.hpp"

#include <vector>

namespace particles {

/// The measures after so many steps.
struct Row {
  std::int32_t step = 0;
  double time = 0;
  Measured measured;
};

/// The traced particles after so many steps, in the order of ids.
struct Snapshot {
  std::int32_t step = 0;
  std::vector<Sample> samples;
};

/// All fields of a run together.
struct FieldCost {
  double build_seconds = 0;            ///< of the slowest; they are built at the same time
  std::uint64_t cells = 0, bytes = 0;  ///< of the flat field
  std::uint64_t bytes_used = 0;        ///< of the compressed one, if the run uses it
};

struct RunResult {
  std::vector<Row> rows;  ///< the first before the first step, the last after the last
  std::vector<Snapshot> trajectories;
  FieldCost fields;
  double seconds = 0;         ///< of all steps with exchanges and audit, without measuring
  double loop_seconds = 0;    ///< CPU in the step loops, summed over PEs
  double audit_seconds = 0;   ///< CPU in the audit, summed over PEs
  std::uint64_t audited = 0;  ///< particles
  double block = 0;
  std::int32_t exchange = 0;
  std::vector<tess::balance::Round> rounds;  ///< of the balancer, if there is one
};

/// True if the trajectories have the particles after so many steps.
[[nodiscard]] bool traces(const Scene& scene, std::int32_t step);

/// Refuses a scene whose fields, which each process builds, and particles, which the processes
/// share, are larger than the memory that this process may have. Throws Error(environment).
void check_memory(const Scene& scene, int n_processes);

/// Runs the scene from PE 0. `stage`: of this process; holds the fields afterwards.
tess::Task simulate(std::shared_ptr<Stage> stage, RunResult& result, RunOptions options = {});

}  // namespace particles
