// A job that hangs; run by hang.sh.
//
//     test_hang cycle    two elements on the first and the last PE wait for each other's replies
//     test_hang stuck    an entry method on the last PE does not return
//     test_hang mixed    an entry method on the last PE does not return, and the PE before works
//     test_hang works    a message travels round all PEs without end
//     test_hang ends     a message travels round all PEs, and the job ends
//     test_hang lost     the third message of PE 0 is lost (--audit)
#include "runtime/runtime.hpp"

#include <chrono>
#include <cstdio>
#include <thread>
#include <unistd.h>

namespace {

class Worker : public tess::Group<Worker> {
 public:
  tess::Task step(tess::PeId other) {
    announce();
    if (other != pe()) co_await group()[other].ask<&Worker::depth>(pe());
  }
  tess::Task depth(tess::PeId from) { co_await group()[from].ask<&Worker::level>(); }
  tess::Task level() {
    tess::Future<int> never;
    co_await never;
  }
  void travel_far(int n_hops) {
    if (n_hops > 0) group()[next()].send<&Worker::travel_far>(n_hops - 1);
  }
  void travel() {
    if (n_++ == 0) announce();
    group()[next()].send<&Worker::travel>();
  }
  void get_stuck() {
    announce();
    if (pe() != last()) return;
    for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  void work_on() {
    if (n_++ == 0) announce();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    group()[pe()].send<&Worker::work_on>();
  }
  void start_losing() {
    for (int i = 0; i < 5; ++i) group()[last()].send<&Worker::take>();
  }
  void take() {}
  void announce() {
    std::printf("PE %d pid %d\n", pe().value, static_cast<int>(::getpid()));
    std::fflush(stdout);
  }
  [[nodiscard]] std::string describe_state() const { return "at step 16"; }

 private:
  [[nodiscard]] tess::PeId last() const { return tess::PeId{tess::current_pe().n_pes() - 1}; }
  [[nodiscard]] tess::PeId next() const {
    return tess::PeId{(pe().value + 1) % tess::current_pe().n_pes()};
  }
  int n_ = 0;
};

int job(int argc, char** argv) {
  tess::Setup setup = tess::take_options(argc, argv);
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind == "lost") setup.options.fault = {tess::MessageFault::Kind::lost, 3};
  return tess::run(setup, [kind] {
    const auto workers = tess::create<Worker>(tess::each_pe);
    if (kind == "ends") return workers.broadcast<&Worker::travel_far>(1000);
    tess::after(std::chrono::hours(1), [] {});
    const tess::PeId first{0}, last{tess::current_pe().n_pes() - 1};
    if (kind == "stuck") {
      workers.broadcast<&Worker::get_stuck>();
    } else if (kind == "mixed") {
      workers.broadcast<&Worker::get_stuck>();
      workers[tess::PeId{last.value - 1}].send<&Worker::work_on>();
    } else if (kind == "works") {
      workers.broadcast<&Worker::travel>();
    } else if (kind == "lost") {
      workers.broadcast<&Worker::announce>();
      workers[first].send<&Worker::start_losing>();
    } else {
      for (int i = 1; i < last.value; ++i)
        workers[tess::PeId{i}].send<&Worker::step>(tess::PeId{i});
      workers[last].send<&Worker::step>(last);
      workers[first].send<&Worker::step>(last);
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return job(argc, argv); });
}
