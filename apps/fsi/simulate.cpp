#include "apps/fsi/simulate.hpp"

#include "apps/fsi/flow.hpp"
#include "apps/fsi/panel.hpp"

#include <algorithm>
#include <cmath>

namespace fsi {
namespace {

/// Panel and fluid, and the couplings between them.
class Codes {
 public:
  /// Creates both, and finds which point of one is at which of the other: one search for both ways.
  tess::Task start(const Problem& problem) {
    problem_ = problem;
    panel_ = tess::create<Panel>(tess::range(problem.n_pieces), problem);
    flow_ = tess::create<Flow>(tess::range(problem.n_pieces), problem);
    moves_ = tess::m2m::Coupling(panel_, flow_, {.kind = tess::m2m::TransferKind::projection});
    co_await moves_.search();
    forces_ = moves_.transposed();
    co_await forces_.search();
  }
  tess::Task end() {
    co_await tess::epoch([&] {
      forces_.destroy();
      moves_.destroy();
    });
    panel_.destroy();
    flow_.destroy();
  }
  [[nodiscard]] std::vector<tess::BalancerProxy> balance(
      const tess::BalanceOptions& options) const {
    return {tess::start_balancing(panel_, options), tess::start_balancing(flow_, options)};
  }

  /// The fluid hears the panel's guess, and the panel the pressure of that.
  tess::Task meet() {
    co_await moves_.apply<&Panel::displacement, &Flow::displacement>();
    co_await tess::epoch([&] { flow_.broadcast<&Flow::press>(); });
    co_await forces_.apply<&Flow::force, &Panel::load>();
  }
  /// A step. `factor`: of the last correction of all; it becomes that of this step's last.
  tess::Task step(double& factor, Outcome& outcome) {
    co_await tess::epoch([&] { panel_.broadcast<&Panel::begin>(); });
    for (std::int32_t k = 1;; ++k) {
      co_await meet();
      co_await tess::epoch([&] { panel_.broadcast<&Panel::move>(); });
      const Residual r = co_await panel_.reduce<&Panel::compare>();
      ++outcome.n_iterations;
      if (r.largest <= problem_.tolerance * problem_.amplitude) break;
      if (k == problem_.most_iterations || !(r.largest < 1e6 * problem_.amplitude)) {
        outcome.diverged = true;
        co_return;
      }
      // Aitken: the factor that would have removed the residual, had the last one been right for
      // what it changed (Irons and Tuck 1969). The first one of a step is the last one's, bounded.
      if (problem_.adapts && k > 1 && r.sums[2].total() > 0)
        factor *= -r.sums[1].total() / r.sums[2].total();
      else if (problem_.adapts)
        factor = std::copysign(std::min(std::abs(factor), problem_.relaxation), factor);
      co_await tess::epoch([&] { panel_.broadcast<&Panel::correct>(factor); });
    }
    co_await tess::epoch([&] { flow_.broadcast<&Flow::accept>(); });
  }

  /// Kinetic energy of both and that of the springs.
  tess::TaskOf<Measured> measure(double time) {
    auto of_panel = panel_.reduce<&Panel::measure>(time);
    auto of_flow = flow_.reduce<&Flow::measure>();
    const Measured panel = co_await of_panel, flow = co_await of_flow;
    co_return JoinMeasured{}(panel, flow);
  }

  /// Notes by how much the forces of both differ.
  tess::Task compare_forces(Outcome& outcome) {
    auto of_panel = panel_.reduce<&Panel::balance>();
    auto of_flow = flow_.reduce<&Flow::balance>();
    const Balance panel = co_await of_panel, flow = co_await of_flow;
    const auto gap = [&](std::size_t i, std::size_t scale) {
      const double all = flow.sums[scale].total();
      return all > 0 ? std::abs(panel.sums[i].total() - flow.sums[i].total()) / all : 0;
    };
    kit::worsen(outcome.force_gap, gap(0, 4));
    kit::worsen(outcome.moment_gap, std::max(gap(1, 4), gap(2, 4)));
    kit::worsen(outcome.work_gap, gap(3, 5));
  }

  /// For checkpoints: after a restart the couplings need no search.
  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, panel_, flow_, moves_, forces_);
  }

 private:
  Problem problem_;
  tess::ArrayProxy<Panel> panel_;
  tess::ArrayProxy<Flow> flow_;
  tess::m2m::Coupling<Panel, Flow> moves_;
  tess::m2m::Coupling<Flow, Panel> forces_;
};

/// All that a checkpoint holds beside the pieces.
struct State {
  Problem problem;
  Codes codes{};
  std::int32_t step = 0;  // done
  double factor = 0;      // of the last correction
  double energy = 0;      // at the start
  Outcome outcome;
};

}  // namespace

tess::Task simulate(Settings& settings, Outcome& outcome, std::function<void(std::int32_t)> part) {
  Problem& problem = settings.problem;
  State state{.problem = problem, .factor = problem.relaxation, .outcome = {}};
  Codes& codes = state.codes;
  if (settings.checkpoints.restarts()) {
    co_await settings.checkpoints.restart(state, problem.n_steps);
    state.problem.n_steps = problem.n_steps;
    problem = state.problem;
  } else {
    co_await codes.start(problem);
    state.energy = (co_await codes.measure(0)).energy.total();
  }
  outcome = state.outcome;
  std::vector<tess::BalancerProxy> balancers;
  if (settings.balance) balancers = codes.balance(*settings.balance);
  Measured now;
  while (state.step < problem.n_steps && !outcome.diverged) {
    const std::int32_t from = state.step;
    if (part) part(from);
    if (from > 0 && from % settings.balance_every == 0)
      for (const tess::BalancerProxy& balancer : balancers) co_await balancer.round();
    const tess::Time begin = tess::now();
    co_await codes.step(state.factor, outcome);
    outcome.seconds += tess::seconds(tess::now() - begin);
    state.step = from + 1;
    now = co_await codes.measure(state.step * problem.dt());
    kit::worsen(outcome.energy_drift, std::abs(now.energy.total() / state.energy - 1));
    co_await codes.compare_forces(outcome);
    outcome.error = now.error / problem.amplitude;
    outcome.hash = now.hash;
    state.outcome = outcome;
    co_await settings.checkpoints.save_if_due(state, from, problem.n_steps);
  }
  for (const tess::BalancerProxy& balancer : balancers)
    for (const auto& round : balancer.history()) outcome.n_moved += round.n_moved;
  co_await codes.end();
}

}  // namespace fsi
