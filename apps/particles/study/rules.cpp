#include "apps/particles/study/rules.hpp"

#include "apps/particles/study/exact_flight.hpp"

#include <array>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

constexpr LookUp look_up_of_rules = LookUp::tangent;

/// A spring that a particle of speed 1 presses half way to the surface.
Rules spring_alone(double thickness) {
  Rules rules;
  rules.look_up = look_up_of_rules;
  const double reach = 0.5 * thickness;
  rules.spring = Spring{4 / (reach * reach), 0, reach};
  return rules;
}

/// Ways are begun at 0.8 of the thickness with speed 1: this drag stops those that come straight on
/// in front of the surface, and this flow turns them to the tangent there.
Rules drag_alone(double thickness) {
  Rules rules;
  rules.look_up = look_up_of_rules;
  rules.surface_drag = SurfaceDrag{2.5 / thickness, 0.5 * thickness, DragLaw::linear};
  return rules;
}
Rules flow_alone(double thickness) {
  Rules rules;
  rules.look_up = look_up_of_rules;
  rules.surface_flow = SurfaceFlow{4 / thickness, 4 / thickness, 0.7 * thickness};
  return rules;
}

/// Flights of the same time as the exact ones, in steps of dt.
void compare_flights(const Object& object, const Rules& rules, double dt, double time,
                     const std::vector<Flight>& starts, const std::vector<Flight>& exact,
                     StudyRow& row) {
  Particles particles;
  for (const Flight& start : starts) particles.push_back(start.position, start.velocity);
  const auto n_steps = static_cast<int>(std::lround(time / dt));
  make_stepper(rules, dt).run(particles.span(), {&object, 1}, 0, n_steps);
  double places = 0, angles = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vec3 off = particles.position(p) - exact[p].position, v = particles.velocity(p),
               want = exact[p].velocity;
    const double angle = std::atan2(norm(cross(v, want)), dot(v, want));
    places += dot(off, off);
    angles += angle * angle;
  }
  const auto n = static_cast<double>(particles.size());
  row.place_error = std::sqrt(places / n);
  row.angle_error = 180 / std::numbers::pi * std::sqrt(angles / n);
}

}  // namespace

std::string name_of(Method method) {
  return std::array{"exact", "normals", "potential"}[static_cast<std::size_t>(method)];
}
std::string name_of(LookUp look_up) {
  return std::array{"nearest", "tangent", "trilinear"}[static_cast<std::size_t>(look_up)];
}

Rules impact_alone(LookUp look_up, Sweep sweep) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{1, 0, sweep};
  return rules;
}

void study_rules(const Subject& subject, const StudyOptions& options, const BuiltField& built,
                 std::vector<StudyRow>& rows) {
  constexpr std::array steps{0.02, 0.1, 0.5, 2.0};
  constexpr std::size_t most_flights = 100;
  constexpr int exact_steps = 400;
  const double thickness = subject.thickness, time = 2 * thickness;
  const Object object{&built.field, {}};
  StudyRow row;
  row.part = "rule";
  row.resolution = subject.object.grid.n[0];
  row.method = name_of(subject.object.method);
  row.stored = "flat";
  row.look_up = name_of(look_up_of_rules);
  const auto study = [&](const char* name, const Rules& rules, const auto& measure) {
    for (const double step : steps) {
      StudyRow now = row;
      now.rule = name;
      now.step = step;
      measure(step * thickness, now);
      now.ns = ns_of_step(object, rules, step * thickness, subject, options.n_timed);
      rows.push_back(now);
    }
  };
  const auto study_bounces = [&](const char* name, const Rules& rules) {
    study(name, rules, [&](double dt, StudyRow& now) { bounce(object, rules, dt, subject, now); });
  };
  study_bounces("impact, swept", impact_alone(look_up_of_rules, Sweep::on));
  study_bounces("impact", impact_alone(look_up_of_rules, Sweep::off));
  study_bounces("spring", spring_alone(thickness));

  // Who comes straight on has no tangent to turn to: a little error decides to which side.
  const double straight = std::cos(std::numbers::pi / 12);
  std::vector<Flight> starts;
  for (const Bounce& b : subject.bounces) {
    const bool leans = -dot(direction(b.outgoing - b.velocity), b.velocity) < straight;
    if (leans && starts.size() < most_flights) starts.push_back({b.start, b.velocity});
  }
  if (starts.empty()) return;
  const auto study_flights = [&](const char* name, const Rules& rules, const auto& exact_flight) {
    std::vector<Flight> exact;
    exact.reserve(starts.size());
    for (const Flight& start : starts) exact.push_back(exact_flight(start));
    study(name, rules, [&](double dt, StudyRow& now) {
      compare_flights(object, rules, dt, time, starts, exact, now);
    });
  };
  const Rules drag = drag_alone(thickness), flow = flow_alone(thickness);
  study_flights("drag", drag, [&](const Flight& start) {
    return exact_drag(subject.tree, start, *drag.surface_drag, time);
  });
  study_flights("surface flow", flow, [&](const Flight& start) {
    return exact_flow(subject.tree, start, *flow.surface_flow, time, exact_steps);
  });
}

}  // namespace particles
