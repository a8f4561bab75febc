// What runs of scenes must show: energies that rules keep, particles that go through a surface or
// cannot, and the paper's three regimes of flow around a shaft.
#include "apps/kit/worst.hpp"
#include "apps/particles/output/report.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/apps/particles/run_scene.hpp"

#include <fmt/core.h>

using namespace particles;
using tess::dn::Vec3;

namespace {

Scene falling_on_box(const std::string& rules, const std::string& outputs) {
  return scene_of(R"({"dt": 0.02, "steps": 60,
    "objects": [{"shape": {"box": {"half": [1, 1, 0.5]}}, "resolution": 32, "thickness": 0.5}],
    "emitters": [{"count": 200, "box": {"low": [-0.7, -0.7, 1], "high": [0.7, 0.7, 1.2]}, "velocity": [0, 0, -2]}],
    "rules": )" + rules +
                  R"(, "outputs": )" + outputs + "}");
}

double relative(const Ran& ran) {
  const double begin = ran.result.rows.front().measured.energy();
  return std::abs(ran.last().energy() - begin) / std::abs(begin);
}

}  // namespace

TEST_CASE("without losses the energy stays, with losses it falls", "[particles][physics]") {
  const std::string fall = R"("gravity": [0, 0, -5])";
  const auto of = [&](const std::string& rule) {
    return run_scene(falling_on_box("{" + fall + rule + "}", "{}"), "--pes=1");
  };
  CHECK(relative(of("")) < 1e-12);
  // A bounce in the midst of a step keeps the energy to the depth that gravity works on in it.
  const Ran bouncy = of(R"(, "impact": {"restitution": 1})");
  CHECK(relative(bouncy) < 1e-2);
  CHECK(bouncy.last().tunnelled == 0);
  const Ran dull = of(R"(, "impact": {"restitution": 0.2})");
  CHECK(dull.last().energy() < 0.8 * dull.result.rows.front().measured.energy());
  CHECK(dull.last().tunnelled == 0);
}

TEST_CASE("swept impact lets nothing through at any speed, and bounces it back",
          "[particles][physics]") {
  for (const double speed : {3.0, 300.0, 3e5}) {
    Scene scene = falling_on_box(R"({"impact": {"restitution": 1}})", R"({"audit": true})");
    scene.emitters[0].velocity = {0, 0, -speed};
    const Ran ran = run_scene(scene, "--pes=1");
    CHECK(ran.last().tunnelled == 0);
    CHECK(ran.last().inside == 0);
    CHECK(relative(ran) < 1e-6);
    CHECK(ran.result.audited == 200);
  }
}

TEST_CASE("a growing sphere sweeps up what rests around it, and lets nothing in",
          "[particles][physics]") {
  // Its surface stands at 0.5 + t; what it meets leaves with twice its speed.
  const std::string scene = R"({"dt": DT, "steps": STEPS,
    "objects": [{"shape": {"sphere": {"radius": 0.5, "rings": 60}}, "resolution": 48, "thickness": 0.3,
                 "transform": {"position": [1, 2, 3]}, "motion": {"scale": 2}}],
    "emitters": [{"count": 300, "sphere": {"centre": [1, 2, 3], "radius": 1.4, "inner": 0.7}}],
    "rules": {"impact": {"restitution": 1}}, "outputs": {"trajectories": 1000}})";
  for (const auto& [dt, steps] : {std::pair("0.01", "100"), std::pair("0.5", "2")}) {
    std::string text = scene;
    text.replace(text.find("DT"), 2, dt);
    text.replace(text.find("STEPS"), 5, steps);
    const Ran ran = run_scene(scene_of(text), "--pes=2");
    CHECK(ran.last().tunnelled == 0);
    CHECK(ran.last().inside == 0);
    const auto &first = ran.result.trajectories.front().samples,
               &last = ran.result.trajectories.back().samples;
    for (std::size_t p = 0; p < last.size(); ++p) {
      const Vec3 from = first[p].position - Vec3{1, 2, 3}, to = last[p].position - Vec3{1, 2, 3};
      const double met = norm(from) - 0.5;  // when
      // The normal of the nearest voxel is off by half its diagonal over the radius (0.06), and by
      // half a facet (0.03).
      CHECK(norm(last[p].velocity - 2 * direction(from)) < 0.18);
      CHECK(norm(to - (norm(from) + 2 * (1 - met)) * direction(from)) < 0.18);
    }
  }
  // A run that it would not outlive is refused, also where --steps says so.
  Scene shrinks = scene_of(R"({"dt": 0.1, "steps": 10, "objects":
    [{"shape": {"box": {"half": [1, 1, 1]}}, "thickness": 1, "resolution": 20, "motion": {"scale": -0.9}}],
    "emitters": [{"count": 1, "sphere": {"radius": 1}}]})");
  shrinks.steps = 12;
  CHECK_THROWS_WITH(check_scene(shrinks), Contains("objects[0].motion.scale: -0.9"));
}

TEST_CASE("spring and impact together want a body that turns little in a step",
          "[particles][physics]") {
  const auto scene = [](const std::string& rules) {
    return R"({"dt": 0.1, "steps": 10, "objects":
      [{"shape": {"box": {"half": [1, 1, 1]}}, "resolution": 20, "motion": {"spin": [0, 12, 16]}}],
      "emitters": [{"count": 1, "sphere": {"radius": 1}}], "rules": {)" +
           rules + "}}";
  };
  const std::string spring = R"("spring": {"stiffness": 1, "reach": 0.1})",
                    impact = R"("impact": {"restitution": 1})";
  CHECK_NOTHROW(scene_of(scene(impact)));
  CHECK_THROWS_WITH(
      scene_of(scene(spring + ", " + impact)),
      Contains("objects[0].motion.spin: turns 2 rad in a step of dt 0.1, more than "
               "0.05 with spring and impact together; give a dt of 0.00249975 or less"));
  std::string told = scene(spring + ", " + impact);
  told.replace(told.find("0.1"), 3, "0.00249975");
  CHECK_NOTHROW(scene_of(told));
}

TEST_CASE("particles that go through a surface are counted, each once", "[particles][physics]") {
  // A spring too weak to hold anything: all 200 go in at the top and leave at the bottom.
  const std::string weak = R"({"spring": {"stiffness": 1e-6, "reach": 0.1}})";
  const Ran each_step = run_scene(falling_on_box(weak, R"({"audit": true})"), "--pes=2");
  CHECK(each_step.result.audited == 200);
  CHECK(each_step.last().tunnelled == 200);
  CHECK(each_step.last().inside == 0);
  // A sample finds its part of them.
  const Ran sampled = run_scene(falling_on_box(weak, R"({"audit": 50})"), "--pes=2");
  CHECK(sampled.result.audited == 50);
  CHECK(sampled.last().tunnelled == 50);
  CHECK(sampled.last().hash == each_step.last().hash);
  CHECK(sampled.result.audit_seconds > 0);
  // By default only the last step is judged, which misses those that have left again.
  const Ran usual = run_scene(falling_on_box(weak, "{}"), "--pes=2");
  CHECK(usual.result.audited == 0);
  CHECK(usual.result.audit_seconds == 0);
  CHECK(usual.last().tunnelled == 0);
  Scene scene = falling_on_box(weak, R"({"audit": false})");
  CHECK(run_scene(scene, "--pes=2").last().tunnelled == 0);
  scene.steps = 30;  // in the midst of the box
  const Ran last_step = run_scene(scene, "--pes=2");
  CHECK(last_step.last().tunnelled == 200);
  CHECK(last_step.last().inside == 200);
  // A particle that begins inside has not gone through a surface.
  scene.emitters[0].low = {-0.5, -0.5, -0.2}, scene.emitters[0].high = {0.5, 0.5, 0.2};
  scene.emitters[0].velocity = {};
  const Ran begun = run_scene(scene, "--pes=2");
  CHECK(begun.last().tunnelled == 0);
  CHECK_THAT(begun.table, Contains("200 of 200 particles begin below a surface"));
  CHECK_THAT(last_step.table, !Contains("begin below"));
}

TEST_CASE("particles that a spinning body meets and takes along have not gone through it",
          "[particles][physics]") {
  // Seen from it their ways are bent: those of fast ones over the whole step, and those that it takes
  // along after their last bounce.
  for (const char* scene : {
           R"({"dt": 0.1, "steps": 60, "outputs": {"audit": true}, "objects": [{"resolution": 60,
              "shape": {"torus": {"major": 0.8, "minor": 0.3, "n": 32}}, "motion": {"spin": [-0.32, -7.69, 6.13]}}],
              "rules": {"look_up": "trilinear", "impact": {"restitution": 0, "threshold": 0}},
              "emitters": [{"sphere": {"centre": [0, 0, 0], "radius": 3, "inner": 2.2}, "count": 1000,
                            "outward": -10000.0, "spread": 1, "seed": 49}]})",
           R"({"dt": 0.1, "steps": 60, "outputs": {"audit": true}, "objects": [{"resolution": 40,
              "shape": {"cylinder": {"radius": 0.7, "half_height": 0.5}}, "motion": {"spin": [-7.32, 7.19, -1.37]}}],
              "rules": {"look_up": "trilinear", "impact": {"restitution": 0, "threshold": 0},
                        "wind": {"velocity": [1, 0, 0], "rate": 0.5},
                        "surface_flow": {"alpha_in": 8.19, "alpha_out": 3, "distance": 0.08}},
              "emitters": [{"sphere": {"centre": [0, 0, 0], "radius": 3, "inner": 2.2}, "count": 500,
                            "outward": -100, "spread": 1, "seed": 215}]})"}) {
    const Ran ran = run_scene(scene_of(scene), "--pes=2");
    CHECK(ran.last().tunnelled == 0);
    CHECK(ran.last().inside == 0);
  }
}

TEST_CASE("a particle that bounces over a box in one step has not gone through it",
          "[particles][physics]") {
  // Up over the box, off the ceiling, and down behind: the straight way leads through the box.
  const Scene scene = scene_of(R"({"dt": 1, "steps": 1,
    "objects": [{"shape": {"box": {"half": [0.5, 1, 1]}}, "resolution": 60, "thickness": 0.5},
                {"shape": {"box": {"half": [3, 3, 0.5]}}, "resolution": 60, "thickness": 0.5,
                 "transform": {"position": [0, 0, 1.9]}}],
    "emitters": [{"lattice": {"low": [-2, -0.5, 0.4], "high": [-2, 0.5, 0.4], "n": [1, 21, 1]},
                  "velocity": [4, 0, 2]}],
    "rules": {"impact": {"restitution": 1}},
    "outputs": {"audit": true, "trajectories": 1, "traced": 100}})");
  const Ran ran = run_scene(scene, "--pes=1");
  for (const Sample& sample : ran.result.trajectories.back().samples)
    CHECK(norm(sample.position - tess::dn::Vec3{2, sample.position.y, 0.4}) < 1e-5);
  CHECK(ran.last().tunnelled == 0);
}

TEST_CASE("a particle at rest beside a spinning object has not gone through it",
          "[particles][physics]") {
  // Seen from the ball each flies a circle of three radians a step around it.
  const Scene scene = scene_of(R"({"dt": 0.01, "steps": 20,
    "objects": [{"shape": {"sphere": {"radius": 0.5, "rings": 16}}, "resolution": 24, "thickness": 0.5,
                 "motion": {"spin": [0, 0, 300]}}],
    "emitters": [{"count": 100, "box": {"low": [0.9, -1, -0.1], "high": [1.1, 1, 0.1]}}],
    "rules": {"impact": {"restitution": 0.5}}, "outputs": {"audit": true}})");
  CHECK(run_scene(scene, "--pes=1").last().tunnelled == 0);
}

TEST_CASE(
    "a corner into which gravity pulls gives no particle energy, and one that cannot bounce rests",
    "[particles][physics]") {
  // Voxels in the corner know one wall, by up to half a cell too late: lifting out is paid for.
  for (const std::string look_up : {"nearest", "tangent", "trilinear"})
    for (const std::string restitution : {"1", "0"}) {
      const Scene scene = scene_of(R"({"dt": 0.005, "steps": 3000,
        "objects": [{"shape": {"boxes": [{"low": [-1, -1, -0.5], "high": [1, 1, 0]},
                                         {"low": [0, -1, -0.2], "high": [1, 1, 1]}]},
                     "resolution": 60, "thickness": 0.3}],
        "emitters": [{"lattice": {"low": [-0.05, -0.8, 0.05], "high": [-0.05, 0.8, 0.05], "n": [1, 41, 1]}}],
        "rules": {"gravity": [6.9, 0, -6.9], "look_up": ")" +
                                   look_up + R"(", "impact": {"restitution": )" + restitution +
                                   R"(}}, "outputs": {"statistics": 100, "audit": true}})");
      const Ran ran = run_scene(scene, "--pes=1");
      const double start = ran.result.rows.front().measured.energy();
      double most = start;
      for (const Row& row : ran.result.rows) kit::worsen(most, row.measured.energy());
      INFO(look_up << ", restitution " << restitution << ": energy " << start << ", at most "
                   << most);
      CHECK(most <= start * (1 + 1e-9));
      CHECK(ran.last().tunnelled == 0);
      if (restitution == "0") CHECK(ran.last().kinetic.total() < 1e-3);
    }
}

TEST_CASE("what slides on the ground does not slide into the house that stands on it",
          "[particles][physics]") {
  // The house reaches into the ground: taken as two boxes, the ground went on inside.
  const Scene scene = scene_of(R"({"dt": 0.01, "steps": 400,
    "objects": [{"shape": {"boxes": [{"low": [-5, -5, -1], "high": [5, 5, 0]}, {"low": [2, -2, -0.5], "high": [4, 2, 3]}]},
                 "resolution": 60, "thickness": 1}],
    "emitters": [{"count": 200, "box": {"low": [-1, -1.5, 0.04], "high": [1, 1.5, 0.3]}, "velocity": [1.5, 0, 0], "spread": 0.2}],
    "rules": {"gravity": [0, 0, -9.81], "impact": {"restitution": 0.4, "threshold": 0.05}},
    "outputs": {"trajectories": 400}})");
  const double cell = 12.0 / 59;
  const Ran ran = run_scene(scene, "--pes=1");
  double deepest = 0;
  for (const Sample& sample : ran.result.trajectories.back().samples) {
    const Vec3 p = sample.position;
    const double below = -p.z, in_house = std::min({p.x - 2, 4 - p.x, 2 - std::abs(p.y), 3 - p.z});
    kit::worsen(deepest, std::max(below, in_house));
    kit::worsen(deepest, 0 * (p.x + p.y + p.z));
  }
  CHECK(deepest < 0.5 * cell);  // of the corner between them a voxel sees one face
  CHECK(ran.last().tunnelled == 0);
}

TEST_CASE("a positive coefficient of the flow turns toward the tangent, a negative one away",
          "[particles][physics]") {
  struct Regime {
    const char* file;
    double in, out;
  };
  const auto regime = GENERATE(Regime{"shaft_in12_out3", 1, 1}, Regime{"shaft_in3_out6", 1, 1},
                               Regime{"shaft_in3_out_minus3", 1, -1});
  Scene scene = read_scene(fmt::format("{}/{}.json", TESS_PARTICLE_SCENES, regime.file));
  scene.rules.impact.reset();
  scene.outputs.trajectories = 1;
  const double radius = 0.5, reach = scene.rules.surface_flow->distance;
  const Ran ran = run_scene(std::move(scene), "--pes=1");
  const auto& path = ran.result.trajectories;
  std::size_t n_in = 0, n_out = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    for (std::size_t p = 0; p < path[i].samples.size(); ++p) {
      const Sample &from = path[i - 1].samples[p], &to = path[i].samples[p];
      CHECK(norm(to.velocity) == Approx(2).epsilon(1e-12));  // the flow keeps the speed
      const Vec3 at{from.position.x, from.position.y, 0};
      const double distance = norm(at) - radius;
      // Off the rim of the reach and off the surface, where a voxel decides which particle is
      // within.
      if (distance < 0.1 || distance > reach - 0.1) continue;
      const Vec3 normal = direction(at);
      const double along = dot(normal, from.velocity) / 2;
      const double turned = dot(normal, to.velocity - from.velocity);
      if (std::abs(along) < 0.2 || std::abs(along) > 0.98) continue;  // at the tangent, head on
      ++(along < 0 ? n_in : n_out);
      CHECK((along < 0 ? turned * regime.in : -turned * regime.out) > 0);
    }
  CHECK(n_in > 100);
  CHECK(n_out > 100);
}

TEST_CASE("the shaft's three pairs of coefficients give three regimes", "[particles][physics]") {
  const auto run = [](const char* file) {
    Scene scene = read_scene(fmt::format("{}/{}.json", TESS_PARTICLE_SCENES, file));
    scene.outputs.trajectories = 1;
    return run_scene(std::move(scene), "--pes=1");
  };
  /// How many come closer than 0.1, and how many are still held (closer than 0.45) at the end.
  const auto close_and_held = [](const Ran& ran) {
    std::vector<double> nearest(41, HUGE_VAL), last(41);
    for (const Snapshot& snapshot : ran.result.trajectories)
      for (const Sample& sample : snapshot.samples) {
        last[sample.id] = std::hypot(sample.position.x, sample.position.y) - 0.5;
        nearest[sample.id] = std::min(nearest[sample.id], last[sample.id]);
      }
    const auto below = [](const std::vector<double>& of, double limit) {
      return std::count_if(of.begin(), of.end(), [limit](double d) { return d < limit; });
    };
    return std::pair(below(nearest, 0.1), below(last, 0.45));
  };
  const auto [close_kept_off, held_kept_off] = close_and_held(run("shaft_in12_out3"));
  const auto [close_wrapped, held_wrapped] = close_and_held(run("shaft_in3_out6"));
  const auto [close_thrown, held_thrown] = close_and_held(run("shaft_in3_out_minus3"));
  // (12, 3): turned away in time: hardly any comes close, none stays.
  CHECK(close_kept_off <= 1);
  CHECK(held_kept_off == 0);
  // (3, 6): more come close, and are led around the back and held.
  CHECK(close_wrapped >= 5);
  CHECK(held_wrapped >= 15);
  // (3, −3): as many come close, for on the way in it is the same; then they are thrown off.
  CHECK(close_thrown >= 5);
  CHECK(held_thrown == 0);
}
