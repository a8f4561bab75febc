// Several processes, each with the same number of PEs, joined by MPI. Within a process it is the
// threads machine; between processes buffers travel as MPI messages that any PE moves along, one at
// a time under a try-lock: an idle PE whenever it finds nothing to do, a busy one every 30 us.
// There is no dedicated core and nothing blocks. mpi.h is included by the mpi_* files alone:
//
//     mpi             the machine             mpi_transport   buffers out and in, large ones in
//     chunks mpi_session     start, end, agreement   mpi_requests    what MPI has under way
//                                             mpi_mail        what has come, until the program has
//                                             it
#pragma once

#include "runtime/machine/machine.hpp"
#include "runtime/machine/team.hpp"

namespace tess {

struct MpiOptions {
  std::int32_t pes_per_process = 1;  // 0: the process's share of the cores it may use
  Pinning pinning = Pinning::automatic;
  std::size_t chunk_bytes = std::size_t{1} << 30;  // at most; MPI counts with 31 bits
};

/// True if this process was started by mpirun. Asks the environment, not MPI.
[[nodiscard]] bool under_mpirun();

/// True of process 0 under mpirun, and of a process that was started alone: the one that says what
/// a job has to say once, before MPI is there to ask.
[[nodiscard]] bool speaks_for_job();

/// Initialises MPI if nobody has, and then finalises it when destroyed. Every process of the job
/// calls it; the thread that does drives the process's first PE. Throws Error for options that
/// cannot be, or that differ between processes.
[[nodiscard]] std::unique_ptr<Machine> make_mpi_machine(int& argc, char**& argv,
                                                        MpiOptions options);

}  // namespace tess
