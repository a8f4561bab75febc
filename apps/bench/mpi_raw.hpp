// The limit of a message between two processes: only MPI_Isend and MPI_Irecv. Its source is the
// only one of bench that includes mpi.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace bench {

/// Nanoseconds one way between the first and the last process of the job, over so many round trips
/// of so many bytes. All processes call it with the same arguments, while no run is under way; the
/// result is process 0's. MPI is initialised: the machine of a job under mpirun has done so.
double raw_mpi_one_way(std::size_t n_bytes, std::int64_t n_round_trips);

}  // namespace bench
