// The stability report: stiff and extreme cases of every rule against closed forms and bounds. The
// program prints it (--stability), a test asserts it. It takes about a second.
#pragma once

#include "apps/kit/cases.hpp"
#include "apps/kit/worst.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"

#include <utility>
#include <vector>

namespace tess::dn {

[[nodiscard]] std::vector<kit::Case> stability_report();

// Its parts.
namespace stability {

using kit::worsen;

struct Rows {
  std::vector<kit::Case> rows;

  void add(std::string name, std::string parameter, double value, double met, double tolerance) {
    rows.push_back(
        {std::move(name), std::move(parameter), value, met, tolerance, met <= tolerance});
  }
};

struct Particle {
  Vec3 position, velocity;
};
/// Impacts only.
[[nodiscard]] Rules impact(double restitution, Sweep sweep, LookUp look_up = LookUp::tangent);

/// A particle after n_steps.
[[nodiscard]] Particle flown(const Rules& rules, double step, int n_steps,
                             std::span<const Object> objects, Particle start);

/// Speed, corners, starts, spin, scale, offset, rest, all rules at once: against bounds.
void extreme_motion(Rows& rows);
void extreme_places(Rows& rows);

}  // namespace stability
}  // namespace tess::dn
