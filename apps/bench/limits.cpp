#include "apps/bench/limits.hpp"

#include <mpi.h>

#include <chrono>
#include <cstring>
#include <thread>

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

CorePing::CorePing(std::size_t n_bytes)
    : written_{std::vector<std::byte>(n_bytes > 8 ? n_bytes : 0),
               std::vector<std::byte>(n_bytes > 8 ? n_bytes : 0)} {}

double CorePing::play(std::size_t side, std::int64_t n_round_trips) {
  using Clock = std::chrono::steady_clock;
  constexpr unsigned spins_before_yield = 10'000;  // where there are fewer cores than PEs
  const std::int64_t n_warm = 1 + n_round_trips / 10;
  std::vector<std::byte>& mine = written_[side];
  const std::vector<std::byte>& others = written_[1 - side];
  if (side == 1) other_plays_.store(true, std::memory_order_release);
  Clock::time_point from = Clock::now();
  for (std::int64_t i = -n_warm; i < n_round_trips; ++i) {
    if (i == 0) from = Clock::now();
    const std::uint64_t turn = 2 * static_cast<std::uint64_t>(i + n_warm) + side;
    unsigned n_spins = 0;
    // Partner: the store below, by the other side.
    while (turn_.load(std::memory_order_acquire) != turn)
      if (++n_spins % spins_before_yield == 0) std::this_thread::yield();
    if (!mine.empty()) std::memcpy(mine.data(), others.data(), mine.size());
    turn_.store(turn + 1, std::memory_order_release);
  }
  return std::chrono::duration<double, std::nano>(Clock::now() - from).count() /
         (2.0 * static_cast<double>(n_round_trips));
}

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
