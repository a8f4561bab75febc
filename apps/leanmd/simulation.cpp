#include "apps/leanmd/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace leanmd {
namespace {

/// Above this share of the kinetic energy a change of the total energy is an instability.
constexpr double unstable_share = 0.1;

std::string describe(const Trouble& trouble, const Problem& problem) {
  const std::string where = fmt::format("step {}, atom {}: ", trouble.step, trouble.atom);
  switch (trouble.kind) {
    case Trouble::Kind::too_close:
      return where + fmt::format(
                         "another atom is at distance {:.4g}, closer than {}; lower --dt {} "
                         "or give atoms more room (--density)",
                         trouble.value, least_distance, problem.dt);
    case Trouble::Kind::too_fast:
      return where + fmt::format(
                         "its speed {:.4g} is too fast for --dt {}: it crosses a cell; lower "
                         "--dt, or give fewer --cells",
                         trouble.value, problem.dt);
    case Trouble::Kind::too_far:
      break;
  }
  return where + fmt::format(
                     "it may have moved by {:.4g} since the last exchange, more than half of "
                     "--skin {}; lower --exchange {} or --dt {}",
                     trouble.value, problem.skin, problem.exchange_every, problem.dt);
}

/// The number of atoms whose force is not, bit for bit, the sum over all pairs.
std::int64_t wrong_forces(const Problem& problem, const std::vector<Cell::AtomForce>& all) {
  std::vector<Position> positions;
  positions.reserve(all.size());
  for (const auto& [atom, force] : all) positions.push_back(atom.at);
  Forces expected;
  expected.on.resize(all.size());
  LennardJones(problem.box.edge, problem.cutoff).add(positions, expected);
  std::int64_t n = 0;
  for (std::size_t i = 0; i < all.size(); ++i) n += all[i].second == expected.on[i] ? 0 : 1;
  return n;
}

/// All that a checkpoint holds beside the elements.
struct State {
  Problem problem;
  tess::ArrayProxy<Compute> computes;
  tess::ArrayProxy<Cell> cells;
  std::int32_t step = 0;  // done
  std::int64_t n_atoms = 0;
  Vector momentum{};  // at the start
  Outcome outcome;    // so far
  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem, computes, cells, step, n_atoms, momentum, outcome);
  }
};

class Simulation {
 public:
  explicit Simulation(Options& options) : options_(options) {}

  tess::Task run(std::vector<Atom> atoms);
  Outcome end();

 private:
  tess::Task create(const std::vector<Atom>& atoms);
  /// The steps up to `last`; stops early if something is wrong.
  tess::Task run_to(std::int32_t last);
  /// The steps after the last one that is done, up to `to`.
  tess::Task run_part(std::int32_t first, std::int32_t to);
  tess::Task return_to_start();
  tess::Task reverse();
  void examine(const Totals& totals);
  tess::Task compare_forces();

  Options& options_;
  State state_;
};

tess::Task Simulation::create(const std::vector<Atom>& atoms) {
  const Box& box = options_.problem.box;
  state_.problem = options_.problem;
  state_.computes = tess::create<Compute>(tess::sparse);
  state_.cells = tess::create<Cell>(tess::range(box.n_cells[0], box.n_cells[1], box.n_cells[2]),
                                    state_.problem, state_.computes);
  std::map<tess::Index3, std::vector<Atom>> by_cell;
  for (const Atom& atom : atoms) {
    by_cell[box.cell_of(atom.at)].push_back(atom);
    for (std::size_t k = 0; k < 3; ++k) state_.momentum[k] += atom.velocity[k];
  }
  state_.n_atoms = static_cast<std::int64_t>(atoms.size());
  co_await tess::epoch([&] {
    for (auto& [cell, own] : by_cell) state_.cells[cell].send<&Cell::fill>(std::move(own));
    state_.cells.broadcast<&Cell::create_computes>();
  });
  co_await tess::epoch([&] { state_.cells.broadcast<&Cell::create_section>(); });
}

tess::Task Simulation::run(std::vector<Atom> atoms) {
  const bool restarts = options_.checkpoints.restarts();
  if (restarts)
    co_await options_.checkpoints.restart(state_, options_.n_steps);
  else
    co_await create(atoms);
  options_.problem = state_.problem;
  std::optional<tess::BalancerProxy> balancer;
  if (options_.balance) balancer = tess::start_balancing(state_.computes, *options_.balance);
  const bool has_barrier = balancer && options_.balance->when != tess::BalanceWhen::periodic;
  co_await tess::epoch([&] {
    state_.computes.broadcast<&Compute::set_barrier>(has_barrier ? state_.problem.every : 0);
  });
  if (balancer && restarts) co_await balancer->place_again();
  if (balancer && !restarts) co_await balancer->begin_phase();

  Outcome& outcome = state_.outcome;
  if (!restarts) {
    co_await run_part(0, 0);
    outcome.first_hash = outcome.hash;
    if (options_.check) co_await compare_forces();
  }
  co_await run_to(options_.n_steps);
  if (options_.check) co_await compare_forces();
  if (balancer) outcome.rounds = balancer->history();
  if (options_.reverse && outcome.error.empty()) co_await return_to_start();
}

Outcome Simulation::end() {
  state_.cells.destroy();
  state_.computes.destroy();
  return std::move(state_.outcome);
}

tess::Task Simulation::return_to_start() {
  Outcome forth = state_.outcome;
  co_await reverse();
  co_await run_to(2 * options_.n_steps);
  co_await reverse();
  tess::Future<std::vector<Cell::AtomForce>> shown;
  state_.cells.broadcast<&Cell::show>(shown.callback());
  const auto all = co_await shown;
  std::uint64_t hash = 0;
  for (const auto& [atom, force] : all) hash += hash_of(atom);
  forth.error = state_.outcome.error;
  if (hash != forth.first_hash && forth.error.empty())
    forth.error = "with reversed velocities the run did not return to its start";
  state_.outcome = std::move(forth);
}

tess::Task Simulation::reverse() {
  for (std::int64_t& p : state_.momentum) p = -p;
  co_await tess::epoch([&] { state_.cells.broadcast<&Cell::reverse>(); });
}

tess::Task Simulation::run_to(std::int32_t last) {
  while (state_.step < last && state_.outcome.error.empty()) {
    const std::int32_t from = state_.step, every = state_.problem.every;
    const std::int32_t pause = options_.checkpoints.pause_after(from, last);
    co_await run_part(from + 1, std::min(pause, (from / every + 1) * every));
    if (state_.outcome.error.empty())
      co_await options_.checkpoints.save_if_due(state_, from, options_.n_steps);
  }
}

tess::Task Simulation::run_part(std::int32_t first, std::int32_t to) {
  const tess::Time begin = tess::now();
  tess::Future<Totals> done;
  state_.cells.broadcast<&Cell::begin>(Run{first, to, done.callback()});
  const Totals totals = co_await done;
  state_.step = to;
  state_.outcome.seconds += tess::seconds(tess::now() - begin);
  examine(totals);
  if (options_.progress != nullptr)
    options_.progress->part(static_cast<std::uint32_t>(to + 1),
                            static_cast<std::uint32_t>(options_.n_steps + 1));
}

void Simulation::examine(const Totals& totals) {
  Outcome& outcome = state_.outcome;
  std::ranges::copy(totals.energies, std::back_inserter(outcome.energies));
  outcome.n_atoms = totals.n_atoms;
  outcome.hash = totals.hash;
  if (totals.trouble) {
    outcome.error = describe(totals.trouble, state_.problem);
    outcome.energies.resize(static_cast<std::size_t>(std::max(1, totals.trouble.step)));
  } else if (totals.n_atoms != state_.n_atoms) {
    outcome.error = fmt::format("{} atoms of {} are there", totals.n_atoms, state_.n_atoms);
  } else if (totals.momentum != state_.momentum) {
    outcome.error = "the total momentum has changed: a force was lost or doubled";
  } else if (outcome.drift() > unstable_share * outcome.kinetic()) {
    outcome.error = fmt::format(
        "unstable until step {}: the total energy per atom changed by {:.3g}, the kinetic energy "
        "is "
        "{:.3g}; lower --dt {}",
        state_.step, outcome.drift(), outcome.kinetic(), state_.problem.dt);
  }
}

tess::Task Simulation::compare_forces() {
  Outcome& outcome = state_.outcome;
  if (!outcome.error.empty()) co_return;
  tess::Future<std::vector<Cell::AtomForce>> shown;
  state_.cells.broadcast<&Cell::show>(shown.callback());
  const auto all = co_await shown;
  outcome.wrong_forces =
      std::max<std::int64_t>(0, outcome.wrong_forces) + wrong_forces(state_.problem, all);
  if (outcome.wrong_forces != 0)
    outcome.error = fmt::format("{} forces differ from those of all pairs", outcome.wrong_forces);
}

}  // namespace

double Outcome::energy() const {
  return static_cast<double>(energies.front()[2]) * energy_quantum / static_cast<double>(n_atoms);
}

double Outcome::drift() const {
  std::int64_t most = 0;
  for (const Vector& one : energies) most = std::max(most, std::abs(one[2] - energies.front()[2]));
  return static_cast<double>(most) * energy_quantum / static_cast<double>(n_atoms);
}

double Outcome::kinetic() const {
  std::int64_t most = 0;
  for (const Vector& one : energies) most = std::max(most, one[0]);
  return static_cast<double>(most) * energy_quantum / static_cast<double>(n_atoms);
}

tess::Task simulate(Options& options, std::vector<Atom> atoms, Outcome& outcome) {
  Simulation simulation(options);
  co_await simulation.run(std::move(atoms));
  outcome = simulation.end();
}

}  // namespace leanmd
