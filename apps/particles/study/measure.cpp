#include "apps/particles/study/measure.hpp"

#include "apps/particles/audit/fields.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

constexpr double in_degrees = 180 / std::numbers::pi;

}  // namespace

Samples samples_of(const Subject& subject, std::size_t n) {
  Samples samples;
  const auto ways = exact_bounces(subject.object.surface, n, 0.5 * subject.thickness, 17);
  tess::Random random(3);
  for (const Bounce& way : ways) {
    const Vec3 normal = direction(way.outgoing - way.velocity);
    const double away = (0.1 + 0.6 * random.unit()) * subject.thickness;
    const Vec3 p = way.hit + away * normal;
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

void compare(const Ask& ask, const Samples& samples, StudyRow& row) {
  const std::size_t n = samples.distance.size();
  std::vector<float> distance(n), nx(n), ny(n), nz(n);
  ask(Points{samples.x, samples.y, samples.z}, Answers{distance, nx, ny, nz});
  double sum = 0, largest = 0, angles = 0;
  std::size_t n_normals = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double error = std::abs(static_cast<double>(distance[i]) - samples.distance[i]);
    sum += error * error;
    largest = std::max(largest, error);
    const Vec3 normal{nx[i], ny[i], nz[i]};
    if (normal == Vec3{}) continue;
    const double angle =
        std::atan2(norm(cross(normal, samples.normal[i])), dot(normal, samples.normal[i]));
    angles += angle * angle;
    ++n_normals;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(n, 1));
  row.distance_error = std::sqrt(sum / count);
  row.distance_error_max = largest;
  row.normal_error =
      in_degrees * std::sqrt(angles / static_cast<double>(std::max<std::size_t>(n_normals, 1)));
}

void bounce(const Object& object, const Rules& rules, double dt, const Subject& subject,
            StudyRow& row) {
  Particles particles;
  for (const Bounce& b : subject.bounces) particles.push_back(b.start, b.velocity);
  const std::array objects{object};
  const Stepper stepper = make_stepper(rules, dt);
  const auto n_steps = static_cast<int>(std::ceil(3 * subject.thickness / dt));
  const double near = 2 * object.field->grid.cell;
  row.penetration = 0;
  for (int step = 0; step < n_steps; ++step) {
    stepper.run(particles.span(), objects, step * dt);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec3 at = particles.position(p);
      if (!(distance_at(object, at) < near) || !subject.tree.is_inside(at)) continue;
      row.penetration = std::max(row.penetration, std::sqrt(subject.tree.closest(at).distance2));
    }
  }
  row.lost = 0;
  double places = 0, angles = 0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Bounce& b = subject.bounces[p];
    const Vec3 place = particles.position(p), velocity = particles.velocity(p);
    const Vec3 normal = direction(b.outgoing - b.velocity);
    if (!(dot(velocity, normal) > 0) || subject.tree.is_inside(place)) {
      ++row.lost;
      continue;
    }
    const double time = bounce_time(b, place, velocity, n_steps * dt);
    const double off = norm(b.start + time * b.velocity - b.hit);
    const double angle = std::atan2(norm(cross(velocity, b.outgoing)), dot(velocity, b.outgoing));
    places += off * off;
    angles += angle * angle;
  }
  row.bounces = static_cast<std::int64_t>(particles.size());
  const auto kept = static_cast<double>(std::max<std::int64_t>(row.bounces - row.lost, 1));
  row.place_error = std::sqrt(places / kept);
  row.angle_error = in_degrees * std::sqrt(angles / kept);
}

double fastest_seconds(const std::function<void()>& work) {
  constexpr int rounds = 3;
  double best = HUGE_VAL;
  for (int i = 0; i < rounds; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return best;
}

Particles crowd(const Subject& subject, std::size_t n) {
  Particles particles;
  tess::Random random(5);
  for (std::size_t i = 0; i < n; ++i) {
    const Bounce& b = subject.bounces[i % subject.bounces.size()];
    const Vec3 normal = direction(b.outgoing - b.velocity);
    const Vec3 jitter{random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5};
    particles.push_back(b.hit + (0.25 * random.unit() * subject.thickness) * normal,
                        direction(jitter));
  }
  return particles;
}

namespace {

/// Nanoseconds a particle and step of n_steps steps of dt from one crowd, fastest of three.
double ns_of_steps(const Object* object, const Stepper& stepper, int n_steps,
                   const Subject& subject, std::size_t n) {
  const Particles start = crowd(subject, n);
  std::vector<Object> objects;
  if (object != nullptr) objects.push_back(*object);
  Particles particles;
  double best = HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    particles = start;
    const auto begin = std::chrono::steady_clock::now();
    stepper.run(particles.span(), objects, 0, n_steps);
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return best * 1e9 / (static_cast<double>(n) * n_steps);
}

}  // namespace

double ns_of(const Object* object, const Rules& rules, const Subject& subject, std::size_t n) {
  constexpr int n_steps = 16;
  const double dt = 0.1 * subject.thickness / n_steps;
  return ns_of_steps(object, make_stepper(rules, dt), n_steps, subject, n);
}

double ns_of_step(const Object& object, const Rules& rules, double dt, const Subject& subject,
                  std::size_t n) {
  return ns_of_steps(&object, make_stepper(rules, dt), 1, subject, n);
}

}  // namespace particles
