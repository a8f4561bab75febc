// The cost of a balance round itself: 100 000 elements of 1 KiB, of which a tenth moves.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/balance.hpp"
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

tess::Task measure_round(const Bench& bench, std::span<Figure> of_rows) {
  const std::int32_t n = bench.size(100'000, 500);
  const std::int32_t n_phases = bench.repeat() + 1;
  const auto residents = tess::create<Resident>(tess::range(n));
  const tess::BalancerProxy balancer = tess::start_balancing(residents, {}, &move_a_tenth);
  const auto begin = [&] { residents.broadcast<&Resident::begin>(n_phases); };
  co_await tess::epoch(begin);
  const std::int64_t total = co_await residents.reduce<&Resident::count>();
  TESS_CHECK(total == std::int64_t{n} * (n_phases + 1), total, " phases were run");
  // The strategy is timed by the system's clock; virtual time of a fixed cost does not have it.
  const bool subtracts = !tess::current_pe().machine().virtual_time();
  for (const tess::balance::Round& round : balancer.history()) {
    if (&round == balancer.history().data()) continue;  // it warms up
    // Where --sim forces migrations, some elements are between PEs, and others, which stay, have
    // unknown loads.
    const std::size_t n_wanted = (round.n_elements + 9) / 10;
    TESS_CHECK(round.n_moved <= n_wanted && n_wanted <= round.n_moved + round.n_unknown,
               round.n_moved, " of ", round.n_elements, " elements were moved, and ",
               round.n_unknown, " loads are unknown");
    of_rows[0].samples.add(1e3 * (round.round_seconds - (subtracts ? round.strategy_seconds : 0)));
  }
}

}  // namespace

Shape balance_round_shape() {
  return {"balance_round",
          "a round over 100 000 elements of 1 KiB, a tenth of which moves",
          {{"balance_round", "without the strategy's own time", Needs::two_pes, "ms"}},
          &measure_round};
}

}  // namespace bench
