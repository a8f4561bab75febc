// What MPI alone takes for 8 bytes one way between two processes: the floor under ping_pong. The
// one program outside the mpi machine that calls MPI, to have nothing of ours in the figure.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, n = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  if (n != 2) {
    if (rank == 0)
      std::fprintf(stderr, "bench_mpi_raw: error: %d processes: start it by mpirun -n 2\n", n);
    MPI_Finalize();
    return 2;
  }
  constexpr std::int64_t rounds = 100'000;
  std::array<double, 5> samples{};
  bool right = true;
  for (double& sample : samples) {
    std::int64_t ball = 0;
    const double begin = MPI_Wtime();
    for (std::int64_t i = 0; i < rounds; ++i) {
      if (rank == 0) MPI_Send(&ball, 1, MPI_INT64_T, 1, 0, MPI_COMM_WORLD);
      MPI_Recv(&ball, 1, MPI_INT64_T, 1 - rank, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      ++ball;
      if (rank == 1) MPI_Send(&ball, 1, MPI_INT64_T, 0, 0, MPI_COMM_WORLD);
    }
    sample = (MPI_Wtime() - begin) * 1e9 / (2.0 * rounds);
    right = right && ball == 2 * rounds - (rank == 1 ? 1 : 0);
  }
  std::sort(samples.begin(), samples.end());
  const double median = samples[samples.size() / 2];
  if (rank == 0 && right)
    std::printf(
        "raw MPI one way 8 bytes between processes,%.1f,ns,%.1f,%.2f,,,mpi: 2 processes,,\n",
        median,
        samples.front(),
        (samples.back() - samples.front()) / median);
  MPI_Finalize();
  return right ? 0 : 1;
}
