// The limit of a message between two PEs of one process: two threads that pass the turn through an
// atomic, with or without a copy of some bytes. Each calls play() with its side and does nothing
// else meanwhile.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bench {

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

}  // namespace bench
