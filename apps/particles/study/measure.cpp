#include "apps/particles/study/measure.hpp"

#include "apps/particles/audit/passage.hpp"
#include "runtime/core/cpu_clock.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

/// The root of the mean of squares; 0 of none.
struct RootMeanSquare {
  double sum = 0, n = 0;
  void add(double value) { sum += value * value, ++n; }
  [[nodiscard]] double value() const { return n > 0 ? std::sqrt(sum / n) : 0; }
};

double degrees_between(Vec3 a, Vec3 b) {
  return 180 / std::numbers::pi * std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace

std::vector<Bounce> exact_bounces(const Surface& surface, const Bvh& tree, std::size_t n,
                                  double from, std::uint64_t seed) {
  constexpr double steepest = std::numbers::pi / 3;
  tess::Random random(seed);
  const std::vector<double> areas = area_sums(surface);
  std::vector<Bounce> bounces;
  std::vector<Crossing> crossings;
  for (std::size_t i = 0; i < n; ++i) {
    const double first = random.unit(), second = random.unit(), third = random.unit();
    const auto [point, normal, triangle] = point_on(surface, areas, first, second, third);
    const auto [a, b, c] = surface.corners(triangle);
    const Vec3 side = direction(b - a), other = cross(normal, side);
    const double tilt = steepest * random.unit(), turn = 2 * std::numbers::pi * random.unit();
    const Vec3 out =
        std::cos(tilt) * normal + std::sin(tilt) * (std::cos(turn) * side + std::sin(turn) * other);
    Bounce bounce;
    bounce.start = point + (from / std::cos(tilt)) * out;
    bounce.velocity = -out;
    const double reach = 2 * from / std::cos(tilt);
    crossings.clear();
    tree.crossings(bounce.start, bounce.start + reach * bounce.velocity, crossings);
    if (crossings.empty()) continue;
    const Crossing hit = *std::ranges::min_element(crossings, {}, &Crossing::at);
    const Vec3 met = tree.normal(hit.triangle);
    const double into = dot(met, bounce.velocity);
    if (into >= 0) continue;
    bounce.time = hit.at * reach;
    bounce.hit = bounce.start + bounce.time * bounce.velocity;
    bounce.outgoing = bounce.velocity - (2 * into) * met;
    bounces.push_back(bounce);
  }
  return bounces;
}

double bounce_time(const Bounce& bounce, Vec3 place, Vec3 velocity, double time) {
  const Vec3 change = bounce.velocity - velocity;
  const double size2 = dot(change, change);
  return size2 > 0 ? dot(place - bounce.start - time * velocity, change) / size2 : time;
}

Samples samples_of(const Subject& subject, std::size_t n) {
  Samples samples;
  tess::Random random(3);
  for (const Bounce& way :
       exact_bounces(subject.object.surface, subject.tree, n, 0.5 * subject.thickness, 17)) {
    const double away = (0.1 + 0.6 * random.unit()) * subject.thickness;
    const Vec3 p = way.hit + away * way.normal();
    const std::array at{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    const Vec3 rounded{at[0], at[1], at[2]};
    const ClosestPoint closest = subject.tree.closest(rounded);
    const double distance = std::sqrt(closest.distance2);
    if (std::abs(distance - away) > 1e-5 * subject.thickness) continue;
    samples.x.push_back(at[0]), samples.y.push_back(at[1]), samples.z.push_back(at[2]);
    samples.distance.push_back(distance);
    samples.normal.push_back(direction(rounded - closest.point));
  }
  return samples;
}

void compare(const Field& field, LookUp kind, const Samples& samples, StudyRow& row) {
  const std::size_t n = samples.distance.size();
  if (n == 0) return;  // not measured
  std::vector<float> distance(n), nx(n), ny(n), nz(n);
  look_up(field, kind, {samples.x, samples.y, samples.z}, {distance, nx, ny, nz});
  RootMeanSquare distances, angles;
  double greatest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double error = std::abs(static_cast<double>(distance[i]) - samples.distance[i]);
    distances.add(error);
    greatest = std::max(greatest, error);
    const Vec3 normal{nx[i], ny[i], nz[i]};
    angles.add(normal != Vec3{} ? degrees_between(normal, samples.normal[i]) : 180);
  }
  row.distance_error = distances.value();
  row.distance_error_max = greatest;
  row.normal_error = angles.value();
}

void compare_bounces(const Object& object, const Rules& rules, double dt, const Subject& subject,
                     StudyRow& row) {
  Particles particles;
  for (const Bounce& b : subject.bounces) particles.push_back(b.start, b.velocity);
  const std::array objects{object};
  const Stepper stepper = make_stepper(rules, dt);
  const auto n_steps = static_cast<int>(std::ceil(3 * subject.thickness / dt));
  const double near = 2 * object.field->grid.cell;
  double deepest = 0, n_lost = 0;
  row.bounces = static_cast<double>(particles.size());
  for (int step = 0; step < n_steps; ++step) {
    stepper.run(particles.span(), objects, step * dt);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec3 at = particles.position(p);
      if (!(distance_at(object, at) < near) || !subject.tree.is_inside(at)) continue;
      deepest = std::max(deepest, std::sqrt(subject.tree.closest(at).distance2));
    }
  }
  RootMeanSquare places, angles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Bounce& b = subject.bounces[p];
    const Vec3 place = particles.position(p), velocity = particles.velocity(p);
    if (!(dot(velocity, b.normal()) > 0) || subject.tree.is_inside(place)) {
      ++n_lost;
      continue;
    }
    const double time = bounce_time(b, place, velocity, n_steps * dt);
    places.add(norm(b.start + time * b.velocity - b.hit));
    angles.add(degrees_between(velocity, b.outgoing));
  }
  row.penetration = deepest;
  row.lost = n_lost;
  if (places.n == 0) return;  // not measured
  row.place_error = places.value();
  row.angle_error = angles.value();
}

Particles flown(const Object& object, const Rules& rules, double dt, double time,
                const Particles& starts) {
  Particles particles = starts;
  const auto n_steps = static_cast<int>(std::lround(time / dt));
  make_stepper(rules, dt).run(particles.span(), {&object, 1}, 0, n_steps);
  return particles;
}

void compare_flights(const Particles& found, const Particles& wanted, StudyRow& row) {
  RootMeanSquare places, angles;
  for (std::size_t p = 0; p < found.size(); ++p) {
    places.add(norm(found.position(p) - wanted.position(p)));
    angles.add(degrees_between(found.velocity(p), wanted.velocity(p)));
  }
  row.place_error = places.value();
  row.angle_error = angles.value();
}

Particles crowd(const Subject& subject, std::size_t n) {
  Particles particles;
  tess::Random random(5);
  for (std::size_t i = 0; i < n; ++i) {
    const Bounce& b = subject.bounces[i % subject.bounces.size()];
    const Vec3 jitter{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
    particles.push_back(b.hit + (0.25 * random.unit() * subject.thickness) * b.normal(),
                        direction(jitter));
  }
  return particles;
}

Cost least_cost(const std::function<void()>& work, const std::function<void()>& prepare) {
  using Clock = std::chrono::steady_clock;
  constexpr double longest = 1;
  Cost least;
  double sum = 0;
  for (int run = 0; run < 5 && sum <= longest; ++run) {
    prepare();
    const Clock::time_point begin = Clock::now();
    const double cpu_begin = tess::thread_cpu_seconds();
    work();
    least.cpu = std::min(least.cpu, tess::thread_cpu_seconds() - cpu_begin);
    const double wall = std::chrono::duration<double>(Clock::now() - begin).count();
    least.wall = std::min(least.wall, wall);
    sum += wall;
  }
  return least;
}

void set_times(StudyRow& row, const Cost& cost, double n) {
  row.ns = 1e9 * cost.wall / n, row.cpu_ns = 1e9 * cost.cpu / n;
}

void time_steps(const Object* object, const Rules& rules, double dt, int n_steps,
                const Subject& subject, std::size_t n, StudyRow& row) {
  const Particles start = crowd(subject, n);
  const std::span<const Object> objects(object, object != nullptr ? 1 : 0);
  const Stepper stepper = make_stepper(rules, dt);
  Particles particles;
  const Cost cost = least_cost([&] { stepper.run(particles.span(), objects, 0, n_steps); },
                               [&] { particles = start; });
  set_times(row, cost, static_cast<double>(n) * n_steps);
}

}  // namespace particles
