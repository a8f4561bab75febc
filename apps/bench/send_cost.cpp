#include "apps/bench/measures.hpp"
#include "runtime/base/mix.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

struct Walk {
  std::uint64_t seed = 0;
  std::int64_t hops_left = 0;
};

/// Sends each message on to a random element.
class Walker : public tess::Chare<Walker, tess::Index1> {
 public:
  explicit Walker(std::int32_t n) : n_(static_cast<std::uint64_t>(n)) {}

  void hop(Walk walk) {
    ++n_hops_;
    if (--walk.hops_left == 0) return;
    walk.seed += 0x9e3779b97f4a7c15U;
    const auto next = static_cast<std::int32_t>((tess::mix(walk.seed) >> 32U) * n_ >> 32U);
    array()[{next}].send<&Walker::hop>(walk);
  }
  /// Begins one walk here.
  void begin(std::int64_t hops) {
    hop(Walk{tess::mix(static_cast<std::uint64_t>(index().x)), hops});
  }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_hops_, 0), std::move(total));
  }

 private:
  std::uint64_t n_;
  std::int64_t n_hops_ = 0;
};

}  // namespace

tess::Task send_cost(const Report& report, Options options) {
  const auto walkers = tess::create<Walker>(tess::range(options.elements), options.elements);
  const std::int64_t n_hops = 2000;
  const std::int64_t n_all = n_hops * options.elements;
  Samples samples;
  for (std::int32_t k = 0; k < options.repeat; ++k) {
    const auto walk = [&] { walkers.broadcast<&Walker::begin>(n_hops); };
    const Stopwatch watch;
    co_await tess::epoch(walk);
    samples.add(watch.nanoseconds() / static_cast<double>(n_all));
    tess::Future<std::int64_t> total;
    walkers.broadcast<&Walker::count>(total.callback());
    const std::int64_t n = co_await total;
    TESS_CHECK(n == n_all, n, " hops were made, not ", n_all);
  }
  switch (reach()) {
    case Reach::one_pe:
      report.row("message to a random element on one PE", samples, "ns", 126);
      break;
    case Reach::one_process:
      report.row("message to a random element over PEs", samples, "ns", 129);
      break;
    case Reach::processes:
      report.row("message to a random element over processes", samples, "ns", 200);
      break;
  }
}

}  // namespace bench
