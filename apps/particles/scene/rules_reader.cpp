#include "apps/particles/scene/rules_reader.hpp"

namespace particles {
namespace {
using namespace tess::dn;

constexpr Interval restitutions{0, 1};

DragLaw read_law(const Keys& keys) {
  return keys.has("law") ? static_cast<DragLaw>(keys["law"].word({"linear", "quadratic"}))
                         : DragLaw::linear;
}

Spring read_spring(const Node& node) {
  const Keys keys = node.keys({"stiffness", "damping", "reach"});
  Spring spring;
  spring.stiffness = keys.need("stiffness", "force per depth").number(positive);
  spring.reach = keys.need("reach", "the distance at which the spring is slack").number(positive);
  keys.read("damping", spring.damping, not_negative);
  return spring;
}

Impact read_impact(const Node& node) {
  const Keys keys = node.keys({"restitution", "threshold", "sweep"});
  Impact impact;
  impact.restitution = keys.need("restitution", "0 (slides) … 1 (no loss)").number(restitutions);
  keys.read("threshold", impact.threshold, not_negative);
  if (keys.has("sweep")) impact.sweep = keys["sweep"].yes_or_no() ? Sweep::on : Sweep::off;
  return impact;
}

SurfaceDrag read_surface_drag(const Node& node) {
  const Keys keys = node.keys({"rate", "threshold", "law"});
  SurfaceDrag drag;
  drag.rate = keys.need("rate", "force per velocity").number(not_negative);
  drag.threshold = keys.need("threshold", "the distance it reaches").number(positive);
  drag.law = read_law(keys);
  return drag;
}

SurfaceFlow read_surface_flow(const Node& node) {
  const Keys keys = node.keys({"alpha_in", "alpha_out", "distance"});
  SurfaceFlow flow;
  flow.alpha_in = keys.need("alpha_in", "the coefficient toward the surface").number();
  flow.alpha_out = keys.need("alpha_out", "the coefficient away from the surface").number();
  flow.distance = keys.need("distance", "the distance it reaches").number(positive);
  return flow;
}

Explosion read_explosion(const Node& node) {
  const Keys keys = node.keys({"centre", "strength", "radius", "start", "duration"});
  Explosion explosion;
  explosion.centre = keys.need("centre", "a point [x, y, z]").vector();
  explosion.strength = keys.need("strength", "the force at the centre").number();
  explosion.radius = keys.need("radius", "how far it reaches").number(positive);
  explosion.duration = keys.need("duration", "how long it lasts").number(not_negative);
  keys.read("start", explosion.start);
  return explosion;
}

}  // namespace

Rules read_rules(const Node& node) {
  const Keys keys = node.keys({"look_up", "spring", "impact", "surface_drag", "surface_flow",
                               "gravity", "wind", "air_drag", "explosions"});
  Rules rules;
  if (keys.has("look_up"))
    rules.look_up = static_cast<LookUp>(keys["look_up"].word({"nearest", "tangent", "trilinear"}));
  if (keys.has("spring")) rules.spring = read_spring(keys["spring"]);
  if (keys.has("impact")) rules.impact = read_impact(keys["impact"]);
  if (keys.has("surface_drag")) rules.surface_drag = read_surface_drag(keys["surface_drag"]);
  if (keys.has("surface_flow")) rules.surface_flow = read_surface_flow(keys["surface_flow"]);
  if (keys.has("gravity")) rules.gravity = Gravity{keys["gravity"].vector()};
  if (keys.has("wind")) {
    const Keys wind = keys["wind"].keys({"velocity", "rate"});
    rules.wind = Wind{wind.need("velocity", "that of the air").vector(),
                      wind.need("rate", "force per velocity").number(not_negative)};
  }
  if (keys.has("air_drag")) {
    const Keys drag = keys["air_drag"].keys({"rate", "law"});
    rules.air_drag =
        AirDrag{drag.need("rate", "force per velocity").number(not_negative), read_law(drag)};
  }
  if (keys.has("explosions"))
    for (const Node& item : keys["explosions"].items())
      rules.explosions.push_back(read_explosion(item));
  return rules;
}

}  // namespace particles
