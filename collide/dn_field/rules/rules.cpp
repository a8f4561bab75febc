#include "collide/dn_field/rules.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

namespace tess::dn {
namespace {

/// The remedy is for values below `least`.
void check(std::string_view key, double value, double least = -HUGE_VAL,
           std::string_view remedy = {}) {
  if (!std::isfinite(value))
    fail(ErrorCode::bad_value, key, " is ", value, "; give a finite number");
  if (value < least) fail(ErrorCode::bad_value, key, " is ", value, "; ", remedy);
}
void not_negative(std::string_view key, double value, std::string_view remedy) {
  check(key, value, 0, remedy);
}
void positive(std::string_view key, double value, std::string_view remedy) {
  check(key, value, std::numeric_limits<double>::denorm_min(), remedy);
}

void check(std::string_view key, Vec3 value) {
  if (!is_finite(value))
    fail(ErrorCode::bad_value, key, " is (", value.x, ", ", value.y, ", ", value.z,
         "); give three finite numbers");
}

constexpr std::string_view no_push = "a negative rate would drive particles; give zero or more";

void validate(const Spring& spring) {
  positive("spring.stiffness", spring.stiffness, "give a positive one, or leave the spring out");
  not_negative("spring.damping", spring.damping, no_push);
  check("spring.reach", spring.reach);
  const double critical = 2 * std::sqrt(spring.stiffness);
  if (!(spring.damping <= 0.999 * critical))
    fail(ErrorCode::bad_value, "spring.damping is ", spring.damping,
         "; stay below 0.999 × critical (2 √stiffness = ", critical,
         "), or use impact with restitution 0");
}

void validate(const Impact& impact) {
  check("impact.restitution", impact.restitution);
  if (impact.restitution < 0 || impact.restitution > 1)
    fail(ErrorCode::bad_value, "impact.restitution is ", impact.restitution,
         "; give 0 (slides) to 1 (no loss), more would make energy");
  not_negative("impact.threshold", impact.threshold, "give the particles' radius, zero or more");
}

void validate(const Explosion& explosion) {
  check("explosion.centre", explosion.centre);
  check("explosion.strength", explosion.strength);
  positive("explosion.radius", explosion.radius, "give how far it reaches");
  check("explosion.start", explosion.start);
  not_negative("explosion.duration", explosion.duration, "give how long it lasts");
}

}  // namespace

void validate(const Rules& rules) {
  if (rules.spring) validate(*rules.spring);
  if (rules.spring && rules.look_up == LookUp::nearest)
    fail(ErrorCode::bad_value, "look_up is nearest, which springs do not support; take tangent");
  if (rules.impact) validate(*rules.impact);
  if (const auto& drag = rules.surface_drag) {
    not_negative("surface_drag.rate", drag->rate, no_push);
    not_negative("surface_drag.threshold", drag->threshold, "give the distance it reaches");
  }
  if (const auto& flow = rules.surface_flow) {
    check("surface_flow.alpha_in", flow->alpha_in);
    check("surface_flow.alpha_out", flow->alpha_out);
    not_negative("surface_flow.distance", flow->distance, "give the distance it reaches");
  }
  if (rules.gravity) check("gravity.acceleration", rules.gravity->acceleration);
  if (rules.wind) {
    check("wind.velocity", rules.wind->velocity);
    not_negative("wind.rate", rules.wind->rate, no_push);
  }
  if (rules.air_drag) not_negative("air_drag.rate", rules.air_drag->rate, no_push);
  for (const Explosion& explosion : rules.explosions) validate(explosion);
}

bool needs_field(const Rules& rules) {
  return rules.spring || rules.impact || rules.surface_drag || rules.surface_flow;
}

Content needed_content(const Rules& rules) {
  const bool by_normal = rules.spring || rules.impact || rules.surface_flow;
  const bool by_look_up = needs_field(rules) && rules.look_up == LookUp::tangent;
  return by_normal || by_look_up ? Content::distance_and_normal : Content::distance;
}

double reach(const Rules& rules) {
  double furthest = 0;
  if (rules.spring) furthest = std::max(furthest, rules.spring->reach);
  if (rules.impact) furthest = std::max(furthest, rules.impact->threshold);
  if (rules.surface_drag) furthest = std::max(furthest, rules.surface_drag->threshold);
  if (rules.surface_flow) furthest = std::max(furthest, rules.surface_flow->distance);
  return furthest;
}

std::vector<std::string> explain(const Rules& rules) {
  std::vector<std::string> lines;
  for (const auto& [name, used] :
       {std::pair{"spring", rules.spring.has_value()},
        {"impact", rules.impact.has_value()},
        {"swept look-up", rules.impact && rules.impact->sweep == Sweep::on},
        {"surface drag", rules.surface_drag.has_value()},
        {"surface flow", rules.surface_flow.has_value()},
        {"gravity", rules.gravity.has_value()},
        {"wind", rules.wind.has_value()},
        {"air drag", rules.air_drag.has_value()},
        {"explosions", !rules.explosions.empty()}})
    lines.push_back(std::string(name) + (used ? ": used" : ": left out"));
  return lines;
}

}  // namespace tess::dn
