#include "apps/particles/study.hpp"

#include "apps/particles/fields.hpp"
#include "apps/particles/study_measure.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace particles {
namespace {
using namespace tess::dn;

constexpr std::array method_names{"exact", "normals", "potential"};
constexpr std::array look_up_names{"nearest", "tangent", "trilinear"};

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

/// A crowd's positions as look-ups take them.
struct Crowd {
  Crowd(const Subject& subject, std::size_t n) {
    const Particles particles = crowd(subject, n);
    x.assign(particles.x.begin(), particles.x.end());
    y.assign(particles.y.begin(), particles.y.end());
    z.assign(particles.z.begin(), particles.z.end());
  }
  std::vector<float> x, y, z;
};

double look_up_ns(const Crowd& of, const Ask& ask) {
  const std::size_t n = of.x.size();
  std::vector<float> distance(n), nx(n), ny(n), nz(n);
  const Points points{of.x, of.y, of.z};
  const Answers answers{distance, nx, ny, nz};
  return fastest_seconds([&] { ask(points, answers); }) * 1e9 / static_cast<double>(n);
}

/// Nearest look-ups of a flat and a compressed field, by themselves: the step loop takes flat ones.
void study_compression(const Subject& subject,
                       const StudyOptions& options,
                       std::vector<StudyRow>& rows) {
  const Samples samples = samples_of(subject, options.n_samples);
  const Crowd crowded(subject, options.n_timed);
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
      row.ns = look_up_ns(crowded, ask);
      rows.push_back(row);
    };
    measure("flat, look-up alone",
            built.field.bytes(),
            built.seconds,
            [&](const Points& points, const Answers& answers) {
              look_up(built.field, LookUp::nearest, points, answers);
            });
    const auto begin = std::chrono::steady_clock::now();
    const CompressedField compressed = compress(built.field, bound_of({}, built.field));
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

/// Nanoseconds to find the closest triangle nearer than `reach` of a particle by a tree of boxes.
double tree_ns(const Subject& subject, std::size_t n, double reach) {
  const std::size_t n_asked = std::min<std::size_t>(n, 20'000);
  const Particles particles = crowd(subject, n_asked);
  double sum = 0;
  const double seconds = fastest_seconds([&] {
    for (std::size_t p = 0; p < n_asked; ++p)
      sum += subject.tree.closest(particles.position(p), reach * reach).distance2;
  });
  return sum < 0 ? 0 : seconds * 1e9 / static_cast<double>(n_asked);
}

/// The paper's table 1: what collision costs, beside a tree of boxes that finds the closest
/// triangle of each particle.
void study_cost(const Subject& subject,
                const BuiltField& built,
                const StudyOptions& options,
                std::vector<StudyRow>& rows) {
  const std::size_t first = rows.size();
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
  row.look_up = look_up_names.front();
  row.rule = "compressed, look-up alone";
  const CompressedField compressed = compress(built.field, bound_of({}, built.field));
  row.ns = look_up_ns(Crowd(subject, n), [&](const Points& points, const Answers& answers) {
    nearest(compressed, points, answers.distance, {answers.nx, answers.ny, answers.nz});
  });
  rows.push_back(row);
  row.look_up.clear();
  row.rule = "tree of boxes, whole thickness";
  row.ns = tree_ns(subject, n, subject.thickness);
  rows.push_back(row);
  row.rule = "tree of boxes, way of a step";
  row.ns = tree_ns(subject, n, 0.1 * subject.thickness);
  rows.push_back(row);
  const double none = rows[first].ns, tree = row.ns;
  for (std::size_t i = first; i < rows.size(); ++i) {
    const bool steps = rows[i].rule.starts_with("impact");
    rows[i].relative = (rows[i].ns - (steps ? none : 0)) / tree;
  }
  rows[first].relative = -1;
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
