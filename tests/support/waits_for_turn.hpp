// Whether work of one thread waits while another thread has a turn.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

namespace tess::test {

/// True if `work`, on another thread, is not done while a `Turn` lives here, and is done after it.
template <class Turn, class Work>
[[nodiscard]] bool waits_for_turn(const Work& work) {
  std::optional<Turn> turn;
  turn.emplace();
  std::atomic<bool> is_done{false};
  std::thread other([&] {
    work();
    is_done = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const bool waited = !is_done;
  turn.reset();
  other.join();
  return waited && is_done;
}

}  // namespace tess::test
