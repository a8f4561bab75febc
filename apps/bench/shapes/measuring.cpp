// The cost of measuring elements, added to messages of 5 us. Once a balancer measures, its PEs
// measure until the run ends, so each turn is two runs, one without and one with a balancer.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/balance.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

/// Works for a while, and then lets a neighbour work.
class Worker : public tess::Chare<Worker, tess::Index1> {
 public:
  void work(std::int32_t left) {
    ++n_worked_;
    bench::work(std::chrono::microseconds(5));
    if (left > 0)
      array()[{(index().x + 1) % static_cast<std::int32_t>(array().size())}].send<&Worker::work>(
          left - 1);
  }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_worked_, 0), std::move(total));
  }

 private:
  std::int64_t n_worked_ = 0;
};

enum class Watched : std::uint8_t { no, yes };

tess::Task pass_work(const Bench& bench, Watched watched, double& nanoseconds) {
  constexpr std::int32_t n = 64;
  const auto workers = tess::create<Worker>(tess::range(n));
  tess::BalanceOptions options;
  options.when = tess::BalanceWhen::periodic;
  options.period = std::chrono::hours(1);
  if (watched == Watched::yes) tess::start_balancing(workers, options);
  std::int32_t n_hops = bench.size(30, 3);
  for (int i = 0; i < 2; ++i) {  // the first warms up
    const auto begin = [&] { workers.broadcast<&Worker::work>(n_hops - 1); };
    const Stopwatch watch;
    co_await tess::epoch(begin);
    nanoseconds = watch.nanoseconds();
    const std::int64_t n_worked = co_await workers.reduce<&Worker::count>();
    TESS_CHECK(n_worked == n * n_hops, n_worked, " messages were worked on");
    n_hops = bench.size(300, 3);
  }
}

int run_measuring(Bench& bench) {
  Samples share;
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    double without = 0, with = 0;
    int code = bench.run([&] { return pass_work(bench, Watched::no, without); });
    if (code == 0) code = bench.run([&] { return pass_work(bench, Watched::yes, with); });
    if (code != 0) return code;
    if (turn > 0) share.add(100 * (with / without - 1));
  }
  bench.row("measuring", share, "%");
  return 0;
}

}  // namespace

Shape measuring_shape() {
  return {"measuring",
          "messages of 5 us, with a balancer's measuring and without, in turns",
          {{"measuring", "what measuring adds to the elapsed time"}},
          nullptr,
          &run_measuring};
}

}  // namespace bench
