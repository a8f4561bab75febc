// Forces, motion and the box, without chares: closed forms, symmetry, and any cut into cells.
#include "apps/leanmd/atoms.hpp"
#include "apps/leanmd/motion.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

using namespace leanmd;

namespace {

constexpr double edge = 20;

/// Two atoms at a distance along a skew line through the corner of the box.
std::vector<Position> at_distance(double r) {
  std::vector<Position> two(2);
  const std::array<double, 3> direction{2.0 / 7, 3.0 / 7, 6.0 / 7};
  for (std::size_t k = 0; k < 3; ++k)
    two[1][k] -= static_cast<std::uint64_t>(std::llrint(r * direction[k] / edge * 0x1p64));
  return two;
}

Forces of(const LennardJones& law, const std::vector<Position>& positions) {
  Forces forces;
  forces.on.resize(positions.size());
  law.add(positions, forces);
  return forces;
}

double energy(const LennardJones& law, double r) {
  return static_cast<double>(of(law, at_distance(r)).energy) * energy_quantum;
}
/// Positive if it repels.
double force(const LennardJones& law, double r) {
  return static_cast<double>(of(law, at_distance(r)).on[0][1]) * force_quantum * 7 / 3;
}

std::vector<Position> random_positions(std::size_t n, std::uint64_t seed) {
  tess::Random random(seed);
  std::vector<Position> all(n);
  for (Position& at : all)
    for (std::uint64_t& x : at) x = random();
  return all;
}

}  // namespace

TEST_CASE("with a far cutoff the law is that of Lennard and Jones", "[leanmd]") {
  const LennardJones law(edge, 10);
  CHECK(energy(law, 1) == Approx(0).margin(1e-4));
  CHECK(force(law, 1) == Approx(24).epsilon(1e-5));
  CHECK(energy(law, std::pow(2, 1.0 / 6)) == Approx(-1).epsilon(1e-4));
  CHECK(force(law, std::pow(2, 1.0 / 6)) == Approx(0).margin(1e-4));
  CHECK(energy(law, 0.5) == Approx(4 * (4096 - 64)).epsilon(1e-7));
}

TEST_CASE("the force is the negative slope of the energy, and both end at the cutoff", "[leanmd]") {
  const LennardJones law(edge, 2.5);
  for (const double r : {0.5, 0.8, 1.0, 1.3, 1.9, 2.4, 2.499}) {
    const double h = 1e-4 * r, slope = (energy(law, r + h) - energy(law, r - h)) / (2 * h);
    CHECK(force(law, r) == Approx(-slope).epsilon(1e-3).margin(2e-3));
  }
  CHECK(std::abs(energy(law, 2.4999)) < 1e-6);
  CHECK(std::abs(force(law, 2.4999)) < 1e-4);
  CHECK(force(law, 2.5001) == 0);
  CHECK(std::abs(force(law, 2.4)) > 1e-3);
}

TEST_CASE("a pair's forces are opposite to the last bit", "[leanmd]") {
  const LennardJones law(edge, 2.5);
  for (double r = 0.47; r < 2.5; r += 0.0137) {
    const Forces both = of(law, at_distance(r));
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(both.on[0][k] == -both.on[1][k]);
  }
}

TEST_CASE("the forces do not depend on the cut into cells", "[leanmd]") {
  const LennardJones law(edge, 6);
  const std::vector<Position> positions = random_positions(200, 3);
  const Forces all = of(law, positions);
  for (const std::size_t n_cells : {2U, 3U, 50U}) {
    std::vector<std::vector<Position>> cells(n_cells);
    for (std::size_t i = 0; i < positions.size(); ++i) cells[i % n_cells].push_back(positions[i]);
    std::vector<Forces> sums(n_cells);
    for (std::size_t c = 0; c < n_cells; ++c) sums[c].on.resize(cells[c].size());
    for (std::size_t a = 0; a < n_cells; ++a) {
      for (std::size_t b = a + 1; b < n_cells; ++b) {
        Forces on_a, on_b;
        on_a.on.resize(cells[a].size());
        on_b.on.resize(cells[b].size());
        if ((a + b) % 2 == 0)
          law.add(cells[a], cells[b], on_a, on_b);
        else
          law.add(cells[b], cells[a], on_b, on_a);
        sums[a] = AddForces{}(on_a, sums[a]);
        sums[b] = AddForces{}(std::move(sums[b]), on_b);
      }
      law.add(cells[a], sums[a]);
    }
    std::int64_t energies = 0;
    for (const Forces& sum : sums) energies += sum.energy;
    CHECK(energies == all.energy);
    for (std::size_t i = 0; i < positions.size(); ++i)
      REQUIRE(sums[i % n_cells].on[i / n_cells] == all.on[i]);
  }
}

TEST_CASE("the closest of the atoms that are too close is named, and adds nothing", "[leanmd]") {
  const LennardJones law(edge, 2.5);
  Forces apart = of(law, at_distance(least_distance + 1e-6));
  CHECK(apart.closest == -1);
  CHECK(force(law, least_distance + 1e-6) < 0x1p20);
  CHECK(force(law, least_distance + 1e-6) > 0.99 * 0x1p20);
  Forces close = of(law, at_distance(0.4)), closer = of(law, at_distance(0.3));
  CHECK(close.on[0] == Vector{});
  CHECK(close.closest >= 0);
  CHECK(AddForces{}(close, closer).closest_distance == Approx(0.3));
  CHECK(AddForces{}(apart, closer).closest_distance == Approx(0.3));
  CHECK(AddForces{}(closer, close).closest_distance == Approx(0.3));
  CHECK(of(law, at_distance(0)).closest_distance == 0);
}

TEST_CASE("a cell's neighbourhood has every atom within the distance", "[leanmd]") {
  const std::vector<Position> positions = random_positions(60, 5);
  const auto distance = [](const Position& a, const Position& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double way =
          edge * 0x1p-64 * static_cast<double>(static_cast<std::int64_t>(a[k] - b[k]));
      sum += way * way;
    }
    return std::sqrt(sum);
  };
  for (const Box& box :
       {Box{edge, {1, 1, 1}}, Box{edge, {2, 3, 1}}, Box{edge, {4, 4, 4}}, Box{edge, {17, 5, 9}}}) {
    for (const double reach : {1.0, 3.0, 9.9}) {
      for (const Position& a : positions) {
        const std::vector<tess::Index3> near = box.cells_within(reach, box.cell_of(a));
        const std::set<tess::Index3> known(near.begin(), near.end());
        REQUIRE(known.size() == near.size());
        for (const Position& b : positions)
          if (distance(a, b) <= reach) REQUIRE(known.contains(box.cell_of(b)));
        for (const tess::Index3& other : near) {
          const auto back = box.cells_within(reach, other);
          REQUIRE(std::ranges::find(back, box.cell_of(a)) != back.end());
          REQUIRE(pair_of(other, box.cell_of(a)) == pair_of(box.cell_of(a), other));
        }
        if (reach > 1) break;  // one cell is enough for the large neighbourhoods
      }
    }
  }
}

TEST_CASE("steps that are taken back lead to the start", "[leanmd]") {
  const Motion motion(edge, 0.004);
  const LennardJones law(edge, 2.5);
  std::vector<Atom> atoms = initial_atoms({.n_atoms = 300, .edge = edge, .gradient = 1}, motion);
  const auto hash = [&] {
    std::uint64_t sum = 0;
    for (const Atom& atom : atoms) sum += hash_of(atom);
    return sum;
  };
  const auto forces = [&] {
    std::vector<Position> positions;
    for (const Atom& atom : atoms) positions.push_back(atom.at);
    return of(law, positions);
  };
  const std::uint64_t start = hash();
  for (const int turn : {0, 1}) {
    Forces now = forces();
    for (int step = 0; step < 50; ++step) {
      Motion::kick(atoms, now.on);
      motion.drift(atoms);
      now = forces();
      Motion::kick(atoms, now.on);
    }
    CHECK(hash() != start);
    for (Atom& atom : atoms)
      for (std::int64_t& v : atom.velocity) v = -v;
    CHECK((hash() == start) == (turn == 1));
  }
}

TEST_CASE("the forces of the start give no kick, and those of a step one", "[leanmd]") {
  const std::vector<Vector> force{{300, -2000, 10000}};
  for (const std::int32_t step : {0, 1}) {
    std::vector<Atom> one{Atom{7, {}, {5, 6, 7}}};
    Atoms atoms(Problem{.box = {edge, {4, 4, 4}}});
    atoms.add(one);
    (void)atoms.finish(Forces{.step = step, .on = force});
    if (step == 1) Motion::kick(one, force);
    CHECK(atoms.with_forces().front().first.velocity == one.front().velocity);
  }
}

TEST_CASE("the atoms of the start are at rest together, and denser where the gradient says",
          "[leanmd]") {
  const Motion motion(edge, 0.004);
  for (const double gradient : {0.0, 0.5, 1.0}) {
    const auto atoms = initial_atoms({.n_atoms = 4000, .edge = edge, .gradient = gradient}, motion);
    REQUIRE(atoms.size() == 4000);
    Vector sum{};
    std::set<Position> places;
    double n_left = 0, kinetic = 0;
    for (const Atom& atom : atoms) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += atom.velocity[k];
      places.insert(atom.at);
      n_left += atom.at[0] >> 63U ? 0 : 1;
      kinetic += static_cast<double>(motion.energy(atom)) * energy_quantum;
    }
    CHECK(sum == Vector{});
    CHECK(places.size() == atoms.size());
    CHECK(kinetic / 4000 == Approx(1.5).epsilon(0.05));
    // The share of the left half; without saturation of the lattice 1/2 + gradient/4.
    CHECK(n_left / 4000 == Approx(0.5 + 0.2 * gradient).margin(0.05));
  }
  CHECK(initial_atoms({.n_atoms = 1, .edge = edge}, motion).front().velocity != Vector{});
}

TEST_CASE("of the troubles of all cells the first is kept, in any order", "[leanmd]") {
  std::vector<Totals> parts(4);
  parts[1].trouble = {5, Trouble::Kind::too_fast, 600, 3};
  parts[2].trouble = {4, Trouble::Kind::too_far, 1, 8};
  parts[3].trouble = {4, Trouble::Kind::too_close, 0.3, 9};
  std::vector<std::size_t> order{0, 1, 2, 3};
  do {
    Totals all;
    for (const std::size_t i : order) all = all + parts[i];
    CHECK(all.trouble == parts[3].trouble);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("between two exchanges the ways of all steps add up, and may not exceed half the skin",
          "[leanmd]") {
  Problem problem;
  problem.box = {edge, {4, 4, 4}};
  problem.skin = 0.4;
  problem.exchange_every = 10;
  problem.dt = 0.01;
  const Motion motion(edge, problem.dt);
  // The largest number of steps, of 0.01 v each, that stay within 0.2.
  for (const auto& [v, n_steps] : {std::pair{1.9, 9}, {3.3, 6}, {9.0, 2}, {21.0, 0}}) {
    INFO("speed " << v);
    Atoms atoms(problem);
    atoms.add({Atom{7, {}, {motion.velocity(v), 0, 0}}});
    (void)atoms.finish(Forces{.step = 0, .on = {Vector{}}});
    std::int32_t step = 1;
    for (; step <= 9; ++step) {
      atoms.advance(step);
      if (atoms.totals({}).trouble) break;
    }
    CHECK(step - 1 == n_steps);
    if (step > 9) {  // an exchange takes it into the next cell, and the sum begins anew
      atoms.advance(10);
      for (std::int32_t after = 11; after <= 19; ++after) atoms.advance(after);
      CHECK_FALSE(atoms.totals({}).trouble);
    } else {
      const Trouble trouble = atoms.totals({}).trouble;
      CHECK(trouble.kind == Trouble::Kind::too_far);
      CHECK(trouble.step == step);
      CHECK(trouble.atom == 7);
      CHECK(trouble.value == Approx(0.01 * v * step));
    }
  }
}
