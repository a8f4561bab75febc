// Swept impacts that stop particles before the surface: by a threshold, or by the clearance of an
// open surface.
#include "apps/kit/worst.hpp"
#include "collide/dn_field/made_field.hpp"
#include "collide/dn_field/stepper.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

namespace {

using namespace tess::dn;

constexpr double ball_radius = 0.5, one_step = 0.1;

/// The fraction of a step at which x + s × way is at the distance `off` from a ball around the
/// moving origin of `frame`; above 1 where it is not met.
double contact_with_ball(const Frame& frame, Vec3 x, Vec3 way, double off) {
  const auto gap = [&](double s) {
    const double t = s * one_step;
    return norm(x + s * way - frame.position - t * frame.velocity) -
           ball_radius * (frame.scale + t * frame.scale_rate) - off;
  };
  constexpr int n_parts = 4000;
  for (int i = 0; i < n_parts; ++i) {
    double low = 1.0 * i / n_parts, high = (i + 1.0) / n_parts;
    if (gap(high) > 0) continue;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      (gap(middle) > 0 ? low : high) = middle;
    }
    return low;
  }
  return 2;
}

struct Errors {
  double place = 0, angle = 0;  ///< the greatest; angle: of velocities, by the particles' speed
  int n_hits = 0, n_wrong = 0;  ///< bounces; those that should not be, or are missing
};

/// By how much a voxel's normal is off, at most: by half its diagonal over the distance from the
/// ball's centre, the nearest look-up by as much again for its place. Bounces double that.
double normal_error(const Field& ball, LookUp look_up, double off) {
  const double cells = static_cast<double>(half_diagonal) * (look_up == LookUp::nearest ? 2 : 1);
  return 1.1 * cells * ball.grid.cell / (ball_radius + off);
}

/// Parallel particles past and against a ball at `off` from which they are stopped, all in one step.
/// Particles that nearly graze it are left out.
Errors shoot(const Field& ball, const Frame& frame, LookUp look_up, double threshold, double off) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{1, threshold, Sweep::on};
  Errors errors;
  Particles particles;
  std::vector<double> contact;
  const Vec3 velocity = (1 / one_step) * Vec3{3, 0, 0};
  for (int i = 0; i < 300; ++i) {
    const double beside = 0.003 * i, turn = 2.4 * i;
    const Vec3 x{-1.4, beside * std::cos(turn), beside * std::sin(turn)};
    const auto at = [&](double more) {
      return contact_with_ball(frame, x, one_step * velocity, off + more);
    };
    if ((at(0.04) < 1) != (at(-0.06) < 1)) continue;
    particles.push_back(x, velocity);
    contact.push_back(at(0));
  }
  const Particles start = particles;
  const Object object{&ball, frame};
  const auto waypoints = make_stepper(rules, one_step).run_once(particles.span(), {&object, 1}, 0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const bool hits = contact[p] < 1;
    errors.n_hits += hits;
    const auto here = std::ranges::equal_range(waypoints, p, {}, &Waypoint::particle);
    // The first is where the trace begins.
    const bool bounced = here.size() > 1;
    if (bounced != hits) ++errors.n_wrong;
    if (!bounced || !hits) continue;
    Frame then = frame;
    then.advance(contact[p] * one_step);
    const Vec3 place = start.position(p) + contact[p] * one_step * velocity;
    const Vec3 n = direction(place - then.position);
    const Vec3 u = frame.velocity + ball_radius * frame.scale_rate * n;
    const Vec3 after = velocity - 2 * dot(velocity - u, n) * n;
    kit::worsen(errors.place, norm(here[1].place - place));
    kit::worsen(errors.angle, norm(particles.velocity(p) - after) / norm(velocity));
  }
  return errors;
}

TEST_CASE("a swept impact with a threshold has its place and its angle, however long the step",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 121), ball_radius);
  for (const double threshold : {0.0, 0.02, 0.1, 0.25})
    for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
      const Errors errors = shoot(ball, {}, look_up, threshold, threshold);
      CAPTURE(threshold, name_of(look_up));
      CHECK(errors.n_hits > 100);
      CHECK(errors.n_wrong == 0);
      CHECK(errors.angle < 2 * normal_error(ball, look_up, threshold));
      CHECK(errors.place < 3 * ball.grid.cell);
    }
}

TEST_CASE("open surfaces reflect at their clearance by the normal there", "[dn_field][rules]") {
  Field shell = made_field(cube_grid(1.5, 121), [](Vec3 p) {
    const double above = norm(p) - ball_radius;
    return DistanceNormal{std::abs(above), above < 0 ? -direction(p) : direction(p)};
  });
  shell.sides = Sides::two;
  for (const LookUp look_up : {LookUp::nearest, LookUp::tangent, LookUp::trilinear})
    for (const double threshold : {0.0, 0.1}) {
      const double off =
          threshold + static_cast<double>(open_surface_clearance(look_up)) * shell.grid.cell;
      const Errors errors = shoot(shell, {}, look_up, threshold, off);
      CAPTURE(name_of(look_up), threshold);
      CHECK(errors.n_hits > 100);
      CHECK(errors.n_wrong == 0);
      CHECK(errors.angle < 2 * normal_error(shell, look_up, off));
    }
}

TEST_CASE("a threshold keeps its length in the world where a body moves, grows or shrinks",
          "[dn_field][rules]") {
  const Field ball = sphere_field(cube_grid(1.5, 121), ball_radius);
  for (const double growth : {-0.6, -0.3, 0.0, 0.3})
    for (const double speed : {0.0, 0.2}) {
      Frame frame;
      frame.scale_rate = growth / one_step;
      frame.velocity = {0, speed / one_step, 0};
      const Errors errors = shoot(ball, frame, LookUp::tangent, 0.2, 0.2);
      CAPTURE(growth, speed);
      CHECK(errors.n_hits > 100);
      CHECK(errors.n_wrong == 0);
      CHECK(errors.angle <
            2.2 * 0.87 * ball.grid.cell / (ball_radius * (1 + std::min(growth, 0.0))));
    }
}

}  // namespace
