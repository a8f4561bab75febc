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

using Holds = bool (*)(const Outcome& found, const Outcome& other);

/// A case, or a case and another that it is compared with.
struct Case {
  std::string name, expected;
  Problem problem;
  Holds holds;
  std::optional<Problem> other;
};

/// Equal errors and blocks, up to some quanta of rounding.
bool like(const Outcome& a, const Outcome& b) {
  return a.end.n_blocks == b.end.n_blocks && std::abs(a.l1() - b.l1()) < 1e-9 * b.l1();
}
bool bounded(const Outcome& found, const Outcome& /*other*/) {
  return found.end.norms.least > -0.05 && found.end.norms.largest < 1.05;
}

/// The same, and the L1 error is below so many percent of the mass. That of a field that has not
/// moved is twice the mass.
template <int percent>
bool arrives(const Outcome& found, const Outcome& other) {
  return bounded(found, other) &&
         found.l1() < percent * 0.01 * static_cast<double>(found.end.norms.mass) * 0x1p-60;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](std::string name, std::string expected, const Problem& problem, Holds holds,
                       std::optional<Problem> other = {}) {
    all.push_back({std::move(name), std::move(expected), problem, holds, std::move(other)});
  };
  const char* const within = "values within bounds";
  const Problem usual = small(2, 3);

  Problem now = small(2, 2);
  now.cfl = 1;
  now.velocity = {1, -1, 1};
  for (const std::int32_t order : {1, 2, 3}) {
    now.order = order;
    add(fmt::format("cfl 1, uniform, along the diagonal, order {}", order), "an exact shift", now,
        [](const Outcome& found, const Outcome&) { return found.end.norms.linf < 1e-9; });
  }
  now = usual;
  now.centre = {0.975, 0.0, 0.025};
  Problem other = usual;
  other.centre = {0.475, 0.5, 0.525};
  add("front at the periodic boundary", "as in the middle", now, &like, other);
  now = usual;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    now.centre[axis] = 1 - usual.centre[axis];
    now.velocity[axis] = -usual.velocity[axis];
  }
  add("velocity and place mirrored", "the same errors", now, &like, usual);
  now = usual;
  now.width = 0.2;
  now.refine = 1e-7;
  other = now;
  other.least_level = other.most_level;
  const Holds has_its_bits = [](const Outcome& found, const Outcome& uniform) {
    return found.end.norms.hash == uniform.end.norms.hash && found.n_destroyed > 0;
  };
  add("refined everywhere", "the bits of a uniform tree", now, has_its_bits, other);
  now = usual;
  now.n_cells = 10;
  add("10 cells along an edge: volumes are no powers of two", within, now, &bounded);
  add("max level 0: one block, its own neighbour", "one block, values within bounds", small(0, 0),
      [](const Outcome& found, const Outcome& none) {
        return found.n_created == 1 && bounded(found, none);
      });
  add("levels 0 to 3: the root is destroyed", "more than one level, values within bounds",
      small(0, 3), [](const Outcome& found, const Outcome& none) {
        return found.n_destroyed > 0 && found.end.of_level[0] == 0 && bounded(found, none);
      });
  now = usual;
  now.width = 0.012;  // less than a cell of the finest level
  for (const std::int32_t order : {1, 2, 3}) {
    now.order = order;
    add(fmt::format("thin front: 0.77 cells wide, order {}", order), within, now,
        [](const Outcome& found, const Outcome&) {
          return found.end.norms.least > -0.2 && found.end.norms.largest < 1;
        });
  }
  now = usual;
  now.end = 1;
  for (const double cfl : {0.999, 1.0})
    for (const std::int32_t order : {1, 2, 3}) {
      now.order = order;
      now.cfl = cfl;
      add(fmt::format("cfl {}, once around, order {}", cfl, order),
          order == 1 ? "values within bounds, an error below half of the mass"
                     : "values within bounds, an error below 3 % of the mass",
          now, order == 1 ? &arrives<50> : &arrives<3>);
    }
  return all;
}

}  // namespace

tess::Task run_stability(bool corrected, kit::Cases<>& report) {
  for (Case& one : cases()) {
    Outcome found, other;
    bool kept = false, other_kept = true;
    one.problem.corrected = corrected;
    co_await run(one.problem, found, kept);
    if (one.other) {
      one.other->corrected = corrected;
      co_await run(*one.other, other, other_kept);
    }
    report.add(
        {.name = one.name,
         .parameter = "L1",
         .value = found.l1(),
         .ok = kept && other_kept && one.holds(found, other),
         .note = fmt::format("{}; max {:.2e}, values {:.3f} to {:.3f}, {} blocks{}", one.expected,
                             found.end.norms.linf, found.end.norms.least, found.end.norms.largest,
                             found.end.n_blocks, kept && other_kept ? "" : ", THE MASS CHANGED")});
  }
  for (const double cfl : {1.0001, 2.0, 0.0, -1.0, std::nan("")}) {
    Problem unstable = small(2, 3);
    unstable.cfl = cfl;
    bool is_refused = false;
    try {
      unstable.complete();
    } catch (const tess::Error&) {
      is_refused = true;
    }
    report.add({.name = fmt::format("cfl {}", cfl),
                .parameter = "cfl",
                .value = cfl,
                .ok = is_refused,
                .note = is_refused ? "refused" : "accepted, but it is unstable"});
  }
}

}  // namespace amr
