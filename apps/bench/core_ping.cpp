#include "apps/bench/core_ping.hpp"

#include <chrono>
#include <cstring>
#include <thread>

namespace bench {

CorePing::CorePing(std::size_t n_bytes)
    : written_{std::vector<std::byte>(n_bytes > 8 ? n_bytes : 0),
               std::vector<std::byte>(n_bytes > 8 ? n_bytes : 0)} {}

double CorePing::play(std::size_t side, std::int64_t n_round_trips) {
  using Clock = std::chrono::steady_clock;
  constexpr unsigned spins_before_yield = 10'000;  // where there are fewer cores than PEs
  const std::int64_t n_warm = 1 + n_round_trips / 10;
  std::vector<std::byte>& mine = written_[side];
  const std::vector<std::byte>& others = written_[1 - side];
  const std::uint64_t began = turn_.load(std::memory_order_acquire) & ~std::uint64_t{1};
  Clock::time_point from = Clock::now();
  for (std::int64_t i = -n_warm; i < n_round_trips; ++i) {
    if (i == 0) from = Clock::now();
    const std::uint64_t turn = began + 2 * static_cast<std::uint64_t>(i + n_warm) + side;
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

}  // namespace bench
