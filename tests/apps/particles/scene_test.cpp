#include "apps/particles/scene/scene.hpp"

#include "apps/particles/simulation/emit.hpp"
#include "apps/particles/simulation/simulate.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/field_file.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <fstream>
#include <string>

using namespace particles;

namespace {

/// With " for each '.
std::string quoted(std::string text) {
  std::ranges::replace(text, '\'', '"');
  return text;
}

/// A small scene in which one piece of text is replaced.
std::string scene_with(const std::string& what, const std::string& by) {
  std::string scene = R"({"dt": 0.01, "steps": 10,
    "objects": [{"shape": {"box": {"half": [1, 1, 1]}}},
                {"shape": {"sphere": {"radius": 1}}, "resolution": 20, "thickness": 0.5}],
    "emitters": [{"count": 5, "box": {"low": [2, 2, 2], "high": [3, 3, 3]}}],
    "rules": {"gravity": [0, 0, -9.81], "impact": {"restitution": 0.7}}})";
  const auto at = scene.find(what);
  REQUIRE(at != std::string::npos);
  return scene.replace(at, what.size(), by);
}

/// The message of the Error of `action`; `fine` if it throws none.
template <class Action>
std::string told_by(const Action& action, const std::string& fine = "accepted") {
  const std::string message = tess::test::message_of(action);
  return message.empty() ? fine : message;
}
std::string refusal(const std::string& text) {
  return told_by([&] { (void)parse_scene(text, "scene.json"); });
}

}  // namespace

TEST_CASE("a bad scene is refused in one line that names the key, the value and what is allowed",
          "[particles][scene]") {
  const auto [what, by, message] = GENERATE(table<std::string, std::string, std::string>({
      {"'resolution': 20", "'resolution': 0", "objects[1].resolution: 0 is not within 4 … 1024"},
      {"'resolution': 20", "'resolution': 2.5", "objects[1].resolution: 2.5 is not a whole number"},
      {"'resolution': 20", "'resolutoin': 20",
       "objects[1].resolutoin: unknown key; allowed here: shape"},
      {"'thickness': 0.5", "'blur': {'radius': 2, 'rounds': 3}",
       "objects[1].blur: {'radius':2,'rounds':3} stands beside the exact method"},
      {"'thickness': 0.5", "'method': 'potential', 'blur': {'radius': 5, 'rounds': 3}",
       "objects[1].blur.radius: 5 is not within 2 … 4"},
      {"'thickness': 0.5", "'field': 'none.dnf'",
       "objects[1].resolution: 20 stands beside a field from a file"},
      {"'resolution': 20, 'thickness': 0.5", "'field': 'none.dnf'",
       "objects[1].field: none.dnf: cannot be opened; give the path of a field file"},
      {"'thickness': 0.5", "'thickness': 0", "objects[1].thickness: 0 is not above 0"},
      {"'thickness': 0.5", "'thickness': 0.1",
       "objects[1].thickness: 0.1 is thinner than two cells"},
      {"'thickness': 0.5", "'method': 'magic'", "'magic' is not one of exact"},
      {"'thickness': 0.5", "'transform': {'scale': 0}",
       "objects[1].transform.scale: 0 is not above 0"},
      {"'thickness': 0.5", "'transform': {'matrix': [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]}",
       "objects[1].transform.matrix: [[1,0.5,0],[0,1,0],[0,0,1]] cannot be used: transform"},
      {"'thickness': 0.5", "'transform': {'matrix': [[1, 0, 0], [0, 1, 0], [0, 0, -1]]}",
       "mirrors the object"},
      {"'thickness': 0.5", "'motion': {'scale': -20}",
       "objects[1].motion.scale: -20 a second takes the scale from 1 to -1 in 10 steps of 0.01; it "
       "must stay above 0"},
      {"'thickness': 0.5", "'motion': {'grow': 1}",
       "objects[1].motion.grow: unknown key; allowed here: velocity, spin, scale"},
      {"'thickness': 0.5", "'thickness': 0.5, 'thickness': 1", "key 'thickness' stands twice"},
      {"'thickness': 0.5", "'choose': {'max_speed': 1, 'detail': 1}", "stands beside resolution"},
      {"{'box': {'half': [1, 1, 1]}}", "{'box': {'half': [1, 1]}}",
       "objects[0].shape.box.half: [1,1] is not a list of three numbers"},
      {"{'box': {'half': [1, 1, 1]}}", "{}", "needs exactly one of sphere, box"},
      {"{'box': {'half': [1, 1, 1]}}", "{'file': 'none.obj'}",
       "scene.json: objects[0].shape.file: none.obj: cannot be opened"},
      {"{'box': {'half': [1, 1, 1]}}", "{'file': '/dev/zero'}",
       "/dev/zero: is no surface by its name; give a file .obj, .ply or .stl"},
      {"{'box': {'half': [1, 1, 1]}}", "{'file': '.'}",
       "scene.json: objects[0].shape.file: .: is a directory; give the path of a file .obj, .ply "
       "or .stl"},
      {"'count': 5, ", "", "emitters[0].count: is missing; give how many particles"},
      {"'count': 5", "'count': -1", "emitters[0].count: -1 is not within 1 … 1000000000"},
      {"'count': 5", "'count': 5, 'mass': 0", "emitters[0].mass: 0 is not above 0"},
      {"'count': 5", "'count': 5, 'seed': -1",
       "emitters[0].seed: -1 is not within 0 … 9007199254740992"},
      {"'count': 5", "'count': 5, 'outward': 1",
       "emitters[0].outward: 1 has no direction in a box"},
      {"'restitution': 0.7", "'restitution': 1.5",
       "rules.impact.restitution: 1.5 is not within 0 … 1"},
      {"'restitution': 0.7", "'restitution': 1, 'threshold': 0.6",
       "objects[0].thickness: 0.5 times scale 1 is below the distance 0.6"},
      {"'restitution': 0.7}",
       "'restitution': 1}, 'spring': {'stiffness': 1, 'reach': 0.1, 'damping': 5}",
       "rules.spring.damping is 5"},
      {"'restitution': 0.7}", "'restitution': 1, 'sweep': false}, 'wind': {'velocity': [0, 0, 1]}",
       "rules.wind.rate: is missing"},
      {"'high': [3, 3, 3]}", "'high': [3, 3, 3]}, 'velocity': [0, 'fast', 0]",
       "emitters[0].velocity[1]: 'fast' is not a number"},
      {"'dt': 0.01", "'dt': 1e999", "is not JSON"},
      {"'dt': 0.01", "'dt': 1e101", "scene.json: dt: 1e+101 is beyond ±1e+100, the largest"},
      {"'dt': 0.01", "'dt': 1e-101", "scene.json: dt: 1e-101 is below 1e-100, the least"},
      {"'low': [2, 2, 2]", "'low': [-1e308, 2, 2]",
       "scene.json: emitters[0].box.low[0]: -1e+308 is beyond ±1e+100"},
      {"[0, 0, -9.81]", "[0, 0, -1e300]", "rules.gravity[2]: -1e+300 is beyond ±1e+100"},
      {"'restitution': 0.7}",
       "'restitution': 1}, 'wind': {'velocity': [1e200, 0, 0], 'rate': 1e200}",
       "rules.wind.velocity[0]: 1e+200 is beyond"},
      {"'thickness': 0.5", "'transform': {'matrix': [[1e200, 0, 0], [0, 1e200, 0], [0, 0, 1e200]]}",
       "objects[1].transform.matrix[0][0]: 1e+200 is beyond"},
      {"'thickness': 0.5", "'transform': {'scale': 1e100}",
       "objects[1]: a cell in the world, at its smallest is 1.57895e+99, not within 1e-15 … 1e+15"},
      {"'thickness': 0.5",
       "'motion': {'velocity': [0, 1e100, 0]}, 'transform': {'position': [9.9e99, 0, 0]}",
       "objects[1]: a cell of its field is 0.157895 wide in the world, and positions 1.09e+100 "
       "from the origin, where it gets, are"},
      {"'dt': 0.01, ", "", "dt: is missing; give the time step"},
      {"'steps': 10", "'steps': -1", "steps: -1 is not within 0 … 1000000000"},
      {"'dt': 0.01, ", "'dt': 0.01 ", "is not JSON: parse error at line 1"},
  }));
  const std::string told = refusal(scene_with(quoted(what), quoted(by)));
  INFO(told);
  CHECK_THAT(told, Contains(quoted(message)));
  CHECK(told.find("scene.json: ") == 0);
  CHECK(told.find('\n') == std::string::npos);
}

TEST_CASE("JSON that is nested deeper than any scene is refused, however deep",
          "[particles][scene]") {
  const auto depth = GENERATE(std::size_t{40}, std::size_t{100'000});
  for (const auto& [open, close] : {std::pair("[", "]"), std::pair("{\"a\":", "}")}) {
    std::string text = "{\"dt\":";
    for (std::size_t i = 0; i < depth; ++i) text += open;
    text += "1";
    CHECK(refusal(text).find("scene.json: is nested deeper than 32 lists and objects") == 0);
    for (std::size_t i = 0; i < depth; ++i) text += close;
    CHECK(refusal(text + "}").find("scene.json: is nested deeper than 32 lists and objects") == 0);
  }
  CHECK(refusal("{\"dt\":" + std::string(31, '[') + std::string(31, ']') + "}") ==
        "scene.json: dt: " + std::string(31, '[') + std::string(29, ']') + " … is not a number");
}

TEST_CASE("keys and values are shown in one line, and cut between characters",
          "[particles][scene]") {
  CHECK(refusal("{\"dt\": 1, \"a\\nb\": 1}").find("scene.json: a\\nb: unknown key") == 0);
  CHECK(refusal("{\"dt\": 1, \"\\u001b[1m\": 1}").find("scene.json: \\x1b[1m: unknown key") == 0);
  CHECK(refusal("{\"dt\": \"a\\nb\"}") == "scene.json: dt: \"a\\nb\" is not a number");
  for (const std::size_t start : {0U, 1U, 2U}) {
    std::string text = std::string(start, 'x'), want = text;
    for (int i = 0; i < 100; ++i) text += "€";  // three bytes
    for (std::size_t i = 0; i < (59 - start) / 3; ++i) want += "€";
    CHECK(refusal("{\"dt\": \"" + text + "\"}") ==
          "scene.json: dt: \"" + want + " … is not a number");
  }
  const std::string long_key(1'000'000, 'k');
  CHECK(refusal("{\"" + long_key + "\": 1}").size() < 300);
  CHECK(refusal("{\"" + long_key).size() < 400);
}

TEST_CASE("errors of an OBJ file name the scene, the key and the file", "[particles][scene]") {
  const tess::test::Scratch scratch;
  const std::string start = "v 0 0 0\nv 1 0 0\n", path = scratch.path("mesh.obj");
  const auto [third, message] = GENERATE(table<std::string, std::string>({
      {"v nan 1 0\nf 1 2 3\n", "vertex 2 of triangle 0 is (nan, 1, 0), which is not finite"},
      {"v 0 1e400 0\nf 1 2 3\n", "vertex 2 of triangle 0 is (0, inf, 0), which is not finite"},
      {"v 0 1 0\nf 1 1 1\n", "surface has extent 0"},
      {"v 1 1 1\nv 2 2 2\nf 1 3 4\n", "all 1 triangles are without area"},
      {"v -1e308 1e308 0\nv 1e308 0 0\nf 1 4 3\n", "surface has extent inf"},
      {"v 0 1 0\nf 1 2 9\n", "names vertex 9"},
      {"", "holds no faces"},
  }));
  (void)scratch.write("mesh.obj", start + third);
  const std::string scene = scratch.write(
      "scene.json", scene_with("{\"box\": {\"half\": [1, 1, 1]}}", "{\"file\": \"mesh.obj\"}"));
  const std::string told = told_by([&] { (void)read_scene(scene); });
  INFO(told);
  CHECK(told.find(scene + ": objects[0].shape.file: " + path + ":") == 0);
  CHECK_THAT(told, Contains(message));
}

TEST_CASE("a directory is named as one", "[particles][scene]") {
  CHECK_THROWS_WITH(read_scene("."), ".: is a directory; give the path of a JSON file");
}

TEST_CASE("without swept look-up a step that passes the field is refused", "[particles][scene]") {
  const std::string fast = "\"count\": 5, \"velocity\": [0, 0, -100]";
  std::string text = scene_with("\"count\": 5", fast);
  CHECK(refusal(text) == "accepted");
  const std::string swept = "\"restitution\": 0.7";
  text.replace(text.find(swept), swept.size(), swept + ", \"sweep\": false");
  CHECK_THAT(refusal(text),
             Contains("emitters[0]: speed 100 times dt 0.01 passes the field of objects[0]"));
}

TEST_CASE("without swept look-up the speed of a surface counts from the origin that it turns about",
          "[particles][scene]") {
  const auto refused = [](const std::string& object) {
    return refusal(R"({"dt": 0.01, "steps": 50, "objects": [{"resolution": 20, )" + object +
                   R"(}], "emitters": [{"count": 1, "sphere": {"radius": 2}}],
                   "rules": {"impact": {"restitution": 1, "sweep": false}}})");
  };
  const std::string box = R"("thickness": 0.5, "shape": {"boxes": [{"low": [)",
                    ball = R"("thickness": 0.3, "shape": {"sphere": {"radius": 1}}, "motion": )";
  // 0.03 radians in a step, at a distance of 1.7 and of 102.
  CHECK(refused(box + R"(-1, -1, -1], "high": [1, 1, 1]}]}, "motion": {"spin": [0, 0, 3]})") ==
        "accepted");
  CHECK_THAT(
      refused(box + R"(100, -1, -1], "high": [102, 1, 1]}]}, "motion": {"spin": [0, 0, 3]})"),
      Contains("passes the field of objects[0]"));
  CHECK(refused(ball + R"({"spin": [0, 0, 10]})") == "accepted");
  // It has three times its size at the end.
  CHECK_THAT(refused(ball + R"({"spin": [0, 0, 10], "scale": 4})"),
             Contains("passes the field of objects[0]"));
}

TEST_CASE("a picture outside of the field is refused", "[particles][scene]") {
  const std::string end = "\"restitution\": 0.7}}";
  const auto cut_at = [&](const std::string& at) {
    return refusal(scene_with(
        end,
        end + ", \"outputs\": {\"axis\": \"x\", \"slice\": {\"object\": 1, \"at\": " + at + "}}"));
  };
  CHECK(cut_at("1.4") == "accepted");
  CHECK_THAT(cut_at("1.6"),
             Contains("outputs.slice: {\"at\":1.6,\"object\":1} cuts at 1.6, which is not "
                      "within the field: -1.5 … 1.5"));
}

TEST_CASE("a chosen field covers the step and resolves the detail, or is refused",
          "[particles][scene]") {
  const auto scene = [](const std::string& speed) {
    return R"({"dt": 0.01, "steps": 1,
      "objects": [{"shape": {"sphere": {"radius": 1}}, "choose": {"max_speed": )" +
           speed + R"(, "detail": 0.2}}],
      "emitters": [{"count": 1, "sphere": {"radius": 1}}], "rules": {"impact": {"restitution": 1}}})";
  };
  const SceneObject object = parse_scene(scene("20"), "scene.json").objects[0];
  CHECK(object.thickness == Approx(0.4));  // a step of 0.2, and two cells of 0.1
  CHECK(object.grid.cell <= 0.1 * (1 + 1e-12));
  CHECK(object.grid.cell > 0.09);
  CHECK_THAT(refusal(scene("1e6")),
             Contains("objects[0].choose: {\"detail\":0.2,\"max_speed\":1000000.0} takes a "
                      "resolution of "));
}

TEST_CASE("bodies too thin for their field are refused where impacts or springs act",
          "[particles][scene]") {
  const auto told = [](const std::string& shape, const std::string& more,
                       const std::string& rules) {
    return refusal(R"({"dt": 0.01, "steps": 1, "objects": [{"shape": )" + shape +
                   R"(, "resolution": 30, "thickness": 0.4)" + more +
                   R"(}], "emitters": [{"count": 1, "sphere": {"radius": 1}}], "rules": {)" +
                   rules + "}}");
  };
  const std::string plate = R"({"plate": {"half": 1}})",
                    thin = R"({"box": {"half": [1, 1, 0.02]}})",
                    bounce = R"("impact": {"restitution": 1})";
  CHECK(
      told(plate, "", bounce) ==
      "scene.json: objects[0].shape: 100 % of its surface is an open sheet, or a wall thinner than "
      "0.167232, which a field of 30 voxels needs; particles would pass it: take sides two, or a "
      "higher resolution");
  CHECK_THAT(told(thin, "", bounce), Contains("particles would pass it"));
  CHECK(told(thin, R"(, "sides": "two")", bounce) == "accepted");
  // A spring that yields by more than the box's thickness lets particles through.
  const std::string spring = R"("spring": {"stiffness": 30, "reach": 0.1})";
  CHECK_THAT(told(thin, "", spring), Contains("particles would pass it"));
  CHECK_THAT(told(plate, "", spring), Contains("is an open sheet"));
  CHECK(told(thin, R"(, "sides": "two")", spring) == "accepted");
  CHECK(told(thin, "", R"("surface_drag": {"rate": 1, "threshold": 0.1})") == "accepted");
  const std::string wall = R"({"box": {"half": [1, 1, 0.1]}})";
  CHECK(told(wall, "", bounce) == "accepted");
  CHECK(told(wall, "", spring) == "accepted");
  CHECK_THAT(told(wall, "", bounce + R"(, "look_up": "nearest")"),
             Contains("particles would pass it"));
}

TEST_CASE("units beyond the range of floats are refused", "[particles][scene]") {
  const auto scene = [](const std::string& size, const std::string& more, const std::string& dt) {
    return R"({"dt": )" + dt + R"(, "steps": 1, "objects": [{"shape": {"sphere": {"radius": )" +
           size + "}}" + more + R"(}], "emitters": [{"count": 1, "sphere": {"radius": 1}}],
           "rules": {"impact": {"restitution": 1}}})";
  };
  for (const std::string fine : {"1e-12", "1", "1e12"})
    CHECK(refusal(scene(fine, "", "0.01")) == "accepted");
  CHECK_THAT(refusal(scene("1e30", "", "1")), Contains("objects[0]: a cell of its field is "));
  CHECK_THAT(refusal(scene("1", R"(, "transform": {"scale": 1e-20})", "1")),
             Contains("in the world, at its"));
  CHECK_THAT(refusal(scene("1", "", "1e30")), Contains("a cell a step, as a speed,"));
  const std::string far = R"(, "transform": {"position": [1e9, 0, 0]})";
  CHECK(refusal(scene("1e-3", far, "1")) == "accepted");
  CHECK_THAT(refusal(scene("1e-6", far, "1")), Contains("from the origin, where it gets, are"));
}

TEST_CASE("a whole number may be written as 1e3", "[particles][scene]") {
  CHECK(parse_scene(scene_with("\"count\": 5", "\"count\": 1e3"), "s").n_particles() == 1000);
  CHECK_THAT(refusal(scene_with("\"count\": 5", "\"count\": 1.5")),
             Contains("is not a whole number"));
  CHECK_THAT(refusal(scene_with("\"count\": 5", "\"count\": 1e30")),
             Contains("is not within 1 … 1000000000"));
}

TEST_CASE("a field from a file is that of its shape", "[particles][scene]") {
  const tess::test::Scratch scratch;
  const auto with_field = [&](const std::string& shape) {
    return "{\"dt\": 0.01, \"steps\": 1, \"objects\": [{\"shape\": " + shape +
           ", \"field\": \"a.dnf\"}], \"emitters\": [{\"count\": 1, \"sphere\": {\"radius\": 1}}]}";
  };
  const auto read = [&](const std::string& text) {
    std::string found;
    const std::string message = tess::test::message_of([&] {
      const SceneObject object = parse_scene(text, scratch.path("scene.json")).objects.front();
      found = tess::text(object.grid.n[0], " ", object.thickness, " ",
                         object.sides == tess::dn::Sides::two);
    });
    return found + message;
  };
  const std::string box = R"({"box": {"half": [1, 1, 1]}})",
                    other = R"({"box": {"half": [1, 1, 1.2]}})";
  const tess::dn::Surface surface = tess::dn::make_box({1, 1, 1});
  tess::dn::save_field(build_field(surface, grid_around(bounds(surface), 16, 0.5),
                                   {tess::dn::Sides::two, tess::dn::Content::distance, 0.4, {}}),
                       scratch.path("a.dnf"));
  CHECK(read(with_field(box)) == "16 0.4 1");
  CHECK_THAT(read(with_field(other)), Contains("objects[0].field: " + scratch.path("a.dnf") +
                                               ": is the field of another shape"));
  std::ofstream(scratch.path("a.dnf"), std::ios::app) << "x";
  CHECK_THAT(read(with_field(box)), Contains("a.dnf: longer than it says"));
}

TEST_CASE("fields and particles that no memory can hold are refused", "[particles][scene]") {
  const auto refused = [](const Scene& scene, int n_processes) {
    return told_by([&] { check_memory(scene, n_processes); }, "fits");
  };
  Scene scene = parse_scene(scene_with("\"steps\": 10", "\"steps\": 1000000000"), "scene.json");
  CHECK(refused(scene, 1) == "fits");
  const auto n =
      static_cast<std::uint64_t>(tess::detail::usable_memory() / 50);  // a particle takes more
  scene.emitters[0].count = n;
  CHECK(refused(scene, 1).find("scene.json: the fields and " + std::to_string(n) +
                               " particles make the run ") == 0);
  CHECK(refused(scene, 4) == "fits");
  scene.emitters[0].count = 1000;
  Scene fields = scene;
  fields.objects[0].grid.n = {1024, 1024, 1024};
  fields.objects.assign(1000, fields.objects[0]);  // 8.6 TB
  CHECK_THAT(refused(fields, 1), Contains("a lower resolution"));
  fields.rules = {};  // no rule needs a field
  CHECK(refused(fields, 1) == "fits");
}

TEST_CASE("a scene is what its file says", "[particles][scene]") {
  const Scene scene =
      parse_scene(scene_with("\"count\": 5", "\"count\": 5, \"mass\": 2"), "a/b.json");
  CHECK(scene.dt == 0.01);
  CHECK(scene.steps == 10);
  REQUIRE(scene.objects.size() == 2);
  CHECK(scene.objects[0].surface.triangles.size() == 12);
  CHECK(scene.objects[0].grid.n[0] == 60);
  CHECK(scene.objects[0].thickness == 0.5);
  CHECK(scene.objects[1].grid.n[0] == 20);
  CHECK(scene.n_particles() == 5);
  CHECK(masses_of(scene) == std::vector<double>{2});
  REQUIRE(scene.rules.impact);
  CHECK(scene.rules.impact->restitution == 0.7);
  REQUIRE(scene.rules.gravity);
  CHECK(scene.rules.gravity->acceleration == tess::dn::Vec3{0, 0, -9.81});
  CHECK_FALSE(scene.rules.spring);
}

TEST_CASE("forces act by mass, gravity does not", "[particles][scene]") {
  tess::dn::Rules rules;
  rules.gravity = tess::dn::Gravity{{0, 0, -2}};
  rules.spring = tess::dn::Spring{8, 2, 1};
  rules.air_drag = tess::dn::AirDrag{6, tess::dn::DragLaw::linear};
  rules.wind = tess::dn::Wind{{4, 0, 0}, 12};
  rules.surface_drag = tess::dn::SurfaceDrag{10, 1};
  rules.surface_flow = tess::dn::SurfaceFlow{14, 16, 1};
  rules.explosions = {tess::dn::Explosion{{2, 0, 0}, 18, 4, 1, 1}};
  const tess::dn::Rules heavy = for_mass(rules, 2);
  CHECK(heavy.gravity->acceleration.z == -2);
  CHECK(heavy.spring->stiffness == 4);
  CHECK(heavy.spring->damping == 1);
  CHECK(heavy.spring->reach == 1);
  CHECK(heavy.air_drag->rate == 3);
  CHECK(heavy.wind->rate == 6);
  CHECK(heavy.wind->velocity.x == 4);
  CHECK(heavy.surface_drag->rate == 5);
  CHECK(heavy.surface_drag->threshold == 1);
  CHECK(heavy.surface_flow->alpha_in == 7);
  CHECK(heavy.surface_flow->alpha_out == 8);
  CHECK(heavy.surface_flow->distance == 1);
  CHECK(heavy.explosions[0].strength == 9);
  CHECK(heavy.explosions[0].radius == 4);
  rules.air_drag->law = tess::dn::DragLaw::quadratic;
  CHECK(for_mass(rules, 2).air_drag->rate == 3);
  CHECK_THAT(scene_help(),
             Contains("Stiffness, damping, rates, alphas and strength are of forces: they are "
                      "divided by"));
}

TEST_CASE("emitted particles lie where their emitter says", "[particles][scene]") {
  const Scene scene = parse_scene(R"({"dt": 1, "steps": 0,
    "objects": [{"shape": {"box": {"half": [1, 1, 1]}}, "transform": {"position": [0, 0, 5], "scale": 2}}],
    "emitters": [{"count": 300, "box": {"low": [1, 2, 3], "high": [2, 2, 5]}, "velocity": [1, 0, 0], "spread": 0.5},
                 {"count": 300, "sphere": {"centre": [9, 0, 0], "radius": 2, "inner": 1}, "outward": 3},
                 {"lattice": {"low": [0, 0, 0], "high": [1, 1, 0], "n": [3, 2, 1]}},
                 {"count": 300, "surface": {"low": 0.25, "high": 0.5}, "mass": 3}]})",
                                  "scene.json");
  const Source source(scene);
  REQUIRE(source.size() == 906);
  const tess::dn::Bounds all = source.bounds();
  double sum = 0;
  for (std::uint64_t id = 0; id < 300; ++id) {
    const Start a = source.particle(id), b = source.particle(300 + id),
                c = source.particle(606 + id);
    CHECK(all.distance2(a.position) == 0);
    CHECK((a.position.x >= 1 && a.position.x < 2 && a.position.y == 2));
    CHECK((std::abs(a.velocity.x - 1) <= 0.5 && std::abs(a.velocity.y) <= 0.5));
    sum += a.position.z;
    const tess::dn::Vec3 out = b.position - tess::dn::Vec3{9, 0, 0};
    CHECK((norm(out) >= 1 - 1e-12 && norm(out) <= 2 + 1e-12));
    CHECK(norm(b.velocity - 3 * direction(out)) < 1e-12);
    const tess::dn::Vec3 from = c.position - tess::dn::Vec3{0, 0, 5};
    const double beyond = std::max({std::abs(from.x), std::abs(from.y), std::abs(from.z)}) - 2;
    CHECK((beyond >= 0.25 - 1e-12 && beyond <= 0.5 + 1e-12));
    CHECK(c.mass == 3);
  }
  CHECK(sum / 300 == Approx(4).margin(0.15));
  CHECK(source.particle(605).position == tess::dn::Vec3{1, 1, 0});
  CHECK(source.particle(601).position == tess::dn::Vec3{0.5, 0, 0});
}
