// Several processes with the same number of PEs each, connected by MPI. Within a process it works
// like the threads machine. Between processes buffers travel as MPI messages; any PE makes them
// progress, one PE at a time under a try-lock: an idle PE whenever it finds no work, a busy one
// every 30 us. There is no dedicated core, and nothing blocks. Only the mpi_* files include mpi.h:
//
//     mpi             the machine
//     mpi_session     start, end and agreement
//     mpi_transport   buffers to and from other processes, large ones in chunks
//     mpi_requests    MPI requests under way
//     mpi_mail        received buffers until the program takes them
#pragma once

#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/machine/team.hpp"

#include <string>

namespace tess::detail {

struct MpiOptions {
  std::int32_t pes_per_process = 1;  // 0: the process's share of the cores that it may use
  bool refuses = false;              // it only takes part until the others know; pes_per_process 0
  Pinning pinning = Pinning::automatic;
  std::size_t chunk_bytes = std::size_t{1} << 30;  // largest chunk; MPI counts with 31 bits
};

/// True if mpirun started this process. Reads the environment, not MPI.
[[nodiscard]] bool under_mpirun();

/// The number of processes that mpirun or srun started, by the environment; 1 for a process that
/// was started alone, and 0 if it is not known.
[[nodiscard]] int processes_of_job();

/// "Open MPI 4.1.4": the library that is loaded; "no MPI" where Tessera is built without it.
[[nodiscard]] std::string mpi_version();

/// True between MPI_Init and MPI_Finalize of the program: a run then uses its processes, through a
/// communicator of its own.
[[nodiscard]] bool program_owns_mpi();

/// True for process 0 under mpirun, and for a process that was started alone: this process prints
/// what a job prints once, before MPI is initialised.
[[nodiscard]] bool speaks_for_job();

/// Initialises MPI, and finalises it when destroyed. If the program has initialised MPI, it remains
/// the program's: the machine communicates through duplicates of MPI_COMM_WORLD, which later
/// machines use again and which are freed when MPI ends, and several machines may follow one
/// another. Every process of the job calls it; the calling thread drives the process's first PE.
/// Throws Error for options that are invalid or that differ between processes.
[[nodiscard]] std::unique_ptr<Machine> make_mpi_machine(int& argc, char**& argv,
                                                        MpiOptions options);

}  // namespace tess::detail

namespace tess {

using detail::make_mpi_machine;
using detail::MpiOptions;
using detail::processes_of_job;
using detail::program_owns_mpi;
using detail::speaks_for_job;
using detail::under_mpirun;

}  // namespace tess
