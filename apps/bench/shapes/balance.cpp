// 64 chares whose work grows with their index, in a block map: 60 iterations of broadcast, work and
// a reduction of busy times, with at_sync() every 20. The limit is the time that the block map
// allows for the first 20 iterations and an ideal map for the others, from the rate of the work on
// PE 0.
#include "runtime/balance.hpp"

#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <array>

namespace bench {
namespace {

constexpr std::int32_t n_grinders = 64;
/// On the simulated machine, where work is charged.
constexpr double virtual_rate = 1.64;  // ns

struct GrindPlan {
  std::int32_t n_iterations = 60;
  std::int32_t sync_every = 20;
  std::int64_t unit = 8000;
};

/// So many dependent multiply-adds.
[[gnu::noinline]] double grind(double x, std::int64_t n) {
  const std::chrono::nanoseconds work(
      static_cast<std::int64_t>(virtual_rate * static_cast<double>(n)));
  if (tess::charge(work)) return x;
  for (std::int64_t i = 0; i < n; ++i) x = x * 0.999 + 0.5;
  return x;
}

class Grinder : public tess::Chare<Grinder, tess::Index1> {
 public:
  Grinder() = default;
  Grinder(GrindPlan plan, tess::Callback<std::int64_t> done)
      : plan_(plan), done_(std::move(done)) {}

  void iterate() {
    const Stopwatch watch;
    load_[0] = grind(load_[0], plan_.unit * (index().x + 1));
    ++n_steps_;
    std::vector<double> busy(static_cast<std::size_t>(tess::n_pes()));
    busy[static_cast<std::size_t>(tess::my_pe().value)] = watch.nanoseconds();
    contribute(tess::sum, std::move(busy), array()[{0}].target<&Grinder::iterated>());
  }
  /// The first element conducts.
  void iterated(const std::vector<double>& /*busy*/) {
    ++n_iterations_;
    if (n_iterations_ == plan_.n_iterations)
      done_(n_iterations_);
    else if (n_iterations_ % plan_.sync_every == 0)
      array().broadcast<&Grinder::balance>();
    else
      array().broadcast<&Grinder::iterate>();
  }
  void balance() { at_sync(); }
  void resume_from_sync() { contribute(tess::sum, 1, array()[{0}].target<&Grinder::balanced>()); }
  void balanced(std::int32_t n) {
    TESS_CHECK(n == n_grinders, n, " of ", n_grinders, " chares went on after a balance round");
    array().broadcast<&Grinder::iterate>();
  }
  void count(tess::Callback<std::int64_t> n_steps) {
    contribute(tess::sum, n_steps_, std::move(n_steps));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(plan_, done_, load_, n_iterations_, n_steps_);
  }

 private:
  GrindPlan plan_;
  tess::Callback<std::int64_t> done_;
  std::array<double, 128> load_{};  // 1 KiB
  std::int32_t n_iterations_ = 0;
  std::int64_t n_steps_ = 0;
};

/// Nanoseconds of a multiply-add on the PE that calls, the best of some tries.
double grinding_rate() {
  constexpr std::int64_t n = 1'000'000;
  double best = 0;
  for (int i = 0; i < 5; ++i) {
    const Stopwatch watch;
    volatile double kept = grind(i, n);
    (void)kept;
    const double rate = watch.nanoseconds() / static_cast<double>(n);
    best = i == 0 ? rate : std::min(best, rate);
  }
  return best;
}

/// A lower bound of the seconds of any schedule.
double grinding_floor(const GrindPlan& plan, double rate) {
  const std::int32_t n_pes = tess::n_pes();
  std::vector<double> of_pe(static_cast<std::size_t>(n_pes));
  double whole = 0;
  for (std::int32_t i = 0; i < n_grinders; ++i) {
    of_pe[static_cast<std::size_t>(i * n_pes / n_grinders)] += i + 1;
    whole += i + 1;
  }
  const double blocks = *std::max_element(of_pe.begin(), of_pe.end());
  const double ideal = std::max(whole / n_pes, double{n_grinders});
  return 1e-9 * rate * static_cast<double>(plan.unit) *
         (plan.sync_every * blocks + (plan.n_iterations - plan.sync_every) * ideal);
}

tess::Task measure_balance(const Bench& bench, std::span<Figure> of_rows) {
  GrindPlan plan;
  plan.unit = bench.size<std::int64_t>(8000, 100);
  plan.n_iterations = bench.size(60, 6);
  plan.sync_every = plan.n_iterations / 3;
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    const double rate = grinding_rate();
    tess::Future<std::int64_t> done;
    const auto grinders = tess::create<Grinder>(tess::range(n_grinders), plan, done.callback());
    tess::BalanceOptions options;
    options.strategy = "greedy_refine";
    tess::start_balancing(grinders, options);
    const Stopwatch watch;
    grinders.broadcast<&Grinder::iterate>();
    co_await done;
    const double seconds = 1e-9 * watch.nanoseconds();
    const std::int64_t n_steps = co_await grinders.reduce<&Grinder::count>();
    TESS_CHECK(n_steps == n_grinders * plan.n_iterations, n_steps, " steps were done");
    if (turn == 0) continue;
    of_rows[0].samples.add(seconds);
    of_rows[0].limit.add(grinding_floor(plan, rate));
  }
}

}  // namespace

Shape balance_shape() {
  return {"balance",
          "60 iterations of 64 unequal chares, balanced every 20",
          {{"balance_total", "elapsed time; its limit: 20 iterations as mapped first, 40 ideal",
            Needs::two_pes, "s"}},
          &measure_balance};
}

}  // namespace bench
