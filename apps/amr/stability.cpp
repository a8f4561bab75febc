#include "apps/amr/stability.hpp"

#include "apps/amr/simulate.hpp"
#include "runtime/core/error.hpp"

#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace amr {
namespace {

/// Small: each case takes a fraction of a second.
Problem small(std::int32_t least_level, std::int32_t most_level) {
  Problem problem;
  problem.least_level = least_level;
  problem.most_level = most_level;
  problem.width = 0.08;
  problem.end = 0.125;
  return problem;
}

/// Runs the problem; false if its mass changes.
tess::Task run(Problem problem, Outcome& outcome, bool& kept) {
  problem.complete();
  Settings settings{.problem = problem, .balance = {}, .checkpoints = {}};
  co_await simulate(settings, outcome);
  kept = outcome.end.norms.mass == outcome.mass_at_start;
}

/// A case, or a case and another that it is compared with.
struct Case {
  std::string name, expected;
  Problem problem;
  std::optional<Problem> other{};
  bool (*holds)(const Outcome& found, const Outcome& other);
};

/// Equal errors and blocks, up to some quanta of rounding.
bool like(const Outcome& a, const Outcome& b) {
  return a.end.n_blocks == b.end.n_blocks && std::abs(a.l1() - b.l1()) < 1e-9 * b.l1();
}
bool bounded(const Outcome& found, const Outcome& /*other*/) {
  return found.end.norms.least > -0.05 && found.end.norms.largest < 1.05;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const Problem usual = small(2, 3);

  Problem shift = small(2, 2);
  shift.cfl = 1;
  shift.velocity = {1, -1, 1};
  for (const std::int32_t order : {1, 2, 3}) {
    shift.order = order;
    all.push_back({.name = fmt::format("cfl 1, uniform, along the diagonal, order {}", order),
                   .expected = "an exact shift",
                   .problem = shift,
                   .holds = [](const Outcome& found, const Outcome&) {
                     return found.end.norms.linf < 1e-9;
                   }});
  }
  Problem edge = usual;
  edge.centre = {0.975, 0.0, 0.025};
  Problem inside = edge;
  inside.centre = {0.475, 0.5, 0.525};
  all.push_back({.name = "front at the periodic boundary",
                 .expected = "as in the middle",
                 .problem = edge,
                 .other = inside,
                 .holds = &like});
  Problem mirrored = usual;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mirrored.centre[axis] = 1 - usual.centre[axis];
    mirrored.velocity[axis] = -usual.velocity[axis];
  }
  all.push_back({.name = "velocity and place mirrored",
                 .expected = "the same errors",
                 .problem = mirrored,
                 .other = usual,
                 .holds = &like});
  Problem refined = usual;
  refined.width = 0.2;
  refined.refine = 1e-7;
  Problem uniform = refined;
  uniform.least_level = uniform.most_level;
  all.push_back({.name = "refined everywhere",
                 .expected = "the bits of a uniform tree",
                 .problem = refined,
                 .other = uniform,
                 .holds = [](const Outcome& found, const Outcome& other) {
                   return found.end.norms.hash == other.end.norms.hash && found.n_destroyed > 0;
                 }});
  Problem odd = usual;
  odd.n_cells = 10;
  all.push_back({.name = "10 cells along an edge: volumes are no powers of two",
                 .expected = "values within bounds",
                 .problem = odd,
                 .holds = &bounded});
  all.push_back({.name = "max level 0: one block, its own neighbour",
                 .expected = "one block, values within bounds",
                 .problem = small(0, 0),
                 .holds = [](const Outcome& found, const Outcome& other) {
                   return found.n_created == 1 && bounded(found, other);
                 }});
  Problem from_root = small(0, 3);
  all.push_back({.name = "levels 0 to 3: the root is destroyed",
                 .expected = "more than one level, values within bounds",
                 .problem = from_root,
                 .holds = [](const Outcome& found, const Outcome& other) {
                   return found.n_destroyed > 0 && found.end.of_level[0] == 0 &&
                          bounded(found, other);
                 }});
  for (const std::int32_t order : {1, 2, 3}) {
    Problem thin = usual;
    thin.order = order;
    thin.width = 0.012;  // less than a cell of the finest level
    all.push_back({.name = fmt::format("thin front: 0.77 cells wide, order {}", order),
                   .expected = "values within bounds",
                   .problem = thin,
                   .holds = [](const Outcome& found, const Outcome&) {
                     return found.end.norms.least > -0.2 && found.end.norms.largest < 1;
                   }});
  }
  for (const double cfl : {0.999, 1.0})
    for (const std::int32_t order : {1, 2, 3}) {
      Problem fast = usual;
      fast.order = order;
      fast.cfl = cfl;
      fast.end = 1;
      all.push_back({.name = fmt::format("cfl {}, once around, order {}", cfl, order),
                     .expected = "values within bounds",
                     .problem = fast,
                     .holds = &bounded});
    }
  return all;
}

}  // namespace

tess::Task run_stability(bool corrected, std::vector<StabilityRow>& rows,
                         void (*tell)(const StabilityRow&)) {
  for (Case& one : cases()) {
    Outcome found, other;
    bool kept = false, other_kept = true;
    one.problem.corrected = corrected;
    co_await run(one.problem, found, kept);
    if (one.other) {
      one.other->corrected = corrected;
      co_await run(*one.other, other, other_kept);
    }
    StabilityRow row{.name = one.name, .expected = one.expected, .found = {}};
    row.found =
        fmt::format("L1 {:.2e}, max {:.2e}, values {:.3f} to {:.3f}, {} blocks{}", found.l1(),
                    found.end.norms.linf, found.end.norms.least, found.end.norms.largest,
                    found.end.n_blocks, kept && other_kept ? "" : ", THE MASS CHANGED");
    row.holds = kept && other_kept && one.holds(found, other);
    tell(row);
    rows.push_back(row);
  }
  for (const double cfl : {1.0001, 2.0, 0.0, -1.0, std::nan("")}) {
    Problem unstable = small(2, 3);
    unstable.cfl = cfl;
    StabilityRow row{
        .name = fmt::format("cfl {}", cfl), .expected = "refused", .found = "accepted"};
    try {
      unstable.complete();
    } catch (const tess::Error& error) {
      row.found = "refused";
      row.holds = true;
    }
    tell(row);
    rows.push_back(row);
  }
}

}  // namespace amr
