// A job that waits, works, or is stuck until a signal ends it; run by signals.sh.
//
//     test_signals wait     a coroutine waits for a message that never comes, and a timer for an hour
//     test_signals busy     messages travel round all PEs
//     test_signals stuck    an entry method on the last PE does not return
//     test_signals ignore   as wait, but the program ignores SIGTERM
#include "runtime/runtime.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>
#include <unistd.h>

namespace {

struct Letter {
  int key = 0;
};

class Waiter : public tess::Group<Waiter> {
 public:
  tess::Task wait() {
    announce();
    co_await letters_.take(7);
  }
  void travel() {
    if (n_++ == 0) announce();
    const tess::PeId next{(pe().value + 1) % tess::current_pe().n_pes()};
    group()[next].send<&Waiter::travel>();
  }
  void get_stuck() {
    announce();
    if (pe().value != tess::current_pe().n_pes() - 1) return;
    for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

 private:
  void announce() {
    std::printf("PE %d pid %d\n", pe().value, static_cast<int>(::getpid()));
    std::fflush(stdout);
  }

  int n_ = 0;
  tess::Mailbox<&Letter::key> letters_;
};

int job(int argc, char** argv) {
  tess::Setup setup = tess::take_options(argc, argv);
  const std::string kind = argc > 1 ? argv[1] : "";
  // A shell starts its background jobs with SIGINT ignored.
  std::signal(SIGINT, SIG_DFL);
  if (kind == "ignore") std::signal(SIGTERM, SIG_IGN);
  return tess::run(setup, [kind] {
    const auto waiters = tess::create<Waiter>(tess::each_pe);
    tess::after(std::chrono::hours(1), [] {});
    if (kind == "busy") {
      waiters.broadcast<&Waiter::travel>();
    } else if (kind == "stuck") {
      waiters.broadcast<&Waiter::get_stuck>();
    } else {
      waiters.broadcast<&Waiter::wait>();
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return job(argc, argv); });
}
