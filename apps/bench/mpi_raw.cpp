#include "apps/bench/mpi_raw.hpp"

#include <mpi.h>

#include <vector>

namespace bench {
namespace {

void send(std::vector<std::byte>& bytes, int to) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD,
            &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
}

void receive(std::vector<std::byte>& bytes, int from) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, from, 0, MPI_COMM_WORLD,
            &request);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
}

}  // namespace

double raw_mpi_one_way(std::size_t n_bytes, std::int64_t n_round_trips) {
  int rank = 0, n = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  std::vector<std::byte> ball(n_bytes);  // what came is sent back, as elements do
  const std::int64_t n_warm = 1 + n_round_trips / 10;
  double from = 0, to = 0;
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) {
    for (std::int64_t i = -n_warm; i < n_round_trips; ++i) {
      if (i == 0) from = MPI_Wtime();
      send(ball, n - 1);
      receive(ball, n - 1);
    }
    to = MPI_Wtime();
  } else if (rank == n - 1) {
    for (std::int64_t i = -n_warm; i < n_round_trips; ++i) {
      receive(ball, 0);
      send(ball, 0);
    }
  }
  MPI_Barrier(MPI_COMM_WORLD);
  return (to - from) * 1e9 / (2.0 * static_cast<double>(n_round_trips));
}

}  // namespace bench
