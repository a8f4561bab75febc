// A job that ends as its argument says, while messages travel round all PEs and would do so for
// ever; run under mpirun by job_ends.sh.
//
//     test_job throw | fail | memory | check | exit | codes=A,B | move | forget | wait
//
// It prints when it begins to end, as milliseconds of the system's clock.
#include "runtime/runtime.hpp"

#include <chrono>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <thread>
#include <unistd.h>

namespace {

constexpr int n_balls = 100;  // of each PE

void print_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  std::printf(
      "ends at %lld\n",
      static_cast<long long>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count()));
  std::fflush(stdout);
}

/// Keeps every PE busy.
class Crowd : public tess::Group<Crowd> {
 public:
  void begin() {
    std::printf("PE %d pid %d\n", pe().value, static_cast<int>(::getpid()));
    std::fflush(stdout);
    for (int i = 0; i < n_balls; ++i) pass(i);
  }
  void pass(int ball) {
    const tess::PeId next{(pe().value + 1) % tess::n_pes()};
    group()[next].send<&Crowd::pass>(ball);
  }
  void give(int code) {
    print_time();
    tess::exit(code);
  }
#ifdef OTHER_PROGRAM
  void only_here() {}
  void begin_other() { group()[pe()].send<&Crowd::only_here>(); }
#endif
};

/// The error occurs in an element on the last PE.
class Actor : public tess::Chare<Actor, tess::Index1> {
 public:
  void act(std::string ending) {
    // After the flood has begun.
    if (--delay_ > 0) {
      array()[index()].send<&Actor::act>(std::move(ending));
      return;
    }
    print_time();
    if (ending == "throw") throw std::runtime_error("the bridge is out");
    if (ending == "fail") tess::fail(tess::ErrorCode::bad_value, "the dose is -1: give more");
    if (ending == "memory") throw std::bad_alloc();
    if (ending == "exit") tess::exit(5);
    TESS_CHECK(ending != "check", "element ", index().x, " was told to");
  }

 private:
  int delay_ = 1000;
};

/// Goes round all PEs without end, with some weight; one of them ends the job on its way.
class Wanderer : public tess::Chare<Wanderer, tess::Index1> {
 public:
  void go(int n_moves) {
    if (n_moves == 0 && index().x == 0) {
      print_time();
      tess::exit(7);
    }
    array()[index()].send<&Wanderer::go>(n_moves - 1);
    migrate_to(tess::PeId{(tess::current_pe().id().value + 1) % tess::n_pes()});
  }
  void serialize(auto& ar) { ar(load_); }

 private:
  std::vector<double> load_ = std::vector<double>(10'000);
};

/// Moves, and reads a member into nowhere: builds with TESS_CHECKS=all refuse it.
class Forgetful : public tess::Chare<Forgetful, tess::Index1> {
 public:
  void go() {
    lost_ = 7.5;
    migrate_to(tess::PeId{tess::n_pes() - 1});
  }
  void end() const { tess::exit(0); }
  template <class Ar>
  void serialize(Ar& ar) {
    double other = Ar::is_reading ? 0 : lost_;
    ar(kept_, other);
  }

 private:
  int kept_ = 1;
  double lost_ = 0;
};

/// The first and the last PE both pass an exit code before either can learn of the other's.
void give_codes(tess::GroupProxy<Crowd> crowd, int first, int last) {
  tess::Pe& pe = tess::current_pe();
  crowd[tess::PeId{pe.n_pes() - 1}].send<&Crowd::give>(last);
  pe.peers().flush();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  print_time();
  tess::exit(first);
}

int job(tess::Setup& setup, int argc, char** argv) {
  const std::string ending = argc > 1 ? argv[1] : "";
  return tess::run(setup, [ending] {
    const auto crowd = tess::create<Crowd>(tess::each_pe);
    if (ending == "codes=3,9") {
      give_codes(crowd, 3, 9);
    } else if (ending == "codes=9,3") {
      give_codes(crowd, 9, 3);
    } else if (ending == "codes=0,7") {
      give_codes(crowd, 0, 7);
    } else if (ending == "move") {
      tess::create<Wanderer>(tess::range(200)).broadcast<&Wanderer::go>(50);
    } else if (ending == "forget") {
      const auto forgetful = tess::create<Forgetful>(tess::range(1));
      forgetful[{0}].send<&Forgetful::go>();
      forgetful[{0}].send<&Forgetful::end>();
    } else {
      crowd.broadcast<&Crowd::begin>();
      const std::int32_t n = tess::n_pes();
      const auto actors = tess::create<Actor>(tess::range(n));
      actors[{n - 1}].send<&Actor::act>(ending);
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return job(setup, argc, argv); });
}
