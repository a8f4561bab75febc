// How late a timer is: 100 timers of 1 ms, one after the other, on a PE that sleeps meanwhile, and
// on one that passes messages of 5 us to itself.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"
#include "runtime/timer.hpp"

#include <algorithm>

namespace bench {
namespace {

constexpr std::chrono::microseconds delay{1000};

/// Keeps its PE busy until it is told to rest.
class Busy : public tess::Chare<Busy, tess::Index1> {
 public:
  void work() {
    if (rests_) return;
    bench::work(std::chrono::microseconds(5));
    array()[index()].send<&Busy::work>();
  }
  void rest() { rests_ = true; }

 private:
  bool rests_ = false;
};

struct Late {
  Samples median, worst;
};

tess::Task measure_timers(const Bench& bench, bool busy, Late& late) {
  const auto workers = tess::create<Busy>(tess::range(1));
  if (busy) workers[{0}].send<&Busy::work>();
  const int n_timers = bench.size(100, 5);
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    Samples microseconds;
    double worst = 0;
    for (int i = 0; i < n_timers; ++i) {
      tess::Future<std::int64_t> done;
      const std::int64_t begin = tess::current_pe().now().count();
      tess::after(delay,
                  [callback = done.callback()] { callback(tess::current_pe().now().count()); });
      const std::int64_t end = co_await done;
      const double micros = 1e-3 * static_cast<double>(end - begin) - 1000;
      TESS_CHECK(micros >= 0, "a timer was ", -micros, " us early");
      microseconds.add(micros);
      worst = std::max(worst, micros);
    }
    if (turn == 0) continue;
    late.median.add(microseconds.median());
    late.worst.add(worst);
  }
  workers[{0}].send<&Busy::rest>();
}

int run_timers(Bench& bench) {
  for (const bool busy : {false, true}) {
    const std::string name = busy ? "timer_busy" : "timer_idle";
    if (!bench.wants(name) && !bench.wants(name + "_worst")) continue;
    Late late;
    const int code = bench.run([&] { return measure_timers(bench, busy, late); });
    if (code != 0) return code;
    bench.row(name, late.median, "us");
    bench.row(name + "_worst", late.worst, "us");
  }
  return 0;
}

}  // namespace

Shape timers_shape() {
  return {"timers",
          "how late 100 timers of 1 ms are, one after the other",
          {{"timer_idle", "the median, on a PE that sleeps meanwhile"},
           {"timer_idle_worst", "the latest of them"},
           {"timer_busy", "the median, on a PE that runs entry methods of 5 us"},
           {"timer_busy_worst", "the latest of them"}},
          nullptr,
          &run_timers};
}

}  // namespace bench
