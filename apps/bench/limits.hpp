// The limits of messages, without a runtime: a cache line and a copy between two threads, and MPI
// between two processes.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bench {

/// Two threads that pass the turn through an atomic, with or without a copy of some bytes. Each
/// calls play() with its side and does nothing else meanwhile.
class CorePing {
 public:
  /// With `n_bytes` above 8 each turn copies so many from the buffer that the other side wrote.
  explicit CorePing(std::size_t n_bytes);

  /// True once side 1 plays. Side 0 waits for that before it plays, without blocking: the message
  /// that calls the other side may still be in a buffer of its own PE.
  [[nodiscard]] bool other_plays() const { return other_plays_.load(std::memory_order_acquire); }

  /// Nanoseconds one way, over so many round trips. Both sides (0 and 1) call it once,
  /// with one count.
  double play(std::size_t side, std::int64_t n_round_trips);

 private:
  std::atomic<bool> other_plays_{false};  // acquire above, release in play()
  alignas(64) std::atomic<std::uint64_t> turn_{0};
  alignas(64) std::array<std::vector<std::byte>, 2> written_;
};

/// Nanoseconds one way between the first and the last process of the job, by MPI_Isend and
/// MPI_Irecv only, over so many round trips of so many bytes. All processes call it with the same arguments,
/// while no run is under way; the result is process 0's. MPI is initialised: the machine of a job
/// under mpirun has done so.
double raw_mpi_one_way(std::size_t n_bytes, std::int64_t n_round_trips);

}  // namespace bench
