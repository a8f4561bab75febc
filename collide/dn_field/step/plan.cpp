#include "collide/dn_field/step/object_poses.hpp"
#include "runtime/core/error.hpp"

namespace tess::dn {
namespace {

LinearFlow linear_flow(double rate, double step) {
  const double x = rate * step;
  if (!(x > 0)) return {1, step, step, 0.5 * step * step};
  const double lost = -std::expm1(-x), mean = lost / x;
  // 1 − (1 − exp(−x))/x, by its series where the difference cancels
  const double mean_lost =
      x < 0.02 ? x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x / 720))))
               : 1 - mean;
  return {1 - lost, lost / rate, step * mean, step * mean_lost / rate};
}

Flight flight_of(const Rules& rules) {
  Flight flight{rules.gravity || rules.wind};
  if (rules.wind || (rules.air_drag && rules.air_drag->law == DragLaw::linear))
    flight.drags = Drags::everywhere;
  if (rules.surface_drag) flight.drags = Drags::surface;
  return flight;
}

LoopKey key_of(const Rules& rules) {
  LoopKey key;
  key.flight = flight_of(rules);
  if (rules.impact)
    key.impacts = rules.impact->sweep == Sweep::on ? Impacts::swept : Impacts::plain;
  if (rules.spring) key.springs = Springs::exact;
  return key;
}

RuleConstants constants_of(const Rules& rules, double step) {
  RuleConstants c;
  c.step = step;
  double rate = 0;
  if (rules.gravity) c.acceleration += rules.gravity->acceleration;
  if (rules.wind) {
    rate += rules.wind->rate;
    c.acceleration += rules.wind->rate * rules.wind->velocity;
  }
  if (rules.air_drag && rules.air_drag->law == DragLaw::linear) rate += rules.air_drag->rate;
  if (rules.surface_drag) {
    c.surface_rate = rules.surface_drag->rate;
    c.surface_threshold = rules.surface_drag->threshold;
  }
  c.air = linear_flow(rate, step);
  c.surface = linear_flow(rate + c.surface_rate, step);
  c.curved = rate + c.surface_rate > 0 ? 0 : 1;
  c.falls = c.curved > 0 && !rules.spring && norm(c.acceleration) > 0;
  if (rules.impact) {
    c.restitution = rules.impact->restitution;
    c.threshold = rules.impact->threshold;
  }
  if (rules.surface_flow) {
    c.flow = {rules.surface_flow->alpha_in * step, rules.surface_flow->alpha_out * step,
              rules.surface_flow->distance};
  }
  if (rules.spring) {
    const double gamma = 0.5 * rules.spring->damping, k = rules.spring->stiffness;
    const double omega = std::sqrt(k - gamma * gamma), phase = omega * step;
    c.spring = {k, omega, gamma, rules.spring->reach};
    c.spring.soft = phase < 1.5;
    c.spring.cosine = std::cos(phase), c.spring.sine = std::sin(phase);
    c.spring.kept = std::exp(-gamma * step);
  }
  return c;
}

}  // namespace

Stepper make_stepper(const Rules& rules, double step) {
  validate(rules);
  if (!(step > 0) || !std::isfinite(step))
    fail(ErrorCode::bad_value, "step is ", step, "; give a positive, finite time");
  const LoopKey key = key_of(rules);
  const Sweep sweep = key.impacts == Impacts::swept ? Sweep::on : Sweep::off;
  const Ask ask = needed_content(rules) == Content::distance_and_normal ? Ask::both : Ask::distance;
  auto plan = std::make_shared<Stepper::Plan>();
  *plan = {rules,
           step,
           constants_of(rules, step),
           needs_field(rules),
           sweep,
           ask,
           rule_loop_at_rest(key),
           rule_loop_general(key),
           free_loop(flight_of(rules))};
  return Stepper(std::move(plan));
}

}  // namespace tess::dn
