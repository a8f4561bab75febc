// The thread of a service: it runs functions when they are due and when a signal arrives, one after
// the other, each under the mutex of its owner. It sleeps on a POSIX semaphore, the one thing that
// a signal handler may post to. It is started by the first function or signal.
//
//     at(), soon(), set()  ──► due_ ──┐
//     signal handler ──► counts ──────┴─► semaphore ──► thread: lock, signals, what is due, sleep
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <semaphore.h>
#include <span>
#include <thread>
#include <utility>

namespace tess::detail {

class Timekeeper {
 public:
  using Clock = std::chrono::steady_clock;
  /// Holds at most one function: each set() replaces the one before.
  struct Timer {
    std::uint64_t n_set = 0;
  };

  /// All functions run under `mutex`, and all members but the destructor are called under it.
  explicit Timekeeper(std::mutex& mutex);
  Timekeeper(const Timekeeper&) = delete;
  Timekeeper& operator=(const Timekeeper&) = delete;
  /// Ends the thread; what is not due yet is dropped. Gives the signals back.
  ~Timekeeper();

  void soon(std::function<void()> run) { at(Clock::time_point::min(), std::move(run)); }
  void set(Timer& timer, Clock::time_point due, std::function<void()> run);
  /// Takes those of the signals that have the system's default action. One Timekeeper of a process
  /// has signals at a time.
  void take_signals(std::span<const int> signals, std::function<void(int)> arrived);
  [[nodiscard]] bool started() const { return thread_.joinable(); }

 private:
  void at(Clock::time_point due, std::function<void()> run);
  void start();
  void keep_time();
  void sleep_until(Clock::time_point due);

  std::mutex& mutex_;
  sem_t bell_{};
  std::multimap<Clock::time_point, std::function<void()>> due_;
  std::function<void(int)> arrived_;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace tess::detail
