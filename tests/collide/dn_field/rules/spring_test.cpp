// The spring's motion over one step, compared with the same motion in many short steps. (Where g
// acts before the contact, the closed form takes the mean velocity of the step: not compared here.)
#include "collide/dn_field/rules/spring.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

namespace {

using namespace tess::dn;
using lanes::all;

SpringConstants spring(double stiffness, double damping) {
  const double gamma = damping / 2;
  SpringConstants c;
  c.stiffness = stiffness;
  c.omega = std::sqrt(stiffness - gamma * gamma);
  c.gamma = gamma;
  return c;
}

struct Motion {
  double end, rate;
};
Motion motion(const SpringConstants& c, double z, double rate, double g, double dt) {
  const lanes::SpringMotion found = lanes::spring_motion(c, all(z), all(rate), all(g), dt);
  return {found.end[0], found.rate[0]};
}

/// Free flight where z > 0, otherwise z" = -k z - c z' + g, by the velocity Verlet method.
Motion in_short_steps(const SpringConstants& c, double z, double rate, double g, double dt) {
  constexpr int n = 500'000;
  const double h = dt / n;
  const auto acceleration = [&](double at, double speed) {
    return g - (at < 0 ? c.stiffness * at + 2 * c.gamma * speed : 0);
  };
  for (int i = 0; i < n; ++i) {
    const double middle = rate + 0.5 * h * acceleration(z, rate);
    z += h * middle;
    rate = middle + 0.5 * h * acceleration(z, middle);
  }
  return {z, rate};
}

TEST_CASE("decay(v) is exp(-v) up to the smallest normal number", "[dn_field][rules]") {
  for (const double v : {0.0, 1e-12, 0.1, 0.35, 1.0, 6.9, 7.1, 20.0, 100.0, 690.0, 700.0}) {
    INFO("v = " << v);
    CHECK(lanes::decay(all(v))[0] == Approx(std::exp(-v)).epsilon(1e-14));
  }
  CHECK(lanes::decay(all(1e6))[0] < 1e-300);
}

TEST_CASE("the spring's closed form is the motion of many short steps", "[dn_field][rules]") {
  struct Case {
    const char* what;
    double stiffness, damping, z, rate, g, dt;
  };
  for (const Case& one :
       {Case{"in contact all the time", 100, 0, -0.1, -1, 0, 0.1},
        {"damped, in contact all the time", 100, 8, -0.1, -1, 0, 0.1},
        {"enters", 100, 0, 0.05, -1, 0, 0.2},
        {"enters and leaves", 100, 3, 0.05, -1, 0, 0.6},
        {"strongly damped, enters and leaves", 100, 15, 0.02, -1, 0, 0.6},
        {"pressed by g, in contact all the time", 400, 1, -0.02, -0.5, -2, 0.1}}) {
    INFO(one.what);
    const SpringConstants c = spring(one.stiffness, one.damping);
    const Motion found = motion(c, one.z, one.rate, one.g, one.dt);
    const Motion exact = in_short_steps(c, one.z, one.rate, one.g, one.dt);
    CHECK(found.end == Approx(exact.end).margin(1e-5));
    CHECK(found.rate == Approx(exact.rate).margin(1e-4));
  }
}

TEST_CASE("a particle that leaves and falls back within a step rests where spring and g balance",
          "[dn_field][rules]") {
  const double g = -10;
  const SpringConstants c = spring(400, 1);
  const Motion rests = motion(c, -0.01, 0.5, g, 1);  // in flight for less than 0.1
  CHECK(rests.end == Approx(g / 400));
  CHECK(rests.rate == 0);
}

}  // namespace
