#include "runtime/base/try_lock.hpp"

#include "tests/support/catch.hpp"

#include <mutex>
#include <thread>
#include <vector>

namespace tess::detail {
namespace {

TEST_CASE("a try-lock that is held is refused, and given again once it is free",
          "[runtime][base]") {
  TryLock lock;
  REQUIRE(lock.try_lock());
  CHECK_FALSE(lock.try_lock());
  lock.unlock();
  CHECK(lock.try_lock());
  lock.unlock();
}

// A plain counter: two holders at once lose counts, and the thread sanitizer sees the race.
TEST_CASE("one thread at a time holds a try-lock", "[runtime][base]") {
  constexpr int n_threads = 4;
  constexpr int n_tries = 20'000;
  TryLock lock;
  std::int64_t n_guarded = 0;
  std::atomic<std::int64_t> n_held{0};
  {
    std::vector<std::jthread> threads;
    for (int k = 0; k < n_threads; ++k)
      threads.emplace_back([&] {
        for (int i = 0; i < n_tries; ++i) {
          const std::unique_lock held(lock, std::try_to_lock);
          if (!held) continue;
          ++n_guarded;
          n_held.fetch_add(1, std::memory_order_relaxed);
        }
      });
  }
  CHECK(n_guarded == n_held);
  CHECK(n_guarded > 0);
}

}  // namespace
}  // namespace tess::detail
