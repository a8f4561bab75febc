#include "apps/particles/scene/readers.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace particles {
namespace {
using namespace tess::dn;

constexpr std::int64_t most_particles = 1'000'000'000, most_steps = 1'000'000'000;
constexpr const char* needs_object = "needs an object, and the scene has none";

Explosion read_explosion(const Node& node) {
  Explosion explosion;
  node.read({{"centre", explosion.centre, any_number, "a point [x, y, z]"},
             {"strength", explosion.strength, any_number, "the force at the centre"},
             {"radius", explosion.radius, positive, "how far it reaches"},
             {"duration", explosion.duration, not_negative, "how long it lasts"},
             {"start", explosion.start}});
  return explosion;
}

Rules read_rules(const Node& node) {
  Rules rules;
  const auto spring = [&](const Node& of) {
    Spring& to = rules.spring.emplace();
    of.read({{"stiffness", to.stiffness, positive, "force per depth"},
             {"reach", to.reach, positive, "the distance at which the spring is slack"},
             {"damping", to.damping, not_negative}});
  };
  const auto impact = [&](const Node& of) {
    Impact& to = rules.impact.emplace();
    of.read({{"restitution", to.restitution, {0, 1}, "0 (slides) … 1 (no loss)"},
             {"threshold", to.threshold, not_negative},
             {"sweep", [&](const Node& n) { to.sweep = n.yes_or_no() ? Sweep::on : Sweep::off; }}});
  };
  const auto surface_drag = [&](const Node& of) {
    SurfaceDrag& to = rules.surface_drag.emplace();
    of.read({{"rate", to.rate, not_negative, "force per velocity"},
             {"threshold", to.threshold, positive, "the distance it reaches"}});
  };
  const auto surface_flow = [&](const Node& of) {
    SurfaceFlow& to = rules.surface_flow.emplace();
    of.read({{"alpha_in", to.alpha_in, any_number, "the coefficient toward the surface"},
             {"alpha_out", to.alpha_out, any_number, "the coefficient away from the surface"},
             {"distance", to.distance, positive, "the distance it reaches"}});
  };
  const auto wind = [&](const Node& of) {
    Wind& to = rules.wind.emplace();
    of.read({{"velocity", to.velocity, any_number, "that of the air"},
             {"rate", to.rate, not_negative, "force per velocity"}});
  };
  const auto air_drag = [&](const Node& of) {
    AirDrag& to = rules.air_drag.emplace();
    of.read({{"rate", to.rate, not_negative, "force per velocity"},
             {"law", to.law, {"linear", "quadratic"}}});
  };
  const auto explosions = [&](const Node& of) {
    for (const Node& item : of.items()) rules.explosions.push_back(read_explosion(item));
  };
  node.read({{"look_up", rules.look_up, words_of(look_up_names)},
             {"spring", spring},
             {"impact", impact},
             {"surface_drag", surface_drag},
             {"surface_flow", surface_flow},
             {"gravity", [&](const Node& of) { rules.gravity = Gravity{of.vector()}; }},
             {"wind", wind},
             {"air_drag", air_drag},
             {"explosions", explosions}});
  return rules;
}

Emitter read_emitter(const Node& node, std::size_t n_objects) {
  Emitter out;
  const auto corners = [&](const Node& of, std::initializer_list<Key> table) {
    of.read(table);
    const Vec3 size = out.high - out.low;
    if (!(size.x >= 0 && size.y >= 0 && size.z >= 0)) of["high"].refuse("is below low");
  };
  const Key low{"low", out.low, any_number, "a corner [x, y, z]"},
      high{"high", out.high, any_number, "the other corner [x, y, z]"};
  const auto box = [&](const Node& of) {
    out.where = Emitter::Where::box;
    corners(of, {low, high});
  };
  const auto points = [&](const Node& of) {
    const std::vector<Node> n = of.items();
    if (n.size() != 3) of.refuse("is not a list of three numbers");
    double product = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.lattice[axis] = static_cast<std::uint64_t>(n[axis].whole(1, 1'000'000));
      product *= static_cast<double>(out.lattice[axis]);
    }
    if (product > static_cast<double>(most_particles))
      of.refuse(fmt::format("makes more than {} particles", most_particles));
    out.count = static_cast<std::uint64_t>(product);
  };
  const auto lattice = [&](const Node& of) {
    if (node.has("count")) node["count"].refuse("stands beside a lattice, which has its own n");
    out.where = Emitter::Where::lattice;
    corners(of, {low, high, {"n", points, "points along each axis [nx, ny, nz]"}});
  };
  const auto sphere = [&](const Node& of) {
    out.where = Emitter::Where::sphere;
    of.read({{"centre", out.centre},
             {"radius", out.outer, not_negative, "the radius"},
             {"inner", [&](const Node& n) {
                out.inner = n.number({0, out.outer});
              }}});
  };
  const auto surface = [&](const Node& of) {
    out.where = Emitter::Where::surface;
    if (n_objects == 0) of.refuse(needs_object);
    of.read({{"object", out.object, 0, static_cast<std::int64_t>(n_objects) - 1},
             {"high", out.outer, not_negative, "the largest distance from the surface"},
             {"low", [&](const Node& n) {
                out.inner = n.number({-HUGE_VAL, out.outer});
              }}});
  };
  const std::string_view kind = node.one_of({"box", "sphere", "lattice", "surface"});
  const char* const needs_count = kind == "lattice" ? nullptr : "how many particles";
  node.read({{"box", box},
             {"sphere", sphere},
             {"lattice", lattice},
             {"surface", surface},
             {"count", out.count, 1, most_particles, needs_count},
             {"velocity", out.velocity},
             {"spread", out.spread, not_negative},
             {"outward", out.outward},
             {"mass", out.mass, positive},
             {"seed", out.seed, 0, largest_whole}});
  if (out.outward != 0 && kind != "sphere" && kind != "surface")
    node["outward"].refuse(fmt::format("has no direction in a {}; use velocity", kind));
  return out;
}

Outputs read_outputs(const Node& node, const std::vector<SceneObject>& objects) {
  Outputs out;
  const auto axis = [](const Node& of) { return static_cast<int>(of.word({"x", "y", "z"})); };
  const auto axes = [&](const Node& of) {  // "x", or a list as ["x", "z"]
    out.axes.clear();
    if (!of.is_list()) out.axes = {axis(of)};
    if (of.is_list())
      for (const Node& item : of.items(1)) {
        if (std::ranges::count(out.axes, axis(item)) > 0) item.refuse("stands twice in the list");
        out.axes.push_back(axis(item));
      }
  };
  const auto audit = [&](const Node& of) {
    out.audited = !of.is_yes_or_no() ? static_cast<std::uint64_t>(of.whole(0, most_particles))
                  : of.yes_or_no()   ? most_particles
                                     : 0;
  };
  const auto slice = [&](const Node& of) {
    if (objects.empty()) of.refuse(needs_object);
    auto& [object, at] = out.slice.emplace();
    of.read({{"object", object, 0, static_cast<std::int64_t>(objects.size()) - 1}, {"at", at}});
    const Grid& grid = objects[object].grid;
    const int along = out.axes.front();
    const double low = component(grid.origin, along),
                 high = low + grid.cell * (grid.n[static_cast<std::size_t>(along)] - 1);
    if (at < low || at > high)
      of.refuse(
          fmt::format("cuts at {:g}, which is not within the field: {:g} … {:g}", at, low, high));
  };
  node.read({{"statistics", out.statistics, 0, most_steps},
             {"trajectories", out.trajectories, 0, most_steps},
             {"traced", out.traced, 1, most_particles},
             {"axis", axes},
             {"slice", slice},
             {"fields", out.fields},
             {"audit", audit}});
  if (out.fields && objects.empty()) node["fields"].refuse(needs_object);
  return out;
}

Scene read(const nlohmann::json& file, const std::string& name) {
  Scene scene;
  scene.name = name;
  const std::string folder = std::filesystem::path(name).parent_path().string();
  const Node root(file, name);
  const auto compression = [&](const Node& of) {
    constexpr double most_cells = 0.5, most_degrees = 45;  // a rule would see another surface
    Compression& to = scene.compression.emplace();
    of.read({{"cells", to.cells, {0, most_cells}}, {"degrees", to.degrees, {0, most_degrees}}});
  };
  const auto objects = [&](const Node& of) {
    for (const Node& item : of.items())
      scene.objects.push_back(read_object(item, folder, scene.dt, scene.rules));
  };
  const auto emitters = [&](const Node& of) {
    for (const Node& item : of.items(1))
      scene.emitters.push_back(read_emitter(item, scene.objects.size()));
    if (scene.n_particles() > static_cast<std::uint64_t>(most_particles))
      of.refuse(fmt::format("makes more than {} particles", most_particles));
  };
  root.read(
      {{"dt", scene.dt, positive, "the time step"},
       {"steps", scene.steps, 0, most_steps, "how many steps"},
       {"block", scene.block, positive},
       {"exchange", scene.exchange, 1, most_steps},
       {"compression", compression},
       {"rules", [&](const Node& of) { scene.rules = read_rules(of); }},
       {"objects", objects},
       {"emitters", emitters, "a list of at least one emitter"},
       {"outputs", [&](const Node& of) { scene.outputs = read_outputs(of, scene.objects); }}});
  if (scene.compression) compress_fields(scene);
  check_scene(scene);
  return scene;
}

}  // namespace

Scene read_scene(const std::string& path) {
  return read(read_json(path), path);
}

Scene parse_scene(const std::string& text, const std::string& name) {
  return read(parse_json(text, name), name);
}

}  // namespace particles
