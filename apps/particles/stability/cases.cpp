#include "apps/particles/stability/cases.hpp"

#include <algorithm>

namespace tess::dn {
namespace stability {
namespace {

const Vec3 up{0, 0, 1};
constexpr double decades[] = {1e-6, 1e-4, 1e-2, 0.25, 1, 4, 1e2, 1e4, 1e6};

/// A bounce off the spring: speed and place afterwards from the closed form.
void spring(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), up);
  const Object object{&floor, {}};
  const double speed = 0.5, start = 0.3;
  for (const double stiffness : decades) {
    // k dt²; the contact must be shallower than the field, and the run end in flight.
    for (const double ratio : {0.0, 0.5}) {
      const double omega0 = std::max(1.0, std::sqrt(stiffness)),
                   step = std::sqrt(stiffness) / omega0;
      const double gamma = ratio * omega0, omega = std::sqrt(omega0 * omega0 - gamma * gamma);
      Rules rules;
      rules.spring = Spring{omega0 * omega0, 2 * gamma, 0};
      const double contact = 3.14159265358979323846 / omega;
      const int n_steps = static_cast<int>(std::ceil((start / speed + contact + 0.2) / step));
      const Particle end =
          flown(rules, step, n_steps, {&object, 1}, {{0, 0, start}, {0, 0, -speed}});
      const double leaving = speed * std::exp(-gamma * contact);
      const double height = leaving * (n_steps * step - start / speed - contact);
      const char* name = ratio > 0 ? "spring, half damped" : "spring";
      rows.add(name, "k dt²/m", stiffness, std::abs(end.velocity.z - leaving) / speed, 2e-6);
      rows.add(std::string(name) + ": place", "k dt²/m", stiffness,
               std::abs(end.position.z - height), 2e-5);
    }
  }
}

void drag(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), up);
  const Object object{&floor, {}};
  const double speed = 0.3;
  for (const double rate : decades) {
    const int n_steps = 5;
    const double kept = std::exp(-rate * n_steps), way = -std::expm1(-rate * n_steps) / rate;
    Rules air;
    air.air_drag = AirDrag{rate, DragLaw::linear};
    Particle end = flown(air, 1, n_steps, {}, {{}, {speed, 0, 0}});
    rows.add("air drag", "c dt/m", rate, std::abs(end.velocity.x / speed - kept), 1e-13);
    rows.add("air drag: way", "c dt/m", rate, std::abs(end.position.x / (speed * way) - 1), 1e-12);
    Rules surface;
    surface.surface_drag = SurfaceDrag{rate, 1};
    end = flown(surface, 1, n_steps, {&object, 1}, {{-0.5, 0, 0.5}, {speed, 0, 0}});
    rows.add("surface drag", "c dt/m", rate, std::abs(end.velocity.x / speed - kept), 1e-13);
    Rules fall = air;
    fall.gravity = Gravity{{-0.7, 0, 0}};
    end = flown(fall, 1, n_steps, {}, {{}, {speed, 0, 0}});
    const double limit = -0.7 / rate, expected = limit + (speed - limit) * kept;
    rows.add("fall with drag", "c dt/m", rate, std::abs(end.velocity.x / expected - 1), 1e-9);
    Rules quadratic;
    quadratic.air_drag = AirDrag{rate, DragLaw::quadratic};
    end = flown(quadratic, 1, n_steps, {}, {{}, {speed, 0, 0}});
    const double q = rate * speed;
    rows.add("quadratic air drag", "c |v| dt", q,
             std::abs(end.velocity.x / speed * (1 + q * n_steps) - 1), 1e-12);
    rows.add("quadratic air drag: way", "c |v| dt", q,
             std::abs(end.position.x * rate / std::log1p(q * n_steps) - 1), 1e-12);
  }
  const double limit = 3, total = 4;  // g = 1: v = limit tanh(t / limit)
  for (const double step : {0.01, 0.1, 1.0}) {
    Rules rules;
    rules.air_drag = AirDrag{1 / (limit * limit), DragLaw::quadratic};
    rules.gravity = Gravity{{0, 0, -1}};
    const Particle end = flown(rules, step, static_cast<int>(total / step), {}, {});
    const double way = limit * limit * std::log(std::cosh(total / limit));
    rows.add("fall with quadratic drag: way", "g dt/limit", step / limit,
             std::abs(end.position.z / -way - 1), 0.1 * step * step);
  }
}

void wind(Rows& rows) {
  const Vec3 blows{2, -1, 0.5}, from{1, 1, 1}, at_first{-3, 0, 1};
  for (const double rate : decades) {
    const int n_steps = 5;
    Rules rules;
    rules.wind = Wind{blows, rate};
    const Particle end = flown(rules, 1, n_steps, {}, {from, at_first});
    const Vec3 lost = at_first - blows, way = (-std::expm1(-rate * n_steps) / rate) * lost;
    rows.add("wind", "c dt/m", rate, norm(end.velocity - blows - std::exp(-rate * n_steps) * lost),
             1e-12);
    rows.add("wind: place", "c dt/m", rate, norm(end.position - from - n_steps * blows - way),
             1e-11);
  }
}

/// Within its radius an explosion is a harmonic force about the radius: from rest at r0 a particle
/// is at r = R - (R - r0) cos ωt, with ω² = strength / R.
void explosion(Rows& rows) {
  const double radius = 2, from = 0.5, omega = 3, total = 0.4;
  const Vec3 centre{1, 2, 3}, out = direction({1, -2, 2});
  for (const double step : {1e-4, 1e-3, 1e-2, 1e-1}) {
    Rules rules;
    rules.explosions.push_back({centre, omega * omega * radius, radius, 0, total});
    const int n_steps = static_cast<int>(std::lround(total / step));
    const Particle end = flown(rules, step, n_steps, {}, {centre + from * out, {}});
    const double phase = omega * total, speed = (radius - from) * omega * std::sin(phase);
    const Vec3 place = centre + (radius - (radius - from) * std::cos(phase)) * out;
    rows.add("explosion: |v|", "ω dt", omega * step, norm(end.velocity - speed * out) / speed,
             0.2 * omega * step * omega * step + 1e-9);
    rows.add("explosion: place", "ω dt", omega * step, norm(end.position - place) / radius,
             0.7 * omega * step);
  }
  Rules over;
  over.explosions.push_back({centre, 1e6, radius, 0, total});
  const Particle beyond = flown(over, 0.1, 10, {}, {centre + 1.001 * radius * out, {}});
  rows.add("explosion: |v| beyond its radius", "r/radius", 1.001, norm(beyond.velocity), 0);
}

/// From 45°: |V| is kept, and the angle falls monotonically at the exact rate.
void surface_flow(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), up);
  const Object object{&floor, {}};
  const double pi = 3.14159265358979323846;
  for (const double alpha : decades) {
    Rules rules;
    rules.surface_flow = SurfaceFlow{alpha, alpha, 10};
    const double speed = 1e-3, step = 1, total = 0.25 * pi * speed / alpha;  // to the tangent
    double kept = 0, off = 0, rising = 0;
    for (const double sign : {-1.0, 1.0}) {
      Particle now{{0, 0, 0.5}, speed * std::sqrt(0.5) * Vec3{1, 0, sign}};
      double before = 0.25 * pi;
      for (int i = 1; i <= 100; ++i) {
        now = flown(rules, step, 1, {&object, 1}, now);
        now.position = {0, 0, 0.5};
        const double angle = std::atan2(sign * now.velocity.z, now.velocity.x);
        const double expected = std::max(0.0, 0.25 * pi * (1 - i * step / total));
        worsen(kept, std::abs(norm(now.velocity) / speed - 1));
        worsen(off, std::abs(angle - expected));
        worsen(rising, angle - before);
        before = angle;
      }
    }
    rows.add("surface flow: |V|", "alpha dt/|V|", alpha / speed, kept, 1e-13);
    rows.add("surface flow: angle", "alpha dt/|V|", alpha / speed, off, 1e-6);
    rows.add("surface flow: overshoot", "alpha dt/|V|", alpha / speed, rising, 1e-15);
  }
}

/// Bounces under gravity: no energy gained at restitution 1; at rest in time at less.
void bounces(Rows& rows) {
  const Field floor = plane_field(cube_grid(2, 9), up);
  const Object object{&floor, {}};
  for (const double step : {1e-3, 1e-2, 1e-1, 1.0}) {
    Rules rules = impact(1, Sweep::off);
    rules.gravity = Gravity{{0, 0, -1}};
    Particle now{{0, 0, 0.5}, {}};
    double gain = -1, loss = -HUGE_VAL;
    for (int i = 0; i < 2000; ++i) {
      now = flown(rules, step, 1, {&object, 1}, now);
      const double energy = now.position.z + 0.5 * dot(now.velocity, now.velocity);
      worsen(gain, energy / 0.5 - 1), worsen(loss, 1 - energy / 0.5);
    }
    rows.add("bounces, restitution 1: gain", "dt √(g/h)", step * std::sqrt(2.0), gain, 1e-6);
    if (step < 0.05)
      rows.add("bounces, restitution 1: loss", "dt √(g/h)", step * std::sqrt(2.0), loss, 1e-6);
    rules.impact->restitution = 0;
    now =
        flown(rules, step, static_cast<int>(std::ceil(3 / step)), {&object, 1}, {{0, 0, 0.5}, {}});
    rows.add("impact, restitution 0: at rest", "dt √(g/h)", step * std::sqrt(2.0),
             std::abs(now.position.z) + norm(now.velocity), 2e-6);
  }
  // Restitution e: at rest (v0/g)(1 + e)/(1 - e) after the start of the fall; bounces shorter than
  // a step, the last 2 v/g, are cut off.
  const double step = 1e-3, e = 0.7, v0 = 1;
  Rules rules = impact(e, Sweep::off);
  rules.gravity = Gravity{{0, 0, -1}};
  const double at_rest = v0 * (1 + e) / (1 - e);
  Particle now{{0, 0, 0.5 * v0 * v0}, {}};
  double moved = 0;
  int i = 0;
  for (; i * step < at_rest + 1; ++i) {
    now = flown(rules, step, 1, {&object, 1}, now);
    if (std::abs(now.velocity.z) > 1e-9) moved = (i + 1) * step;
  }
  rows.add("impact, restitution 0.7: time to rest", "dt", step, std::abs(moved - at_rest),
           20 * step);
}

/// Traced bounces under gravity: straight up and down, and also off the walls of a room.
void traced_bounces(Rows& rows) {
  const Field room = room_field(cube_grid(1.5, 40), 1);
  const Object object{&room, {}};
  Rules rules = impact(1, Sweep::on);
  rules.gravity = Gravity{{0, 0, -9.81}};
  for (const Vec3 along : {Vec3{}, Vec3{1.1, 0.7, 0}})
    for (const double step : {0.01, 0.03, 0.1}) {
      const double energy = 0.7 * 9.81 + 0.5 * dot(along, along);
      const Particle end = flown(rules, step, 2000, {&object, 1}, {{0.1, 0.2, -0.3}, along});
      const double now = (end.position.z + 1) * 9.81 + 0.5 * dot(end.velocity, end.velocity);
      const std::string name = norm(along) > 0 ? "walls" : "floor";
      rows.add("traced bounces, " + name + ": energy", "dt √(g/h)", step * std::sqrt(9.81 / 0.7),
               std::abs(now / energy - 1), 1e-12);
    }
}

}  // namespace

Rules impact(double restitution, Sweep sweep, LookUp look_up) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{restitution, 0, sweep};
  return rules;
}

Particle flown(const Rules& rules, double step, int n_steps, std::span<const Object> objects,
               Particle start) {
  Particles particles;
  particles.push_back(start.position, start.velocity);
  make_stepper(rules, step).run(particles.span(), objects, 0, n_steps);
  return {particles.position(0), particles.velocity(0)};
}

}  // namespace stability

std::vector<kit::Case> stability_report() {
  using namespace stability;
  Rows rows;
  for (void (*const add)(Rows&) : {spring, drag, wind, explosion, surface_flow, bounces,
                                   traced_bounces, extreme_motion, extreme_places})
    add(rows);
  return rows.rows;
}

}  // namespace tess::dn
