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

class Simulation {
 public:
  Simulation(Options options, Outcome& outcome)
      : options_(std::move(options)),
        outcome_(outcome),
        computes_(tess::create<Compute>(tess::sparse)),
        cells_(tess::create<Cell>(tess::range(n(0), n(1), n(2)), options_.problem,
                                  computes_.handle())) {}

  tess::Task run(std::vector<Atom> atoms);

 private:
  [[nodiscard]] std::int32_t n(std::size_t axis) const {
    return options_.problem.box.n_cells[axis];
  }
  /// The steps up to `last`; stops early if something is wrong.
  tess::Task run_to(std::int32_t last);
  tess::Task return_to_start();
  tess::Task reverse();
  void examine(const Totals& totals);
  tess::Task compare_forces();

  Options options_;
  Outcome& outcome_;
  tess::Scoped<tess::ArrayProxy<Compute>> computes_;
  tess::Scoped<tess::ArrayProxy<Cell>> cells_;
  std::int32_t next_ = 0;  // step
  std::int64_t n_atoms_ = 0;
  Vector momentum_{};  // at the start
};

tess::Task Simulation::run(std::vector<Atom> atoms) {
  std::map<tess::Index3, std::vector<Atom>> by_cell;
  for (const Atom& atom : atoms) {
    by_cell[options_.problem.box.cell_of(atom.at)].push_back(atom);
    for (std::size_t k = 0; k < 3; ++k) momentum_[k] += atom.velocity[k];
  }
  n_atoms_ = static_cast<std::int64_t>(atoms.size());
  co_await tess::epoch([&] {
    for (auto& [cell, own] : by_cell) cells_[cell].send<&Cell::fill>(std::move(own));
    cells_.broadcast<&Cell::create_computes>();
  });
  co_await tess::epoch([&] { cells_.broadcast<&Cell::create_section>(); });
  std::optional<tess::BalancerProxy> balancer;
  if (options_.balance) {
    balancer = tess::start_balancing(computes_.handle(), *options_.balance);
    co_await balancer->begin_phase();
  }

  const tess::Time begin = tess::now();
  co_await run_to(0);
  outcome_.first_hash = outcome_.hash;
  if (options_.check) co_await compare_forces();
  co_await run_to(options_.n_steps);
  outcome_.seconds = tess::seconds(tess::now() - begin);
  if (options_.check) co_await compare_forces();
  if (balancer) outcome_.rounds = balancer->history();
  if (!options_.reverse || !outcome_.error.empty()) co_return;

  co_await return_to_start();
}

tess::Task Simulation::return_to_start() {
  Outcome forth = outcome_;
  co_await reverse();
  co_await run_to(2 * options_.n_steps);
  co_await reverse();
  tess::Future<std::vector<Cell::AtomForce>> shown;
  cells_.broadcast<&Cell::show>(shown.callback());
  const auto all = co_await shown;
  std::uint64_t hash = 0;
  for (const auto& [atom, force] : all) hash += hash_of(atom);
  forth.error = outcome_.error;
  if (hash != forth.first_hash && forth.error.empty())
    forth.error = "with reversed velocities the run did not return to its start";
  outcome_ = std::move(forth);
}

tess::Task Simulation::reverse() {
  for (std::int64_t& p : momentum_) p = -p;
  co_await tess::epoch([&] { cells_.broadcast<&Cell::reverse>(); });
}

tess::Task Simulation::run_to(std::int32_t last) {
  while (next_ <= last && outcome_.error.empty()) {
    const std::int32_t to = next_ == 0 ? 0 : std::min(last, next_ + options_.problem.every - 1);
    tess::Future<Totals> done;
    cells_.broadcast<&Cell::begin>(Run{next_, to, done.callback()});
    const Totals totals = co_await done;
    next_ = to + 1;
    examine(totals);
    if (options_.progress != nullptr)
      options_.progress->part(static_cast<std::uint32_t>(next_),
                              static_cast<std::uint32_t>(options_.n_steps + 1));
  }
}

void Simulation::examine(const Totals& totals) {
  std::ranges::copy(totals.energies, std::back_inserter(outcome_.energies));
  outcome_.n_atoms = totals.n_atoms;
  outcome_.hash = totals.hash;
  if (totals.trouble) {
    outcome_.error = describe(totals.trouble, options_.problem);
    outcome_.energies.resize(static_cast<std::size_t>(std::max(1, totals.trouble.step)));
  } else if (totals.n_atoms != n_atoms_) {
    outcome_.error = fmt::format("{} atoms of {} are there", totals.n_atoms, n_atoms_);
  } else if (totals.momentum != momentum_) {
    outcome_.error = "the total momentum has changed: a force was lost or doubled";
  } else if (outcome_.drift() > unstable_share * outcome_.kinetic()) {
    outcome_.error = fmt::format(
        "unstable until step {}: the total energy per atom changed by {:.3g}, the kinetic energy "
        "is "
        "{:.3g}; lower --dt {}",
        next_ - 1, outcome_.drift(), outcome_.kinetic(), options_.problem.dt);
  }
}

tess::Task Simulation::compare_forces() {
  if (!outcome_.error.empty()) co_return;
  tess::Future<std::vector<Cell::AtomForce>> shown;
  cells_.broadcast<&Cell::show>(shown.callback());
  const auto all = co_await shown;
  outcome_.wrong_forces =
      std::max<std::int64_t>(0, outcome_.wrong_forces) + wrong_forces(options_.problem, all);
  if (outcome_.wrong_forces != 0)
    outcome_.error = fmt::format("{} forces differ from those of all pairs", outcome_.wrong_forces);
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

tess::Task simulate(Options options, std::vector<Atom> atoms, Outcome& outcome) {
  Simulation simulation(std::move(options), outcome);
  co_await simulation.run(std::move(atoms));
}

}  // namespace leanmd
