#include "apps/leanmd/simulation.hpp"

#include "apps/leanmd/cell.hpp"

#include <algorithm>
#include <map>

namespace leanmd {
namespace {

/// All that a checkpoint holds beside the elements.
struct State {
  Problem problem;
  tess::ArrayProxy<Compute> computes;
  tess::ArrayProxy<Cell> cells;
  std::int32_t step = 0;  // done
  Conserved conserved;
  Outcome outcome;  // so far
};

class Simulation {
 public:
  explicit Simulation(Options& options) : options_(options) {}

  tess::Task run(const std::vector<Atom>& atoms, Outcome& outcome);

 private:
  tess::Task create(const std::vector<Atom>& atoms);
  tess::Task start_balancing();
  /// The rounds until now, those before a restart first.
  void collect_rounds();
  /// Stops early if something is wrong.
  tess::Task run_to(std::int32_t last);
  tess::Task run_part(std::int32_t first, std::int32_t last);
  tess::Task show(std::vector<AtomForce>& all);
  tess::Task compare_forces();
  tess::Task return_to_start();
  tess::Task reverse();

  Options& options_;
  State state_;
  tess::BalancerProxy balancer_;
  std::size_t n_earlier_rounds_ = 0;  // before a restart
};

tess::Task Simulation::run(const std::vector<Atom>& atoms, Outcome& outcome) {
  const bool restarts = options_.checkpoints.restarts();
  if (restarts)
    co_await options_.checkpoints.restart(state_, options_.n_steps);
  else
    co_await create(atoms);
  options_.problem = state_.problem;
  n_earlier_rounds_ = state_.outcome.rounds.size();
  co_await start_balancing();

  if (!restarts) {
    co_await run_part(0, 0);
    state_.outcome.first_hash = state_.outcome.hash;
    if (options_.check) co_await compare_forces();
  }
  co_await run_to(options_.n_steps);
  if (options_.check) co_await compare_forces();
  collect_rounds();
  if (options_.reverse && state_.outcome.error.empty()) co_await return_to_start();
  state_.cells.destroy();
  state_.computes.destroy();
  outcome = std::move(state_.outcome);
}

tess::Task Simulation::create(const std::vector<Atom>& atoms) {
  const Box& box = options_.problem.box;
  state_.problem = options_.problem;
  state_.conserved = Conserved::of(atoms);
  state_.computes = tess::create<Compute>(tess::sparse);
  state_.cells = tess::create<Cell>(tess::range(box.n_cells[0], box.n_cells[1], box.n_cells[2]),
                                    state_.problem, state_.computes);
  std::map<tess::Index3, std::vector<Atom>> by_cell;
  for (const Atom& atom : atoms) by_cell[box.cell_of(atom.at)].push_back(atom);
  co_await tess::epoch([&] {
    for (auto& [cell, own] : by_cell) state_.cells[cell].send<&Cell::fill>(std::move(own));
    state_.cells.broadcast<&Cell::create_computes>();
  });
}

tess::Task Simulation::start_balancing() {
  const auto& balance = options_.balance;
  if (balance) balancer_ = tess::start_balancing(state_.computes, *balance);
  const bool has_barrier = balance && balance->when != tess::BalanceWhen::periodic;
  const std::int32_t every = has_barrier ? state_.problem.every : 0;
  co_await tess::epoch([&] { state_.computes.broadcast<&Compute::set_barrier>(every); });
  if (options_.checkpoints.restarts())
    co_await balancer_.place_again();
  else
    co_await balancer_.begin_phase();
}

void Simulation::collect_rounds() {
  const std::vector<tess::balance::Round>& history = balancer_.history();
  std::vector<tess::balance::Round>& all = state_.outcome.rounds;
  if (all.size() > n_earlier_rounds_) all.pop_back();  // it may have been measured since
  while (all.size() < n_earlier_rounds_ + history.size()) {
    all.push_back(history[all.size() - n_earlier_rounds_]);
    all.back().number = all.size() - 1;
  }
}

tess::Task Simulation::run_to(std::int32_t last) {
  while (state_.step < last && state_.outcome.error.empty()) {
    const std::int32_t from = state_.step, every = state_.problem.every;
    const std::int32_t pause = options_.checkpoints.pause_after(from, last);
    co_await run_part(from + 1, std::min(pause, (from / every + 1) * every));
    collect_rounds();
    if (state_.outcome.error.empty())
      co_await options_.checkpoints.save_if_due(state_, from, options_.n_steps);
  }
}

tess::Task Simulation::run_part(std::int32_t first, std::int32_t last) {
  const tess::Time begin = tess::now();
  tess::Future<Totals> done;
  state_.cells.broadcast<&Cell::begin>(Run{first, last, done.callback()});
  const Totals totals = co_await done;
  state_.step = last;
  state_.outcome.seconds += tess::seconds(tess::now() - begin);
  state_.outcome.add(totals, state_.problem, state_.conserved, last);
  if (options_.progress != nullptr) options_.progress->part(last + 1, options_.n_steps + 1);
}

tess::Task Simulation::show(std::vector<AtomForce>& all) {
  all = co_await state_.cells.reduce<&Cell::show>();
}

tess::Task Simulation::compare_forces() {
  if (!state_.outcome.error.empty()) co_return;
  std::vector<AtomForce> all;
  co_await show(all);
  state_.outcome.compare_forces(state_.problem, all);
}

tess::Task Simulation::return_to_start() {
  Outcome forth = state_.outcome;
  co_await reverse();
  co_await run_to(2 * options_.n_steps);
  co_await reverse();
  std::vector<AtomForce> all;
  co_await show(all);
  std::uint64_t hash = 0;
  for (const auto& [atom, force] : all) hash += hash_of(atom);
  forth.error = state_.outcome.error;
  forth.is_wrong = state_.outcome.is_wrong;
  if (hash != forth.first_hash && forth.error.empty()) {
    forth.error = "with reversed velocities the run did not return to its start";
    forth.is_wrong = true;
  }
  state_.outcome = std::move(forth);
}

tess::Task Simulation::reverse() {
  for (std::int64_t& p : state_.conserved.momentum) p = -p;
  co_await tess::epoch([&] { state_.cells.broadcast<&Cell::reverse>(); });
}

}  // namespace

tess::Task simulate(Options& options, std::vector<Atom> atoms, Outcome& outcome) {
  Simulation simulation(options);
  co_await simulation.run(atoms, outcome);
}

}  // namespace leanmd
