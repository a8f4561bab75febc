#include "apps/particles/study/study.hpp"

#include "apps/particles/simulation/field_making.hpp"
#include "apps/particles/study/rules.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace particles {
namespace {
using namespace tess::dn;

BuiltField built_or_empty(SceneObject object, int resolution, Method method, std::string& note) {
  object.method = method;
  object.field.clear();
  try {
    object.grid = grid_around(bounds(object.surface), resolution, object.thickness);
    return build_alone(object, Content::distance_and_normal);
  } catch (const tess::Error& error) {
    note = error.what();
    return {};
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

/// Nearest look-ups of a flat and a compressed field, by themselves.
void study_memory(const Subject& subject, const StudyOptions& options, const BuiltField& built,
                  const CompressedField& compressed, double seconds_of_compression,
                  const Samples& samples, std::vector<StudyRow>& rows) {
  const Crowd crowded(subject, options.n_timed);
  StudyRow row;
  row.part = "memory";
  row.resolution = built.field.grid.n[0];
  row.method = name_of(Method::exact);
  row.look_up = name_of(LookUp::nearest);
  row.rule = "look-up alone";
  const auto measure = [&](const char* stored, std::size_t bytes, double seconds, const auto& ask) {
    row.stored = stored;
    row.bytes = bytes;
    row.build_seconds = seconds;
    compare(ask, samples, row);
    row.ns = look_up_ns(crowded, ask);
    rows.push_back(row);
  };
  measure("flat", built.field.bytes(), built.seconds,
          [&](const Points& points, const Answers& answers) {
            look_up(built.field, LookUp::nearest, points, answers);
          });
  measure("compressed", compressed.bytes(), seconds_of_compression,
          [&](const Points& points, const Answers& answers) {
            look_up(compressed, LookUp::nearest, points, answers);
          });
}

constexpr double step_of_fields = 0.1;

/// Swept impacts in a field as it is stored; errors of distance and normal for flat ones, whose
/// look-ups of all kinds stand by themselves.
void study_look_ups(const Subject& subject, const StudyOptions& options, const Object& object,
                    const Samples& samples, StudyRow row, std::vector<StudyRow>& rows) {
  for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
    if (object.compressed != nullptr && kind == LookUp::trilinear) continue;
    row.look_up = name_of(kind);
    const Rules rules = impact_alone(kind, Sweep::on);
    if (object.compressed == nullptr)
      compare([&](const Points& points,
                  const Answers& answers) { look_up(*object.field, kind, points, answers); },
              samples, row);
    bounce(object, rules, step_of_fields * subject.thickness, subject, row);
    row.ns = ns_of(&object, rules, subject, options.n_timed);
    rows.push_back(row);
  }
}

void now_at(const StudyOptions& options, const char* phase, std::size_t part = 0,
            std::size_t n_parts = 0) {
  if (options.progress == nullptr) return;
  options.progress->part(static_cast<std::uint32_t>(part), static_cast<std::uint32_t>(n_parts));
  options.progress->phase(phase);
}

/// Rows of fields, and of memory apart.
void study_fields(const Subject& subject, const StudyOptions& options, std::vector<StudyRow>& rows,
                  std::vector<StudyRow>& memory) {
  const Samples samples = samples_of(subject, options.n_samples);
  const std::size_t n_fields = 3 * options.resolutions.size();
  std::size_t field = 0;
  for (const Method method : {Method::exact, Method::normals, Method::potential})
    for (const int resolution : options.resolutions) {
      now_at(options, "study: fields", ++field, n_fields);
      StudyRow row;
      row.part = "field";
      row.resolution = resolution;
      row.method = name_of(method);
      const BuiltField built = built_or_empty(subject.object, resolution, method, row.note);
      if (!row.note.empty()) {
        rows.push_back(row);
        continue;
      }
      row.build_seconds = built.seconds;
      row.bytes = built.field.bytes();
      row.rule = "impact, swept";
      row.step = step_of_fields;
      row.stored = "flat";
      study_look_ups(subject, options, {&built.field, {}}, samples, row, rows);
      if (method != Method::exact) continue;
      const auto begin = std::chrono::steady_clock::now();
      const CompressedField compressed = compress(built.field, bound_of({}, built.field));
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      row.build_seconds += seconds;
      row.bytes = compressed.bytes();
      row.stored = "compressed";
      study_look_ups(subject, options, {&built.field, {}, &compressed}, samples, row, rows);
      study_memory(subject, options, built, compressed, seconds, samples, memory);
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
void study_cost(const Subject& subject, const BuiltField& built, const StudyOptions& options,
                std::vector<StudyRow>& rows) {
  const std::size_t first = rows.size();
  StudyRow row;
  row.part = "cost";
  row.resolution = subject.object.grid.n[0];
  row.method = name_of(subject.object.method);
  const std::size_t n = options.n_timed;
  row.rule = "no collision";
  row.ns = ns_of(nullptr, Rules{}, subject, n);
  rows.push_back(row);
  const CompressedField compressed = compress(built.field, bound_of({}, built.field));
  for (const CompressedField* planes : {static_cast<const CompressedField*>(nullptr), &compressed})
    for (const LookUp kind : {LookUp::nearest, LookUp::tangent, LookUp::trilinear}) {
      if (planes != nullptr && kind == LookUp::trilinear) continue;
      row.look_up = name_of(kind);
      row.stored = planes != nullptr ? "compressed" : "flat";
      row.bytes = planes != nullptr ? planes->bytes() : built.field.bytes();
      const Object object{&built.field, {}, planes};
      for (const Sweep sweep : {Sweep::off, Sweep::on}) {
        row.rule = sweep == Sweep::on ? "impact, swept" : "impact";
        row.ns = ns_of(&object, impact_alone(kind, sweep), subject, n);
        rows.push_back(row);
      }
    }
  row.look_up.clear();
  row.stored.clear();
  row.bytes = 0;
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
    tess::fail(tess::ErrorCode::bad_value, scene.name,
               ": objects: is empty; --study needs an object to bounce off");
  const SceneObject& object = scene.objects.front();
  const Subject subject{
      object, Bvh(object.surface),
      exact_bounces(object.surface, options.n_bounces, 0.8 * object.thickness, 11),
      object.thickness};
  if (subject.bounces.empty())
    tess::fail(tess::ErrorCode::bad_mesh, scene.name,
               ": objects[0].shape: no triangle can be met from its front; turn the triangles");
  std::vector<StudyRow> rows, memory;
  study_fields(subject, options, rows, memory);
  rows.insert(rows.end(), memory.begin(), memory.end());
  const BuiltField built = build_alone(object, Content::distance_and_normal);
  now_at(options, "study: rules");
  study_rules(subject, options, built, rows);
  now_at(options, "study: costs");
  study_cost(subject, built, options, rows);
  return rows;
}

}  // namespace particles
