// The step loop of particles against a distance/normal field, per particle and step: CSV rows as in
// the other benchmarks, in picoseconds of processor time. A row is printed after its result was
// checked. "spread": particles all over the grid; "near": all within two voxels of the surface, the
// worst case.
//
// Rows in % compare two loops: the composed one with the one written by hand, the field of many
// triangles with that of few. Both run in turn and the fastest run of each counts, so that a busy
// machine affects both alike; 105 is allowed.
//
//     bench_dn_field --pes 1 [--particles 1000000] [--repeat 5]
#include "apps/bench/dn_field/dn_by_hand.hpp"
#include "apps/bench/dn_field/thread_watch.hpp"
#include "apps/bench/report.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "collide/dn_field/stepper.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <functional>
#include <random>

namespace bench {
namespace {

using namespace tess::dn;

constexpr int resolution = 60;
constexpr double half = 0.5;  // of the box

/// The box, each triangle cut into n².
Surface cut_box(int n) {
  const Surface box = make_box({half, half, half});
  Surface cut;
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto [a, b, c] = box.corners(t);
    const auto at = [&, from = a, u = b - a, v = c - a](int i, int j) {
      cut.vertices.push_back(from + (1.0 * i / n) * u + (1.0 * j / n) * v);
      return static_cast<std::uint32_t>(cut.vertices.size() - 1);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto p = at(i, j), q = at(i + 1, j), r = at(i, j + 1);
        cut.triangles.push_back({p, q, r});
        if (i + j + 1 < n) cut.triangles.push_back({q, at(i + 1, j + 1), r});
      }
  }
  return welded(cut);
}

/// To the box, negative inside.
double box_distance(Vec3 p) {
  const Vec3 q{std::abs(p.x) - half, std::abs(p.y) - half, std::abs(p.z) - half};
  const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(outside) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

/// Outside of the box, up to `furthest` from it, with velocities of all directions.
Particles placed(std::size_t count, double furthest) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const double reach = std::min(0.95, half + furthest);
  Particles particles;
  while (particles.size() < count) {
    const Vec3 x = reach * Vec3{anywhere(random), anywhere(random), anywhere(random)};
    const double distance = box_distance(x);
    if (distance > 1e-3 && distance < furthest)
      particles.push_back(x, 0.5 * Vec3{anywhere(random), anywhere(random), anywhere(random)});
  }
  return particles;
}

/// How far the worst particle is inside.
double deepest(const Particles& particles) {
  double depth = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    depth = std::max(depth, -box_distance(particles.position(p)));
  return depth;
}

struct Options {
  std::size_t particles = 1'000'000;
  int repeat = 5;
  std::string only;
};

using Run = std::function<void(Particles&)>;

/// The time of one run per particle and step, and where it left the particles.
struct Measured {
  Samples samples;
  Particles end;
};

/// Performs the runs in turn, each `repeat` times on a copy of `from` in the same memory.
std::vector<Measured> measured(int repeat, const Particles& from, const std::vector<Run>& runs) {
  std::vector<Measured> result(runs.size());
  Particles particles;
  for (int i = 0; i < repeat; ++i)
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const std::size_t turn = (k + static_cast<std::size_t>(i)) % runs.size();
      particles = from;
      const ThreadWatch watch;
      runs[turn](particles);
      const double took = watch.nanoseconds();
      result[turn].samples.add(1e3 * took / (n_steps * static_cast<double>(from.size())));
      if (i + 1 == repeat) result[turn].end = particles;
    }
  return result;
}

void require(bool holds, const std::string& what) {
  if (!holds) tess::fail(tess::ErrorCode::bad_value, "benchmark: wrong result: ", what);
}

double kinetic_energy(const Particles& particles) {
  double twice = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    twice += dot(particles.velocity(p), particles.velocity(p));
  return 0.5 * twice;
}

double loss(const Particles& from, const Particles& end) {
  return kinetic_energy(end) / kinetic_energy(from) - 1;
}

bool all_finite(const Particles& particles) {
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (!is_finite(particles.position(p)) || !is_finite(particles.velocity(p))) return false;
  return true;
}

Rules impact(LookUp look_up, Sweep sweep = Sweep::off) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{1, 0, sweep};
  return rules;
}

Rules all_rules(double cell) {
  Rules rules = impact(LookUp::tangent);
  rules.impact->restitution = 0.7;
  rules.spring = Spring{100, 1, cell};
  rules.surface_drag = SurfaceDrag{1, 2 * cell};
  rules.surface_flow = SurfaceFlow{1, 1, 2 * cell};
  rules.gravity = Gravity{{0, 0, -1}};
  rules.wind = Wind{{0.1, 0, 0}, 0.1};
  rules.air_drag = AirDrag{0.1, DragLaw::linear};
  rules.explosions = {Explosion{{}, 0.5, 2, 0, 1}};
  return rules;
}

class Bench {
 public:
  Bench(Report& report, const Options& options)
      : report_(report),
        options_(options),
        field_(build_field(box_, grid_around(bounds(box_), resolution, 0.45))),
        spread_(placed(options.particles, HUGE_VAL)),
        near_(placed(options.particles, 2 * cell())) {}

  void measure() {
    report_.header();
    free_flight();
    for (const Sweep sweep : {Sweep::off, Sweep::on}) impacts(sweep);
    every_rule();
    against_hand();
    triangles();
  }

 private:
  [[nodiscard]] double cell() const { return field_.grid.cell; }

  [[nodiscard]] Run stepped(const Rules& rules, int steps_a_call = n_steps) const {
    return stepped(rules, field_, steps_a_call);
  }
  [[nodiscard]] static Run stepped(const Rules& rules, const Field& field, int steps_a_call) {
    return [met = Object{&field, {}}, stepper = make_stepper(rules, step),
            steps_a_call](Particles& particles) {
      for (int i = 0; i < n_steps; i += steps_a_call)
        stepper.run(particles.span(), {&met, 1}, i * step, steps_a_call);
    };
  }

  [[nodiscard]] bool wanted(std::string_view name) const {
    return name.find(options_.only) != std::string_view::npos;
  }
  void row(const std::string& name, const Samples& samples) const {
    report_.row(name, samples, "ps/particle/step");
  }
  /// The fastest of `samples` in percent of the fastest of `base`.
  void share(const std::string& name, const Samples& samples, const Samples& base) const {
    Samples percent;
    percent.add(100 * samples.least() / base.least());
    report_.row(name, percent, "%", 105);
  }

  void free_flight() {
    for (const int steps_a_call : {n_steps, 1}) {
      const std::string name = steps_a_call == 1 ? "dn none; one step a call" : "dn none";
      if (!wanted(name)) continue;
      const Measured found =
          measured(options_.repeat, spread_, {stepped({}, steps_a_call)}).front();
      require(std::abs(found.end.x[0] - (spread_.x[0] + n_steps * step * spread_.vx[0])) < 1e-12,
              "free flight");
      row(name, found.samples);
    }
  }

  void bounce(const std::string& name, Particles& from, const Rules& rules, double depth,
              int steps_a_call = n_steps) {
    if (!wanted(name)) return;
    Measured found = measured(options_.repeat, from, {stepped(rules, steps_a_call)}).front();
    require(all_finite(found.end), name + ", not finite");
    require(std::abs(loss(from, found.end)) < 1e-12, name + ", energy");
    require(deepest(found.end) < depth * cell(),
            tess::text(name, ", ", deepest(found.end) / cell(), " cells deep"));
    row(name, found.samples);
  }

  void impacts(Sweep sweep) {
    if (sweep == Sweep::on) {
      const Rules swept = impact(LookUp::tangent, sweep);
      bounce("dn tangent + swept impact; spread", spread_, swept, 0.1);
      bounce("dn tangent + swept impact; near", near_, swept, 0.1);
      // Up to 1.6 voxels per step: particles that may meet the surface are traced. Across an edge a
      // voxel may have only the other face.
      Particles fast = spread_;
      for (auto* v : {&fast.vx, &fast.vy, &fast.vz})
        for (double& component : *v) component *= 100;
      bounce("dn tangent + swept impact; fast", fast, swept, 0.5);
      return;
    }
    const Rules nearest = impact(LookUp::nearest), trilinear = impact(LookUp::trilinear);
    bounce("dn nearest + impact; spread", spread_, nearest, 0.9);
    bounce("dn nearest + impact; spread; one step a call", spread_, nearest, 0.9, 1);
    bounce("dn nearest + impact; near", near_, nearest, 0.9);
    // Between the voxels about a corner of the box blended distances are up to 0.31 cells too
    // large.
    bounce("dn trilinear + impact; spread", spread_, trilinear, 0.31);
    bounce("dn trilinear + impact; near", near_, trilinear, 0.31);
  }

  void every_rule() {
    for (const Particles* from : {&spread_, &near_}) {
      const std::string name = from == &spread_ ? "dn all rules; spread" : "dn all rules; near";
      if (!wanted(name)) continue;
      Measured found = measured(options_.repeat, *from, {stepped(all_rules(cell()))}).front();
      require(all_finite(found.end) && deepest(found.end) < 0.9 * cell(), name);
      row(name, found.samples);
    }
  }

  /// A float's rounding can choose the neighbouring voxel, so a few particles may differ by more.
  void hand_and_loop(const std::string& name, const Particles& from, const Run& by_hand,
                     const Rules& rules, double tolerance) {
    if (!wanted(name)) return;
    const auto found = measured(3 * options_.repeat, from, {by_hand, stepped(rules)});
    std::size_t different = 0;
    for (std::size_t p = 0; p < from.size(); ++p)
      if (norm(found[0].end.position(p) - found[1].end.position(p)) > tolerance) ++different;
    require(different < from.size() / 1000, name + " by hand");
    row(name + " by hand", found[0].samples);
    row(name, found[1].samples);
    share(name + " against by hand", found[1].samples, found[0].samples);
  }

  void against_hand() {
    const Vec3 g{0.1, 0.2, -1};
    Rules gravity;
    gravity.gravity = Gravity{g};
    hand_and_loop(
        "dn gravity", spread_, [&](Particles& p) { gravity_by_hand(p.span(), g); }, gravity, 1e-12);
    Rules air;
    air.air_drag = AirDrag{1, DragLaw::linear};
    hand_and_loop(
        "dn air drag", spread_, [&](Particles& p) { air_drag_by_hand(p.span(), 1); }, air, 1e-12);
    Rules explosion;
    explosion.explosions = {Explosion{{}, 0.5, 2, 0, 1}};
    hand_and_loop(
        "dn explosion", spread_,
        [&](Particles& p) { explosion_by_hand(p.span(), explosion.explosions.front()); }, explosion,
        1e-6);
    Rules drag, flow, spring;
    drag.look_up = flow.look_up = LookUp::nearest;
    drag.surface_drag = SurfaceDrag{1, 2 * cell()};
    flow.surface_flow = SurfaceFlow{1, 1, 2 * cell()};
    spring.spring = Spring{100, 1, cell()};
    for (const Particles* from : {&spread_, &near_}) {
      const std::string where = from == &spread_ ? "; spread" : "; near";
      hand_and_loop(
          "dn surface drag" + where, *from,
          [&](Particles& p) { surface_drag_by_hand(p.span(), field_, 1, 2 * cell()); }, drag, 1e-5);
      hand_and_loop(
          "dn impact" + where, *from, [&](Particles& p) { impact_by_hand(p.span(), field_); },
          impact(LookUp::nearest), 1e-5);
      hand_and_loop(
          "dn surface flow" + where, *from,
          [&](Particles& p) { flow_by_hand(p.span(), field_, *flow.surface_flow); }, flow, 1e-5);
      hand_and_loop(
          "dn spring" + where, *from,
          [&](Particles& p) { spring_by_hand(p.span(), field_, *spring.spring); }, spring, 1e-4);
    }
  }

  /// The same box cut finer, fields of the same grid.
  void triangles() {
    if (!wanted("triangles")) return;
    std::vector<Field> fields;
    std::vector<std::string> names;
    for (const int cuts : {1, 10, 100}) {
      const Surface surface = cut_box(cuts);
      names.push_back(tess::text("dn impact; spread; ", surface.triangles.size(), " triangles"));
      fields.push_back(build_field(surface, field_.grid));
    }
    std::vector<Run> runs;
    for (const Field& field : fields)
      runs.push_back(stepped(impact(LookUp::nearest), field, n_steps));
    auto found = measured(3 * options_.repeat, spread_, runs);
    for (std::size_t k = 0; k < found.size(); ++k) {
      require(std::abs(loss(spread_, found[k].end)) < 1e-12, names[k]);
      row(names[k], found[k].samples);
      if (k > 0) share(names[k] + " against 12", found[k].samples, found[0].samples);
    }
  }

  Report& report_;
  const Options& options_;
  Surface box_ = cut_box(1);
  Field field_;
  Particles spread_, near_;
};

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    tess::Setup setup = tess::take_options(argc, argv);
    bench::Options options;
    tess::CommandLine line("The cost of a particle's step in a distance/normal field.");
    line.option("--particles", options.particles, "how many").between(1000, 100'000'000);
    line.option("--repeat", options.repeat, "how often each is measured").between(1, 1000);
    line.option("--only", options.only, "measures whose name has this in it");
    if (!line.parse(argc, argv)) return 0;
    const std::string machine = setup.machine->describe();
    bench::Report report({machine.substr(0, std::min(machine.find(';'), machine.find(" on ")))});
    return tess::run(setup, [&] { bench::Bench(report, options).measure(); });
  });
}
