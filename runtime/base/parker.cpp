#include "runtime/base/parker.hpp"

#include <ctime>
#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tess::detail {
namespace {

static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));

/// A futex, since atomic::wait has no time limit.
void futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value, timespec* limit) {
  syscall(SYS_futex, &word, operation, value, limit, nullptr, 0);
}

}  // namespace

void Parker::sleep(std::chrono::nanoseconds limit) noexcept {
  timespec span{};
  if (limit != forever) {
    span.tv_sec = static_cast<time_t>(limit.count() / 1'000'000'000);
    span.tv_nsec = static_cast<long>(limit.count() % 1'000'000'000);
  }
  // The kernel compares with `asleep` under its lock: a wake() before that makes this return.
  futex(state_, FUTEX_WAIT_PRIVATE, asleep, limit == forever ? nullptr : &span);
}

void Parker::rouse() noexcept {
  futex(state_, FUTEX_WAKE_PRIVATE, 1, nullptr);
}

}  // namespace tess::detail
