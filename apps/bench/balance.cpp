#include "runtime/balance.hpp"

#include "apps/bench/measures.hpp"
#include "runtime/base/ticks.hpp"
#include "runtime/runtime.hpp"

#include <array>

namespace bench {
namespace {

/// 1 KiB that waits for its balancer, phase after phase.
class Resident : public tess::Chare<Resident, tess::Index1> {
 public:
  void begin(std::int32_t phases) {
    phases_left_ = phases;
    resume_from_sync();
  }
  void resume_from_sync() {
    ++load_[0];
    if (phases_left_-- > 0) at_sync();
  }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, static_cast<std::int64_t>(load_[0]), std::move(total));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(load_, phases_left_);
  }

 private:
  std::array<std::uint64_t, 128> load_{};
  std::int32_t phases_left_ = 0;
};

/// Every tenth element to the next PE.
tess::balance::Assignment move_a_tenth(const tess::balance::Snapshot& snapshot) {
  tess::balance::Assignment to = snapshot.elements.pe;
  const auto n_pes = static_cast<std::int32_t>(snapshot.pes.size());
  for (std::size_t i = 0; i < to.size(); i += 10) to[i].value = (to[i].value + 1) % n_pes;
  return to;
}

/// A round over many elements, without its strategy.
tess::Task round_cost(const Report& report, Options options) {
  constexpr std::int32_t n = 100'000;
  const std::int32_t phases = options.repeat;
  const auto residents = tess::create<Resident>(tess::range(n));
  const tess::BalancerProxy balancer = tess::start_balancing(residents, {}, &move_a_tenth);
  co_await tess::epoch([&] { residents.broadcast<&Resident::begin>(phases); });
  tess::Future<std::int64_t> counted;
  residents.broadcast<&Resident::count>(counted.callback());
  const std::int64_t total = co_await counted;
  TESS_CHECK(total == std::int64_t{n} * (phases + 1), total, " phases were run");
  Samples samples;
  for (const tess::balance::Round& round : balancer.history())
    samples.add(1e3 * (round.round_seconds - round.strategy_seconds));
  report.row("balance round over 100 000 elements of 1 KiB, a tenth moved", samples, "ms", 60);
}

/// Works for a while, and has a neighbour work.
class Worker : public tess::Chare<Worker, tess::Index1> {
 public:
  void work(std::int32_t left) {
    const auto grain = static_cast<std::uint64_t>(5e-6 / tess::seconds_per_tick());
    const std::uint64_t until = tess::read_ticks() + grain;
    while (tess::read_ticks() < until) {
    }
    if (left > 0)
      array()[{(index().x + 1) % static_cast<std::int32_t>(array().size())}].send<&Worker::work>(
          left - 1);
  }
};

tess::Task run_workers(tess::ArrayProxy<Worker> workers, Samples& samples) {
  constexpr std::int32_t n_hops = 300;
  const Stopwatch watch;
  co_await tess::epoch([&] { workers.broadcast<&Worker::work>(n_hops); });
  samples.add(watch.nanoseconds());
}

/// What measuring adds to messages of 5 µs: in turns, with and without, of one run.
tess::Task measuring_cost(const Report& report, Options options) {
  const auto plain = tess::create<Worker>(tess::range(64));
  const auto watched = tess::create<Worker>(tess::range(64));
  Samples without, with, share;
  for (std::int32_t k = 0; k < options.repeat; ++k) co_await run_workers(plain, without);
  tess::BalanceOptions options_of_balancer;
  options_of_balancer.when = tess::BalanceWhen::periodic;
  options_of_balancer.period = std::chrono::hours(1);
  tess::start_balancing(watched, options_of_balancer);
  for (std::int32_t k = 0; k < options.repeat; ++k) co_await run_workers(watched, with);
  share.add(100 * (with.least() / without.least() - 1));
  report.row("measuring elements at a grain of 5 us", share, "%", 3);
}

}  // namespace

tess::Task balance(const Report& report, Options options) {
  co_await measuring_cost(report, options);
  co_await round_cost(report, options);
}

}  // namespace bench
