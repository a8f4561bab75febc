// Runs for a host that is no program of its own, such as an interpreter that calls many times: a
// task on PEs that are threads of this process, also under mpirun and beside a host's own MPI.
//
//     tess::run_hosted(2, [&] { return transfer(job); });  // returns at quiescence
//
// What the task and the chares refer to lives in the host's memory. Threads of the host may call at
// once: their runs take turns. No thread stays pinned, and signals are left to the host.
#pragma once

#include "runtime/run.hpp"

#include <functional>

namespace tess {

/// Runs `main` on PE 0 of `n_pes`. Rethrows what ends it. Throws Error (bad_argument) unless there
/// are 1 to 4096 PEs, (environment) with the lines of the runtime's report if the run ends before
/// the task, or if this process was forked while a run was under way. May not be called inside a
/// run.
void run_hosted(std::int32_t n_pes, const std::function<Task()>& main);

}  // namespace tess
