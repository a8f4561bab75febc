// The parts of the stability report. Private to it.
#pragma once

#include "apps/kit/worst.hpp"
#include "apps/particles/stability/cases.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"

#include <utility>

namespace tess::dn::stability {

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

/// Springs, drags, surface flow, impacts: against closed forms.
void stiff_rules(Rows& rows);
/// Speed, corners, starts, spin, scale, offset, rest, all rules at once: against bounds.
void extreme_motion(Rows& rows);
void extreme_places(Rows& rows);

}  // namespace tess::dn::stability
