#include "apps/particles/study.hpp"

#include "apps/particles/exact_bounce.hpp"
#include "apps/particles/fields.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/look_up.hpp"
#include "runtime/base/mix.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

constexpr std::array method_names{"exact", "normals", "potential"};
constexpr std::array look_up_names{"nearest", "tangent", "trilinear"};
constexpr double in_degrees = 180 / std::numbers::pi;

/// The object, and what is exact about it.
struct Subject {
  const SceneObject& object;
  Bvh tree;
  std::vector<Bounce> bounces;
  double thickness;
};

/// Points around the surface whose closest point is in the midst of a triangle: off the medial
/// axis, where the distance is smooth.
struct Samples {
  std::vector<float> x, y, z;
  std::vector<double> distance;
  std::vector<Vec3> normal;
};

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

/// `ask(points, answers)` fills in what a field says of the samples.
template <class Ask>
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

/// Lets all bounces happen step by step, and compares each with the exact one.
void bounce(
    const Field& field, const Rules& rules, double dt, const Subject& subject, StudyRow& row) {
  Particles particles;
  for (const Bounce& b : subject.bounces) particles.push_back(b.start, b.velocity);
  const std::array objects{Object{&field, {}}};
  const Stepper stepper = make_stepper(rules, dt);
  const auto n_steps = static_cast<int>(std::ceil(3 * subject.thickness / dt));
  const double near = 2 * field.grid.cell;
  row.penetration = 0;
  for (int step = 0; step < n_steps; ++step) {
    stepper.run(particles.span(), objects, step * dt);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const Vec3 at = particles.position(p);
      if (!(distance_at(field, at) < near) || !subject.tree.is_inside(at)) continue;
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

template <class Work>
double fastest_seconds(const Work& work) {
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

/// Particles near the surface with velocities of 1 in all directions.
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

double ns_of(const Field* field, const Rules& rules, const Subject& subject, std::size_t n) {
  constexpr int n_steps = 16;
  const double dt = 0.1 * subject.thickness / n_steps;  // they stay where they are, nearly
  const Stepper stepper = make_stepper(rules, dt);
  const Particles start = crowd(subject, n);
  std::vector<Object> objects;
  if (field != nullptr) objects.push_back({field, {}});
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

Rules impact_alone(LookUp kind, Sweep sweep) {
  Rules rules;
  rules.look_up = kind;
  rules.impact = Impact{1, 0, sweep};
  return rules;
}

/// A spring that a particle of speed 1 presses half way to the surface.
Rules spring_alone(LookUp kind, double thickness) {
  Rules rules;
  rules.look_up = kind;
  const double reach = 0.5 * thickness;
  rules.spring = Spring{4 / (reach * reach), 0, reach};
  return rules;
}

BuiltField built_or_empty(SceneObject object, int resolution, Method method, std::string& note) {
  object.resolution = resolution;
  object.method = method;
  try {
    return build_alone(object, Content::distance_and_normal);
  } catch (const tess::Error& error) {
    note = error.what();
    return {};
  }
}

void study_fields(const Subject& subject,
                  const StudyOptions& options,
                  std::vector<StudyRow>& rows) {
  constexpr double step = 0.1;
  const Samples samples = samples_of(subject, options.n_samples);
  for (const Method method : {Method::exact, Method::normals, Method::potential})
    for (const int resolution : options.resolutions) {
      StudyRow row;
      row.part = "field";
      row.resolution = resolution;
      row.method = method_names[static_cast<std::size_t>(method)];
      const BuiltField built = built_or_empty(subject.object, resolution, method, row.note);
      if (!row.note.empty()) {
        rows.push_back(row);
        continue;
      }
      row.build_seconds = built.seconds;
      row.bytes = built.field.bytes();
      row.rule = "impact, swept";
      row.step = step;
      for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
        row.look_up = look_up_names[static_cast<std::size_t>(kind)];
        const Rules rules = impact_alone(kind, Sweep::on);
        const auto ask = [&](const Points& points, const Answers& answers) {
          look_up(built.field, kind, points, answers);
        };
        compare(ask, samples, row);
        bounce(built.field, rules, step * subject.thickness, subject, row);
        row.ns = ns_of(&built.field, rules, subject, options.n_timed);
        rows.push_back(row);
      }
    }
}

/// Nearest look-ups of a flat and a compressed field, by themselves: the step loop takes flat ones.
void study_compression(const Subject& subject,
                       const StudyOptions& options,
                       std::vector<StudyRow>& rows) {
  const Samples samples = samples_of(subject, options.n_samples);
  const Particles crowded = crowd(subject, options.n_timed);
  const auto floats = [](const std::vector<double>& values) {
    return std::vector<float>(values.begin(), values.end());
  };
  const std::vector<float> x = floats(crowded.x), y = floats(crowded.y), z = floats(crowded.z);
  std::vector<float> distance(x.size()), nx(x.size()), ny(x.size()), nz(x.size());
  for (const int resolution : options.resolutions) {
    StudyRow row;
    row.part = "memory";
    row.resolution = resolution;
    row.method = method_names.front();
    row.look_up = "nearest";
    const BuiltField built = built_or_empty(subject.object, resolution, Method::exact, row.note);
    if (!row.note.empty()) {
      rows.push_back(row);
      continue;
    }
    const auto measure = [&](const char* name, std::size_t bytes, double seconds, const auto& ask) {
      row.rule = name;
      row.bytes = bytes;
      row.build_seconds = seconds;
      compare(ask, samples, row);
      const Points points{x, y, z};
      const Answers answers{distance, nx, ny, nz};
      row.ns = fastest_seconds([&] { ask(points, answers); }) * 1e9 / static_cast<double>(x.size());
      rows.push_back(row);
    };
    measure("flat, look-up alone",
            built.field.bytes(),
            built.seconds,
            [&](const Points& points, const Answers& answers) {
              look_up(built.field, LookUp::nearest, points, answers);
            });
    const auto begin = std::chrono::steady_clock::now();
    const CompressedField compressed = compress(built.field, usual_bound(built.field));
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    measure("compressed, look-up alone",
            compressed.bytes(),
            seconds,
            [&](const Points& points, const Answers& answers) {
              nearest(compressed, points, answers.distance, {answers.nx, answers.ny, answers.nz});
            });
  }
}

void study_rules(const Subject& subject, const BuiltField& built, std::vector<StudyRow>& rows) {
  struct Named {
    const char* name;
    Rules rules;
  };
  const LookUp kind = LookUp::tangent;
  const std::array rules{Named{"impact, swept", impact_alone(kind, Sweep::on)},
                         Named{"impact", impact_alone(kind, Sweep::off)},
                         Named{"spring", spring_alone(kind, subject.thickness)}};
  for (const Named& rule : rules)
    for (const double step : {0.02, 0.1, 0.5, 2.0}) {
      StudyRow row;
      row.part = "rule";
      row.resolution = subject.object.resolution;
      row.method = method_names[static_cast<std::size_t>(subject.object.method)];
      row.look_up = look_up_names[static_cast<std::size_t>(kind)];
      row.rule = rule.name;
      row.step = step;
      bounce(built.field, rule.rules, step * subject.thickness, subject, row);
      rows.push_back(row);
    }
}

/// The paper's table 1: what collision costs, beside a tree of boxes that finds the closest
/// triangle of each particle.
void study_cost(const Subject& subject,
                const BuiltField& built,
                const StudyOptions& options,
                std::vector<StudyRow>& rows) {
  StudyRow row;
  row.part = "cost";
  row.resolution = subject.object.resolution;
  row.method = method_names[static_cast<std::size_t>(subject.object.method)];
  const std::size_t n = options.n_timed;
  row.rule = "no collision";
  row.ns = ns_of(nullptr, Rules{}, subject, n);
  rows.push_back(row);
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
    row.look_up = look_up_names[static_cast<std::size_t>(kind)];
    for (const Sweep sweep : {Sweep::off, Sweep::on}) {
      row.rule = sweep == Sweep::on ? "impact, swept" : "impact";
      row.ns = ns_of(&built.field, impact_alone(kind, sweep), subject, n);
      rows.push_back(row);
    }
  }
  row.rule = "closest triangle by a tree of boxes";
  row.look_up.clear();
  const std::size_t n_asked = std::min<std::size_t>(n, 20'000);
  const Particles particles = crowd(subject, n_asked);
  const double limit = subject.thickness * subject.thickness;
  double sum = 0;
  const double seconds = fastest_seconds([&] {
    for (std::size_t p = 0; p < n_asked; ++p)
      sum += subject.tree.closest(particles.position(p), limit).distance2;
  });
  row.ns = sum < 0 ? 0 : seconds * 1e9 / static_cast<double>(n_asked);
  rows.push_back(row);
}

}  // namespace

std::vector<StudyRow> study(const Scene& scene, const StudyOptions& options) {
  if (scene.objects.empty())
    tess::fail(tess::ErrorCode::bad_value,
               scene.name,
               ": objects: is empty; --study needs an object to bounce off");
  const SceneObject& object = scene.objects.front();
  const Subject subject{
      object,
      Bvh(object.surface),
      exact_bounces(object.surface, options.n_bounces, 0.8 * object.thickness, 11),
      object.thickness};
  if (subject.bounces.empty())
    tess::fail(tess::ErrorCode::bad_mesh,
               scene.name,
               ": objects[0].shape: no triangle can be met from its front; turn the triangles");
  std::vector<StudyRow> rows;
  study_fields(subject, options, rows);
  study_compression(subject, options, rows);
  const BuiltField built = build_alone(object, Content::distance_and_normal);
  study_rules(subject, built, rows);
  study_cost(subject, built, options, rows);
  return rows;
}

}  // namespace particles
