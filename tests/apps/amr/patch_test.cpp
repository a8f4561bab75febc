// The cells of a block, without messages.
#include "apps/amr/patch.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/serialize.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace amr;

namespace {

Quanta sum(const std::vector<Quanta>& masses) {
  return std::accumulate(masses.begin(), masses.end(), Quanta{0});
}

Problem usual(std::int32_t n_cells) {
  Problem problem;
  problem.n_cells = n_cells;
  problem.width = 0.15;
  problem.complete();
  return problem;
}

/// The masses of u = 1 + x + 2 y + 4 z in a block.
std::vector<Quanta> linear(const Problem& problem, BlockIndex index) {
  const double h = problem.spacing(index.level());
  const auto low = Patch(problem, index).low();
  std::vector<Quanta> masses;
  for (std::int32_t z = 0; z < problem.n_cells; ++z)
    for (std::int32_t y = 0; y < problem.n_cells; ++y)
      for (std::int32_t x = 0; x < problem.n_cells; ++x) {
        const double u = 1 + (low[0] + (x + 0.5) * h) + 2 * (low[1] + (y + 0.5) * h) +
                         4 * (low[2] + (z + 0.5) * h);
        masses.push_back(std::llrint(u * h * h * h * 0x1p60));
      }
  return masses;
}

/// The largest difference, in values of cells of this level.
double apart(const Problem& problem, BlockIndex index, const std::vector<Quanta>& a,
             const std::vector<Quanta>& b) {
  REQUIRE(a.size() == b.size());
  Quanta most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return static_cast<double>(most) / (std::pow(problem.spacing(index.level()), 3) * 0x1p60);
}

}  // namespace

TEST_CASE("refining keeps the mass and linear fields, and coarsening is its inverse",
          "[apps][amr]") {
  for (const std::int32_t n_cells : {4, 8, 10}) {
    CAPTURE(n_cells);
    const Problem problem = usual(n_cells);
    const BlockIndex index = BlockIndex{}.child(3).child(6);
    Patch parent(problem, index);
    const std::vector<Quanta> before = linear(problem, index);
    parent.take(before);
    Patch merged(problem, index);
    Quanta total = 0;
    for (std::int32_t octant = 0; octant < n_octants; ++octant) {
      const std::vector<Quanta> masses = parent.refined(octant);
      total += sum(masses);
      const BlockIndex below = index.child(octant);
      CHECK(apart(problem, below, masses, linear(problem, below)) < 1e-9);
      Patch child(problem, below);
      child.take(masses);
      merged.take(octant, child.coarsened());
    }
    CHECK(total == sum(before));
    Quanta changed = 0;  // of cells, not only in total
    for (std::int32_t octant = 0; octant < n_octants; ++octant) {
      const auto a = merged.refined(octant), b = parent.refined(octant);
      for (std::size_t i = 0; i < a.size(); ++i) changed += std::abs(a[i] - b[i]);
    }
    CHECK(changed == 0);
  }
}

TEST_CASE("neighbours of three levels see the same linear field at a face", "[apps][amr]") {
  const Problem problem = usual(8);
  const BlockIndex index = BlockIndex{}.child(0).child(7);  // none of the blocks is at the border
  for (Face face = 0; face < n_faces; ++face) {
    CAPTURE(face);
    Patch here(problem, index);
    here.take(linear(problem, index));
    for (std::int32_t quadrant = 0; quadrant < n_quadrants; ++quadrant) {
      // What the finer block inside this one's face shows is what this one interpolates there.
      const BlockIndex inside = index.child(octant_at(face, quadrant));
      Patch fine(problem, inside);
      fine.take(linear(problem, inside));
      const std::vector<double> shown = fine.layers(face);
      const std::vector<double> interpolated = here.fine_layers(face, quadrant);
      REQUIRE(shown.size() == interpolated.size());
      for (std::size_t i = 0; i < shown.size(); ++i)
        CHECK(std::abs(shown[i] - interpolated[i]) < 1e-8);
      // And its means are the values of this block's cells.
      const std::vector<double> means = fine.coarse_layers(face), values = here.layers(face);
      for (std::int32_t layer = 0; layer < 2; ++layer)
        for (std::int32_t row = 0; row < 4; ++row)
          for (std::int32_t column = 0; column < 4; ++column)
            CHECK(std::abs(
                      means[static_cast<std::size_t>((layer * 4 + row) * 4 + column)] -
                      values[static_cast<std::size_t>((layer * 8 + (quadrant >> 1) * 4 + row) * 8 +
                                                      (quadrant & 1) * 4 + column)]) < 1e-8);
    }
  }
}

TEST_CASE("a periodic block alone follows a plain solver on a grid, in each order and direction",
          "[apps][amr]") {
  for (const std::int32_t order : {1, 2, 3})
    for (const double sign : {1.0, -1.0}) {
      CAPTURE(order, sign);
      Problem problem;
      problem.n_cells = 12;
      problem.least_level = problem.most_level = 0;
      problem.order = order;
      problem.width = 0.15;
      problem.velocity = {sign, -0.5 * sign, 0.25};
      problem.complete();
      Patch patch(problem, BlockIndex{});
      patch.fill(0);
      constexpr std::int32_t n = 12;
      const double h = 1.0 / n;
      const auto at = [](std::int32_t x, std::int32_t y, std::int32_t z) {
        return static_cast<std::size_t>((((z + n) % n) * n + (y + n) % n) * n + (x + n) % n);
      };
      std::vector<double> u(n * n * n);
      for (std::int32_t z = 0; z < n; ++z)
        for (std::int32_t y = 0; y < n; ++y)
          for (std::int32_t x = 0; x < n; ++x)
            u[at(x, y, z)] = problem.mean(0, x * h, h, 0) * problem.mean(1, y * h, h, 0) *
                             problem.mean(2, z * h, h, 0);
      for (std::int32_t sweep = 0; sweep < 9; ++sweep) {
        const std::int32_t axis = sweep % 3;
        patch.set_halo(2 * axis, patch.layers(2 * axis + 1));
        patch.set_halo(2 * axis + 1, patch.layers(2 * axis));
        patch.compute_flows(axis);
        patch.apply_flows(axis);

        const double c = problem.velocity[static_cast<std::size_t>(axis)] * problem.dt / h;
        const auto next = [&](std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t by) {
          return u[at(x + (axis == 0 ? by : 0), y + (axis == 1 ? by : 0),
                      z + (axis == 2 ? by : 0))];
        };
        // The value that leaves through the upper face of a cell, times c.
        const auto flow = [&](std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t by) {
          const std::int32_t down = c >= 0 ? 1 : -1;  // downwind
          const std::int32_t upwind = by + (c >= 0 ? 0 : 1);
          const double here = next(x, y, z, upwind), ahead = next(x, y, z, upwind + down) - here;
          const double behind = here - next(x, y, z, upwind - down);
          const double w = order == 3 ? (2 - std::abs(c)) / 3 : 0.5;
          const double slope = order == 1 ? 0 : w * ahead + (1 - w) * behind;
          return c * (here + (1 - std::abs(c)) / 2 * slope);
        };
        std::vector<double> after = u;
        for (std::int32_t z = 0; z < n; ++z)
          for (std::int32_t y = 0; y < n; ++y)
            for (std::int32_t x = 0; x < n; ++x)
              after[at(x, y, z)] += flow(x, y, z, -1) - flow(x, y, z, 0);
        u = after;
      }
      const std::vector<double> above = patch.layers(4);  // z = 0 and 1: rows along y
      double most = 0;
      for (std::int32_t layer = 0; layer < 2; ++layer)
        for (std::int32_t y = 0; y < n; ++y)
          for (std::int32_t x = 0; x < n; ++x)
            most =
                std::max(most, std::abs(above[static_cast<std::size_t>((layer * n + y) * n + x)] -
                                        u[at(x, y, layer)]));
      const std::vector<double> middle = patch.layers(0);  // x = 0 and 1: columns along y
      for (std::int32_t z = 0; z < n; ++z)
        for (std::int32_t y = 0; y < n; ++y)
          most = std::max(most,
                          std::abs(middle[static_cast<std::size_t>(z * n + y)] - u[at(0, y, z)]));
      CHECK(most < 1e-12);
    }
}

TEST_CASE("a patch that is packed in the middle of a sweep goes on as it would", "[apps][amr]") {
  const Problem problem = usual(6);
  Patch patch(problem, BlockIndex{}.child(1));
  patch.fill(0);
  patch.set_halo(0, patch.layers(1));
  patch.set_halo(1, patch.layers(0));
  Patch early = tess::from_bytes<Patch>(tess::to_bytes(patch));
  patch.compute_flows(0);
  early.compute_flows(0);
  Patch late = tess::from_bytes<Patch>(tess::to_bytes(patch));
  const auto before = patch.compare(0.1).hash;
  for (Patch* const one : {&patch, &early, &late}) one->apply_flows(0);
  CHECK(patch.compare(0.1).hash != before);
  CHECK(early.compare(0.1).hash == patch.compare(0.1).hash);
  CHECK(late.compare(0.1).hash == patch.compare(0.1).hash);
  CHECK(late.compare(0.1).l1 == patch.compare(0.1).l1);
}

TEST_CASE("the norms of a field that is off by a constant are those of the constant",
          "[apps][amr]") {
  Problem problem;
  problem.n_cells = 4;
  problem.width = 0.05;
  problem.complete();
  const BlockIndex index = BlockIndex::at(3, {0, 0, 0});  // so far away that the field is 0
  Patch patch(problem, index);
  patch.fill(0);
  CHECK(patch.compare(0).largest == 0);
  const double off = 0.25, volume = std::pow(0.125, 3) * 0x1p60;  // of the block, in quanta
  for (const double sign : {1.0, -1.0}) {
    patch.take(std::vector<Quanta>(64, std::llrint(sign * off * volume / 64)));
    const Norms norms = patch.compare(0);
    CHECK(static_cast<double>(norms.mass) == Approx(sign * off * volume));
    CHECK(static_cast<double>(norms.l1) == Approx(off * volume));
    CHECK(static_cast<double>(norms.l2) == Approx(off * off * volume));
    CHECK(norms.linf == Approx(off));
    CHECK(norms.largest == Approx(sign * off));
    CHECK(norms.least == Approx(sign * off));
  }
}

TEST_CASE("mean() is the integral of the Gaussian, also across the border", "[apps][amr]") {
  Problem problem = usual(8);
  problem.centre = {0.95, 0.5, 0.5};
  for (const double low : {0.0, 0.3, 0.9}) {
    constexpr int n = 20000;
    const double h = 0.125;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double x = low + (i + 0.5) * h / n;
      for (const double image : {-1.0, 0.0, 1.0}) {
        const double d = (x - 0.95 + image) / problem.width;
        sum += std::exp(-d * d / 2);
      }
    }
    CHECK(problem.mean(0, low, h, 0) == Approx(sum / n).epsilon(1e-7));
  }
  CHECK(problem.mean(0, 0.5, 0.1, 0.25) == Approx(problem.mean(0, 0.25, 0.1, 0)).epsilon(1e-12));
}

TEST_CASE("problems that cannot be computed are refused", "[apps][amr]") {
  const auto refused = [](auto change) {
    Problem problem;
    change(problem);
    CHECK_THROWS_AS(problem.complete(), tess::Error);
  };
  refused([](Problem& p) { p.cfl = 1.0001; });
  refused([](Problem& p) { p.cfl = std::nan(""); });
  refused([](Problem& p) { p.n_cells = 7; });
  refused([](Problem& p) { p.n_cells = 2; });
  refused([](Problem& p) { p.least_level = 5; });
  refused([](Problem& p) { p.velocity = {}; });
  refused([](Problem& p) { p.velocity[1] = std::nan(""); });
  refused([](Problem& p) { p.centre[2] = std::nan(""); });
  refused([](Problem& p) { p.velocity = {1e-320, 0, 0}, p.n_steps = 1; });
}

TEST_CASE("a way that is too short to be a number takes one step", "[apps][amr]") {
  Problem problem;
  problem.velocity = {1e-200, 0, 0};
  problem.end = 1e-200;
  problem.complete();
  CHECK(problem.n_steps == 1);
  CHECK(problem.dt == 1e-200);
}
