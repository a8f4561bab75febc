#include "apps/particles/study/study.hpp"

#include "apps/particles/simulation/field_making.hpp"
#include "apps/particles/study/measure.hpp"
#include "collide/dn_field/compressed.hpp"
#include "runtime/core/error.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace particles {
namespace {
using namespace tess::dn;

/// The look-ups that a field supports.
std::vector<LookUp> kinds_of(const Field& field) {
  if (field.planes != nullptr) return {LookUp::nearest, LookUp::tangent};
  return {LookUp::nearest, LookUp::tangent, LookUp::trilinear};
}

/// Impact without loss.
Rules impact_rules(LookUp look_up, Sweep sweep) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{1, 0, sweep};
  return rules;
}

/// Steps so short that the crowd stays where it is.
void time_crowd(const Object* object, const Rules& rules, const Subject& subject, std::size_t n,
                StudyRow& row) {
  constexpr int n_steps = 16;
  time_steps(object, rules, 0.1 * subject.thickness / n_steps, n_steps, subject, n, row);
}

/// The object around the origin: places that are compared in float keep their digits. A field from
/// a file stays where it is.
SceneObject centred(SceneObject object) {
  if (!object.field.empty()) return object;
  const Vec3 centre = bounds(object.surface).centre();
  for (Vec3& v : object.surface.vertices) v = v - centre;
  object.grid.origin = object.grid.origin - centre;
  return object;
}

Subject around(SceneObject object) {
  Bvh tree(object.surface);
  const double thickness = object.thickness;
  return {std::move(object), std::move(tree), {}, thickness};
}

class Study {
 public:
  Study(const SceneObject& object, const StudyOptions& options, const std::string& scene)
      : options_(options), subject_(around(centred(object))) {
    subject_.bounces = exact_bounces(subject_.object.surface, subject_.tree, options.n_bounces,
                                     0.8 * object.thickness, 11);
    if (subject_.bounces.empty())
      tess::fail(tess::ErrorCode::bad_mesh, scene,
                 ": objects[0].shape: no triangle can be met from its front; turn the triangles");
  }

  std::vector<StudyRow> run() {
    study_fields();
    field_ = build_alone(subject_.object, Content::distance_and_normal);
    show("study: rules");
    study_rules();
    show("study: costs");
    study_cost();
    return std::move(rows_);
  }

 private:
  void show(const char* phase, std::size_t part = 0, std::size_t n_parts = 0) const {
    if (options_.progress == nullptr) return;
    options_.progress->part(part, n_parts);
    options_.progress->phase(phase);
  }

  [[nodiscard]] StudyRow row_of(const char* part, int resolution, Method method) const {
    StudyRow row;
    row.part = part;
    row.resolution = resolution;
    row.method = name_of(method);
    return row;
  }

  void study_fields() {
    const Samples samples = samples_of(subject_, options_.n_samples);
    const std::size_t n_fields = 3 * options_.resolutions.size();
    std::size_t n_done = 0;
    for (const Method method : {Method::exact, Method::normals, Method::potential})
      for (const int resolution : options_.resolutions) {
        show("study: fields", ++n_done, n_fields);
        StudyRow row = row_of("field", resolution, method);
        SceneObject object = subject_.object;
        object.method = method;
        object.field.clear();
        Field field;
        Cost cost;
        try {
          object.grid = grid_around(bounds(object.surface), resolution, object.thickness);
          cost = least_cost([&] { field = build_alone(object, Content::distance_and_normal); });
        } catch (const tess::Error& error) {
          row.note = std::string("refused: ") + error.what();
          rows_.push_back(row);
          continue;
        }
        row.build_seconds = cost.wall, row.build_cpu_seconds = cost.cpu;
        row.bytes = static_cast<double>(field.bytes());
        row.rule = "impact, swept";
        row.step = 0.1;
        row.stored = "flat";
        study_look_ups(field, samples, row);
        if (method == Method::exact) study_compressed(field, samples, row);
      }
  }

  void study_compressed(const Field& field, const Samples& samples, StudyRow row) {
    Field compressed;
    const Cost cost = least_cost([&] { compressed = compress(field, bound_of({}, field)); });
    *row.build_seconds += cost.wall, *row.build_cpu_seconds += cost.cpu;
    row.bytes = static_cast<double>(compressed.bytes());
    row.stored = "compressed";
    study_look_ups(compressed, samples, row);
  }

  /// Swept impacts in a field as it is stored.
  void study_look_ups(const Field& field, const Samples& samples, StudyRow row) {
    for (const LookUp kind : kinds_of(field)) {
      row.look_up = name_of(kind);
      compare(field, kind, samples, row);
      row.order = order_of(row);
      const Object object{&field, {}};
      const Rules rules = impact_rules(kind, Sweep::on);
      compare_bounces(object, rules, *row.step * subject_.thickness, subject_, row);
      time_crowd(&object, rules, subject_, options_.n_timed, row);
      rows_.push_back(row);
    }
  }

  /// The power of the cell with which the error of the distance fell since the next coarser field.
  [[nodiscard]] Measurement order_of(const StudyRow& row) const {
    const StudyRow* coarser = nullptr;
    for (const StudyRow& other : rows_)
      if (other.method == row.method && other.stored == row.stored &&
          other.look_up == row.look_up && other.resolution < row.resolution &&
          (coarser == nullptr || other.resolution > coarser->resolution))
        coarser = &other;
    if (coarser == nullptr || !coarser->distance_error || !row.distance_error) return {};
    return kit::order_between({1 / (coarser->resolution - 1.0), *coarser->distance_error},
                              {1 / (row.resolution - 1.0), *row.distance_error});
  }

  /// All rules by themselves, at several steps, in the object's own field.
  void study_rules() {
    constexpr std::array steps{0.02, 0.1, 0.5, 2.0};
    const double thickness = subject_.thickness, time = 2 * thickness;
    const Object object{&field_, {}};
    StudyRow row = row_of("rule", subject_.object.grid.n[0], subject_.object.method);
    row.stored = "flat";
    row.look_up = name_of(LookUp::tangent);
    const auto study = [&](const char* name, const Rules& rules, const auto& measure) {
      for (const double step : steps) {
        StudyRow now = row;
        now.rule = name;
        now.step = step;
        measure(step * thickness, now);
        time_steps(&object, rules, step * thickness, 1, subject_, options_.n_timed, now);
        rows_.push_back(now);
      }
    };
    const auto study_bounces = [&](const char* name, const Rules& rules) {
      study(name, rules,
            [&](double dt, StudyRow& now) { compare_bounces(object, rules, dt, subject_, now); });
    };
    study_bounces("impact, swept", impact_rules(LookUp::tangent, Sweep::on));
    study_bounces("impact", impact_rules(LookUp::tangent, Sweep::off));
    Rules spring;  // a particle of speed 1 presses it half way to the surface
    const double reach = 0.5 * thickness;
    spring.spring = Spring{4 / (reach * reach), 0, reach};
    study_bounces("spring", spring);

    // Flights in front of the surface, against those of short steps. A particle that comes straight
    // on is left out: it has no tangent to turn to, a rounding error decides its side.
    const double straight = std::cos(std::numbers::pi / 12), shortest = 0.1 * steps.front();
    constexpr std::size_t most_flights = 100;
    Particles starts;
    for (const Bounce& b : subject_.bounces)
      if (-dot(b.normal(), b.velocity) < straight && starts.size() < most_flights)
        starts.push_back(b.start, b.velocity);
    const auto study_flights = [&](const char* name, const Rules& rules) {
      const Particles wanted = flown(object, rules, shortest * thickness, time, starts);
      study(name, rules, [&](double dt, StudyRow& now) {
        compare_flights(flown(object, rules, dt, time, starts), wanted, now);
      });
    };
    // They begin at 0.8 of the thickness with speed 1: the drag stops those that come straight on
    // in front of the surface, and the flow turns them to the tangent there.
    Rules drag, flow;
    drag.surface_drag = SurfaceDrag{2.5 / thickness, 0.5 * thickness};
    flow.surface_flow = SurfaceFlow{4 / thickness, 4 / thickness, 0.7 * thickness};
    study_flights("drag", drag);
    study_flights("surface flow", flow);
  }

  /// The paper's table 1: what collision costs, beside a tree of boxes that finds the closest
  /// triangle of each particle.
  void study_cost() {
    const std::size_t first = rows_.size(), n = options_.n_timed;
    StudyRow row = row_of("cost", subject_.object.grid.n[0], subject_.object.method);
    row.rule = "no collision";
    time_crowd(nullptr, {}, subject_, n, row);
    rows_.push_back(row);
    const Field compressed = compress(field_, bound_of({}, field_));
    for (const Field* field : std::array<const Field*, 2>{&field_, &compressed})
      for (const LookUp kind : kinds_of(*field)) {
        row.look_up = name_of(kind);
        row.stored = field == &field_ ? "flat" : "compressed";
        row.bytes = static_cast<double>(field->bytes());
        const Object object{field, {}};
        for (const Sweep sweep : {Sweep::off, Sweep::on}) {
          row.rule = sweep == Sweep::on ? "impact, swept" : "impact";
          time_crowd(&object, impact_rules(kind, sweep), subject_, n, row);
          rows_.push_back(row);
        }
      }
    row.look_up.clear();
    row.stored.clear();
    row.bytes.reset();
    for (const double part : {1.0, 0.1}) {
      row.rule = part == 1 ? "tree of boxes, whole thickness" : "tree of boxes, way of a step";
      time_tree(part * subject_.thickness, row);
      rows_.push_back(row);
    }
    const double none = *rows_[first].cpu_ns, tree = *row.cpu_ns;
    for (std::size_t i = first + 1; i < rows_.size(); ++i)
      rows_[i].relative = (*rows_[i].cpu_ns - (rows_[i].stored.empty() ? 0 : none)) / tree;
  }

  /// Times the search for the closest triangle nearer than `reach` of each particle.
  void time_tree(double reach, StudyRow& row) const {
    const Particles particles = crowd(subject_, std::min<std::size_t>(options_.n_timed, 20'000));
    volatile double sum = 0;  // so that no search is left out
    const Cost cost = least_cost([&] {
      for (std::size_t p = 0; p < particles.size(); ++p)
        sum = sum + subject_.tree.closest(particles.position(p), reach * reach).distance2;
    });
    set_times(row, cost, static_cast<double>(particles.size()));
  }

  const StudyOptions& options_;
  Subject subject_;
  Field field_;  // of the object as the scene gives it
  std::vector<StudyRow> rows_;
};

}  // namespace

std::vector<StudyRow> study(const Scene& scene, const StudyOptions& options) {
  return Study(scene.objects.front(), options, scene.name).run();
}

}  // namespace particles
