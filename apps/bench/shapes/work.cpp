// Work under a broadcast: 64 chares that each work 0.4 ms when they receive it, then a reduction.
// The limit is the work of the busiest PE; if PEs take turns it is the sum over PEs.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>

namespace bench {
namespace {

class Labourer : public tess::Chare<Labourer, tess::Index1> {
 public:
  /// Contributes the nanoseconds that it worked, in a list with one place for each PE.
  void work(std::int64_t nanoseconds, tess::Callback<std::vector<double>> done) {
    const Stopwatch watch;
    bench::work(std::chrono::nanoseconds(nanoseconds));
    std::vector<double> worked(static_cast<std::size_t>(tess::n_pes()));
    worked[static_cast<std::size_t>(tess::my_pe().value)] = watch.nanoseconds();
    contribute(tess::sum, std::move(worked), std::move(done));
  }
};

tess::Task measure_work(const Bench& bench, std::span<Figure> of_rows) {
  constexpr std::int32_t n = 64;
  const std::int64_t work = bench.size<std::int64_t>(400'000, 5000);
  const std::int32_t n_rounds = bench.size(10, 2);
  const auto labourers = tess::create<Labourer>(tess::range(n));
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    double took = 0, worked = 0;
    for (std::int32_t round = 0; round < n_rounds; ++round) {
      const Stopwatch watch;
      const std::vector<double> by_pe = co_await labourers.reduce<&Labourer::work>(work);
      took += watch.nanoseconds();
      worked += *std::max_element(by_pe.begin(), by_pe.end());
      double sum = 0;
      for (const double pe : by_pe) sum += pe;
      TESS_CHECK(sum >= static_cast<double>(n * work), "only ", sum, " ns of work were done");
    }
    if (turn == 0) continue;
    of_rows[0].samples.add(1e-6 * took / n_rounds);
    of_rows[0].limit.add(1e-6 * worked / n_rounds);
  }
}

}  // namespace

Shape work_shape() {
  return {"work",
          "a broadcast, 0.4 ms of work by each of 64 chares, a reduction",
          {{"work_under_broadcast", "elapsed time of a round; its limit is the busiest PE's work",
            Needs::nothing, "ms"}},
          &measure_work};
}

}  // namespace bench
