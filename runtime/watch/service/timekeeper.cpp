#include "runtime/watch/service/timekeeper.hpp"

#include "runtime/core/check.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>

namespace tess::detail {
namespace {

/// What the handler reaches: a signal belongs to the process, so this does, too. Each signal is
/// counted, since a second one means more than the first.
constexpr int n_signals = 32;
std::array<std::atomic<int>, n_signals> arrived_signals{};
std::atomic<sem_t*> bell_of_signals{nullptr};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<sem_t*>::is_always_lock_free);

void count_signal(int signal) {
  const int error = errno;
  arrived_signals[static_cast<std::size_t>(signal)].fetch_add(1);
  if (sem_t* const bell = bell_of_signals.load()) sem_post(bell);
  errno = error;
}

void set_handler(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // system calls of the program go on
  sigaction(signal, &action, nullptr);
}

bool has_default_action(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_DFL;
}

bool is_taken(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == &count_signal;
}

}  // namespace

Timekeeper::Timekeeper(std::mutex& mutex) : mutex_(mutex) {
  sem_init(&bell_, 0, 0);
}

Timekeeper::~Timekeeper() {
  if (bell_of_signals.load() == &bell_) {
    // Between two runs SIGUSR1 still asks for a report, and must not end the program.
    for (int signal = 1; signal < n_signals; ++signal)
      if (signal != SIGUSR1 && is_taken(signal)) set_handler(signal, SIG_DFL);
    bell_of_signals.store(nullptr);
  }
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  sem_post(&bell_);
  if (thread_.joinable()) thread_.join();
  sem_destroy(&bell_);
}

void Timekeeper::set(Timer& timer, Clock::time_point due, std::function<void()> run) {
  at(due, [&timer, of = ++timer.n_set, run = std::move(run)] {
    if (timer.n_set == of) run();
  });
}

void Timekeeper::at(Clock::time_point due, std::function<void()> run) {
  const auto added = due_.emplace(due, std::move(run));
  if (added == due_.begin()) sem_post(&bell_);
  start();
}

void Timekeeper::take_signals(std::span<const int> signals, std::function<void(int)> arrived) {
  arrived_ = std::move(arrived);
  for (std::atomic<int>& n : arrived_signals) n.store(0);
  TESS_CHECK(bell_of_signals.exchange(&bell_) == nullptr, "two services take signals");
  for (const int signal : signals)
    if (has_default_action(signal)) set_handler(signal, &count_signal);
  start();
}

void Timekeeper::start() {
  if (!thread_.joinable()) thread_ = std::thread([this] { keep_time(); });
}

void Timekeeper::keep_time() {
  std::unique_lock lock(mutex_);
  while (!ended_) {
    if (arrived_)
      for (int signal = 1; signal < n_signals; ++signal)
        for (int n = arrived_signals[static_cast<std::size_t>(signal)].exchange(0); n > 0; --n)
          arrived_(signal);
    while (!due_.empty() && due_.begin()->first <= Clock::now())
      due_.extract(due_.begin()).mapped()();
    const Clock::time_point next = due_.empty() ? Clock::time_point::max() : due_.begin()->first;
    lock.unlock();
    sleep_until(next);
    lock.lock();
  }
}

void Timekeeper::sleep_until(Clock::time_point due) {
  if (due == Clock::time_point::max()) {
    sem_wait(&bell_);
    return;
  }
  const auto since = std::chrono::nanoseconds(due.time_since_epoch());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  const timespec at{seconds.count(), (since - seconds).count()};
  sem_clockwait(&bell_, CLOCK_MONOTONIC, &at);
}

}  // namespace tess::detail
