#include "apps/particles/scene/readers.hpp"

namespace particles {
namespace {
using namespace tess::dn;

Explosion read_explosion(const Node& node) {
  Explosion explosion;
  node.read({{"centre", explosion.centre, any_number, "a point [x, y, z]"},
             {"strength", explosion.strength, any_number, "the force at the centre"},
             {"radius", explosion.radius, positive, "how far it reaches"},
             {"duration", explosion.duration, not_negative, "how long it lasts"},
             {"start", explosion.start}});
  return explosion;
}

}  // namespace

Rules read_rules(const Node& node) {
  Rules rules;
  const auto spring = [&](const Node& of) {
    Spring& to = rules.spring.emplace();
    of.read({{"stiffness", to.stiffness, positive, "force per depth"},
             {"reach", to.reach, positive, "the distance at which the spring is slack"},
             {"damping", to.damping, not_negative}});
  };
  const auto impact = [&](const Node& of) {
    Impact& to = rules.impact.emplace();
    of.read({{"restitution", to.restitution, {0, 1}, "0 (slides) … 1 (no loss)"},
             {"threshold", to.threshold, not_negative},
             {"sweep", [&](const Node& n) { to.sweep = n.yes_or_no() ? Sweep::on : Sweep::off; }}});
  };
  const auto surface_drag = [&](const Node& of) {
    SurfaceDrag& to = rules.surface_drag.emplace();
    of.read({{"rate", to.rate, not_negative, "force per velocity"},
             {"threshold", to.threshold, positive, "the distance it reaches"}});
  };
  const auto surface_flow = [&](const Node& of) {
    SurfaceFlow& to = rules.surface_flow.emplace();
    of.read({{"alpha_in", to.alpha_in, any_number, "the coefficient toward the surface"},
             {"alpha_out", to.alpha_out, any_number, "the coefficient away from the surface"},
             {"distance", to.distance, positive, "the distance it reaches"}});
  };
  const auto wind = [&](const Node& of) {
    Wind& to = rules.wind.emplace();
    of.read({{"velocity", to.velocity, any_number, "that of the air"},
             {"rate", to.rate, not_negative, "force per velocity"}});
  };
  const auto air_drag = [&](const Node& of) {
    AirDrag& to = rules.air_drag.emplace();
    of.read({{"rate", to.rate, not_negative, "force per velocity"},
             {"law", to.law, {"linear", "quadratic"}}});
  };
  const auto explosions = [&](const Node& of) {
    for (const Node& item : of.items()) rules.explosions.push_back(read_explosion(item));
  };
  node.read({{"look_up", rules.look_up, words_of(look_up_names)},
             {"spring", spring},
             {"impact", impact},
             {"surface_drag", surface_drag},
             {"surface_flow", surface_flow},
             {"gravity", [&](const Node& of) { rules.gravity = Gravity{of.vector()}; }},
             {"wind", wind},
             {"air_drag", air_drag},
             {"explosions", explosions}});
  return rules;
}

}  // namespace particles
