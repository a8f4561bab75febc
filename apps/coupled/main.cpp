// An overset mesh that moves through a background mesh; on both, a field diffuses. In each step both
// solve, the small mesh moves, and two transfers couple them: the fringe of the small mesh gets the
// values of the background, and the background those of the small mesh where it is deep inside. With
// --balance the slabs of both migrate between steps.
#include "apps/coupled/slab.hpp"
#include "runtime/balance.hpp"
#include "runtime/command_line.hpp"

#include <cmath>
#include <fmt/core.h>
#include <optional>
#include <string>
#include <vector>

namespace coupled {
namespace {

struct Options {
  std::int32_t n = 16;       // cubes on an edge of each box
  std::int32_t n_slabs = 0;  // per mesh; 0: two per PE
  double end = 0.0025;       // time
  Reaction reaction{};
  std::optional<tess::BalanceOptions> balance{};
  std::int32_t balance_every = 5;  // steps
};

/// The balancers of both meshes. Each counts the load of the other mesh as fixed, so their rounds
/// take turns: after the one of a mesh, a new phase of the other begins. Otherwise both would
/// correct the same imbalance.
class Balancers {
 public:
  void add(const tess::BalancerProxy& balancer) { all_.push_back(balancer); }
  tess::Task round() {
    if (all_.empty()) co_return;
    co_await all_[next_].round();
    next_ = 1 - next_;
    co_await all_[next_].begin_phase();
  }
  [[nodiscard]] std::size_t n_moved() const {
    std::size_t n = 0;
    for (const tess::BalancerProxy& balancer : all_)
      for (const auto& round : balancer.history()) n += round.n_moved;
    return n;
  }

 private:
  std::vector<tess::BalancerProxy> all_;
  std::size_t next_ = 0;
};

/// The small box goes round the middle of the cube.
Point low_at(double fraction) {
  return {0.3 + 0.1 * std::cos(fraction), 0.3 + 0.1 * std::sin(fraction), 0.3};
}

/// The steps of a run. Throws Error (bad_argument) if they are too many.
std::int32_t steps_of(const Options& options, double spacing) {
  constexpr double most = 1e6;
  // For diffusion; and for the small box, which moves 0.1 in all: a fifth of a cube a step.
  const double longest = std::min(0.1 * spacing * spacing, 2 * spacing * options.end);
  const double n = std::ceil(options.end / longest);
  if (!(n <= most))
    tess::fail(tess::ErrorCode::bad_argument, "--time ", options.end, " takes ", n,
               " steps of at most ", longest, ", and at most ", most, " are run; give at most ",
               most * longest);
  return static_cast<std::int32_t>(n);
}

tess::Task compute(Options options) {
  const std::int32_t n_slabs = options.n_slabs != 0 ? options.n_slabs : 2 * tess::n_pes();
  Box big{.n = options.n, .n_slabs = n_slabs, .reaction = options.reaction};
  big.least_depth = 2 * big.spacing();
  const Box small{.low = low_at(0),
                  .edge = 0.4,
                  .n = options.n,
                  .n_slabs = n_slabs,
                  .has_fringe = true,
                  .reaction = options.reaction};
  const std::int32_t n_steps = steps_of(options, small.spacing());
  const auto background = tess::create<Slab>(tess::range(n_slabs), big);
  const auto overset = tess::create<Slab>(tess::range(n_slabs), small);
  Balancers balancers;
  if (options.balance)
    for (const auto& slabs : {background, overset})
      balancers.add(tess::start_balancing(slabs, *options.balance));
  tess::m2m::Coupling to_overset(background, overset), to_background(overset, background);
  const auto exchange = [&] {
    background.broadcast<&Slab::exchange>();
    overset.broadcast<&Slab::exchange>();
  };
  const double dt = options.end / n_steps;
  const tess::Time begin = tess::now();
  for (std::int32_t k = 0; k < n_steps; ++k) {
    const Point from = low_at(double(k) / n_steps), to = low_at(double(k + 1) / n_steps);
    const Step at_rest{k * dt, dt, {}};
    Step moving = at_rest;
    for (std::size_t axis = 0; axis < 3; ++axis)
      moving.velocity[axis] = (to[axis] - from[axis]) / dt;
    if (k > 0 && k % options.balance_every == 0) co_await balancers.round();
    co_await tess::epoch(exchange);
    co_await tess::epoch([&] {
      background.broadcast<&Slab::step>(at_rest);
      overset.broadcast<&Slab::step>(moving);
    });
    co_await tess::epoch([&] { overset.broadcast<&Slab::move_to>(to); });
    co_await tess::epoch(exchange);
    auto one = to_overset.search(), other = to_background.search();
    co_await one;
    co_await other;
    co_await to_overset.apply<&Slab::give, &Slab::take>();
    co_await to_background.apply<&Slab::give, &Slab::take>();
  }
  const double seconds = tess::seconds(tess::now() - begin);
  auto on_background = background.reduce<&Slab::compare>(options.end);
  auto on_overset = overset.reduce<&Slab::compare>(options.end);
  const Comparison a = co_await on_background, b = co_await on_overset;
  tess::print(fmt::format(
      "{} cubes on an edge, {} slabs per mesh, {} steps: {:.6f} s, {:.3f} ms a step\n"
      "from the solution: background {:.3e}, overset {:.3e}; taken {} and {}; hash {:016x}\n",
      options.n, n_slabs, n_steps, seconds, 1e3 * seconds / n_steps, a.error, b.error, a.n_taken,
      b.n_taken, a.hash + b.hash));
  if (options.balance)
    tess::print(fmt::format("balanced by {}, every {} steps: {} slabs moved\n",
                            options.balance->strategy, options.balance_every, balancers.n_moved()));
}

}  // namespace
}  // namespace coupled

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    coupled::Options options;
    std::string balance;
    tess::CommandLine line(
        "A field that diffuses on a background mesh and on one that moves through it.");
    line.option("--cubes", options.n, "cubes on an edge of each mesh").between(12, 512);
    line.option("--slabs", options.n_slabs, "pieces per mesh (default: two per PE)")
        .between(1, 512);
    line.option("--time", options.end, "time at the end").positive();
    line.option("--reaction", options.reaction.factor,
                "burn where the field is warm: factor of Arrhenius's law (default: 0)")
        .between(0, 1e6);
    const tess::Option substeps =
        line.option("--substeps", options.reaction.n_substeps, "of the reaction")
            .between(1, 10'000);
    line.option("--balance STRATEGY", balance,
                "slabs migrate between steps: a strategy, as greedy_refine[,when=automatic]");
    const tess::Option balance_every =
        line.option("--balance-every", options.balance_every, "steps between rounds")
            .between(1, 1'000'000);
    if (!line.parse(argc, argv)) return 0;
    if (substeps.is_given() && options.reaction.factor == 0)
      tess::fail(tess::ErrorCode::bad_argument, "--substeps ", options.reaction.n_substeps,
                 " are those of a reaction, and there is none; give --reaction, too");
    if (balance_every.is_given() && !line.is_given("--balance"))
      tess::fail(tess::ErrorCode::bad_argument, "--balance-every ", options.balance_every,
                 " is for a balancer, and there is none; give --balance, too");
    if (line.is_given("--balance")) {
      options.balance = tess::parse_balance(balance);
      if (options.balance->when == tess::BalanceWhen::periodic)
        tess::fail(tess::ErrorCode::bad_argument, "--balance ", balance,
                   ": rounds run between steps; leave out when=periodic, and give --balance-every");
    }
    if (options.n_slabs > options.n + 1)
      tess::fail(tess::ErrorCode::bad_argument, "--slabs: ", options.n_slabs, " pieces of ",
                 options.n + 1, " planes: give at most one per plane");
    return tess::run(setup, [&] { return coupled::compute(options); });
  });
}
