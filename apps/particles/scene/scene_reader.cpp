#include "apps/particles/scene/json_reader.hpp"
#include "apps/particles/scene/object_reader.hpp"
#include "apps/particles/scene/rules_reader.hpp"
#include "apps/particles/scene/scene.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace particles {
namespace {
using tess::dn::Vec3;

constexpr std::int64_t most_particles = 1'000'000'000, most_steps = 1'000'000'000;

void read_region(const Keys& keys, std::string_view kind, std::size_t n_objects, Emitter& emitter) {
  const Node node = keys[kind];
  if (kind == "box" || kind == "lattice") {
    const bool is_box = kind == "box";
    emitter.where = is_box ? Emitter::Where::box : Emitter::Where::lattice;
    const Keys of = is_box ? node.keys({"low", "high"}) : node.keys({"low", "high", "n"});
    emitter.low = of.need("low", "a corner [x, y, z]").vector();
    emitter.high = of.need("high", "the other corner [x, y, z]").vector();
    const Vec3 size = emitter.high - emitter.low;
    if (!(size.x >= 0 && size.y >= 0 && size.z >= 0)) of["high"].refuse("is below low");
    if (is_box) return;
    const std::vector<Node> n = of.need("n", "points along each axis [nx, ny, nz]").items();
    if (n.size() != 3) of["n"].refuse("is not a list of three numbers");
    for (std::size_t axis = 0; axis < 3; ++axis)
      emitter.lattice[axis] = static_cast<std::uint64_t>(n[axis].whole(1, 1'000'000));
    const double points = static_cast<double>(emitter.lattice[0]) *
                          static_cast<double>(emitter.lattice[1]) *
                          static_cast<double>(emitter.lattice[2]);
    if (points > static_cast<double>(most_particles))
      of["n"].refuse(tess::text("makes more than ", most_particles, " particles"));
    emitter.count = emitter.lattice[0] * emitter.lattice[1] * emitter.lattice[2];
    return;
  }
  if (kind == "sphere") {
    emitter.where = Emitter::Where::sphere;
    const Keys of = node.keys({"centre", "radius", "inner"});
    of.read("centre", emitter.centre);
    emitter.outer = of.need("radius", "the radius").number(not_negative);
    of.read("inner", emitter.inner, {0, emitter.outer});
    return;
  }
  emitter.where = Emitter::Where::surface;
  const Keys of = node.keys({"object", "low", "high"});
  if (n_objects == 0) node.refuse("needs an object, and the scene has none");
  int object = 0;
  of.read("object", object, 0, static_cast<int>(n_objects) - 1);
  emitter.object = static_cast<std::size_t>(object);
  emitter.outer = of.need("high", "the largest distance from the surface").number(not_negative);
  of.read("low", emitter.inner, {-HUGE_VAL, emitter.outer});
}

Emitter read_emitter(const Node& node, std::size_t n_objects) {
  const Keys keys = node.keys({"count", "box", "sphere", "lattice", "surface", "velocity", "spread",
                               "outward", "mass", "seed"});
  Emitter emitter;
  const std::string_view kind = keys.one_of({"box", "sphere", "lattice", "surface"});
  read_region(keys, kind, n_objects, emitter);
  if (kind == "lattice") {
    if (keys.has("count")) keys["count"].refuse("stands beside a lattice, which has its own n");
  } else {
    emitter.count = static_cast<std::uint64_t>(
        keys.need("count", "how many particles").whole(1, most_particles));
  }
  keys.read("velocity", emitter.velocity);
  keys.read("spread", emitter.spread, not_negative);
  keys.read("outward", emitter.outward);
  if (emitter.outward != 0 && kind != "sphere" && kind != "surface")
    keys["outward"].refuse("has no direction in a " + std::string(kind) + "; use velocity");
  keys.read("mass", emitter.mass, positive);
  if (keys.has("seed")) emitter.seed = keys["seed"].seed();
  return emitter;
}

/// "x", or a list as ["x", "z"].
std::vector<int> read_axes(const Node& node) {
  const auto axis = [](const Node& of) { return static_cast<int>(of.word({"x", "y", "z"})); };
  if (!node.is_list()) return {axis(node)};
  std::vector<int> axes;
  for (const Node& item : node.items(1)) {
    axes.push_back(axis(item));
    if (std::count(axes.begin(), axes.end(), axes.back()) > 1)
      item.refuse("stands twice in the list");
  }
  return axes;
}

std::uint64_t read_audit(const Node& node) {
  if (node.is_yes_or_no()) return node.yes_or_no() ? most_particles : 0;
  return static_cast<std::uint64_t>(node.whole(0, most_particles));
}

Outputs read_outputs(const Node& node, const std::vector<SceneObject>& objects) {
  constexpr int most = static_cast<int>(most_steps);
  const Keys keys =
      node.keys({"statistics", "trajectories", "traced", "axis", "slice", "fields", "audit"});
  Outputs outputs;
  keys.read("statistics", outputs.statistics, 0, most);
  keys.read("trajectories", outputs.trajectories, 0, most);
  if (keys.has("traced"))
    outputs.traced = static_cast<std::uint64_t>(keys["traced"].whole(1, most_particles));
  if (keys.has("axis")) outputs.axes = read_axes(keys["axis"]);
  keys.read("fields", outputs.fields);
  if (outputs.fields && objects.empty())
    keys["fields"].refuse("needs an object, and the scene has none");
  if (keys.has("audit")) outputs.audited = read_audit(keys["audit"]);
  if (keys.has("slice")) {
    if (objects.empty()) keys["slice"].refuse("needs an object, and the scene has none");
    const Keys slice = keys["slice"].keys({"object", "at"});
    int object = 0;
    slice.read("object", object, 0, static_cast<int>(objects.size()) - 1);
    outputs.slice = Outputs::Slice{static_cast<std::size_t>(object), 0};
    slice.read("at", outputs.slice->at);
    const SceneObject& of = objects[outputs.slice->object];
    const int axis = outputs.axes.front();
    const double low = component(of.grid.origin, axis),
                 high = low + of.grid.cell * (of.grid.n[static_cast<std::size_t>(axis)] - 1),
                 at = outputs.slice->at;
    if (at < low || at > high)
      keys["slice"].refuse(
          tess::text("cuts at ", at, ", which is not within the field: ", low, " … ", high));
  }
  return outputs;
}

Compression read_compression(const Node& node) {
  constexpr double most_cells = 0.5, most_degrees = 45;  // a rule would see another surface
  const Keys keys = node.keys({"cells", "degrees"});
  Compression compression;
  keys.read("cells", compression.cells, {0, most_cells});
  keys.read("degrees", compression.degrees, {0, most_degrees});
  return compression;
}

/// How far from the origin the object reaches in the whole run, at most.
double furthest(const Scene& scene, const SceneObject& object) {
  const tess::dn::Frame& frame = object.frame;
  const double time = scene.dt * scene.steps;
  const tess::dn::Bounds box = bounds(object.surface);
  const double radius = std::max(norm(box.low), norm(box.high)) + object.thickness;
  return norm(frame.position) + norm(frame.velocity) * time +
         greatest_scale(scene, object) * radius;
}

/// Fields and look-ups reckon in floats, and with squares: what they are given must be within
/// their reach, the way of a step too.
void check_units(const Scene& scene, const std::string& file) {
  constexpr double largest = 1e15, least = 1e-15;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const auto check = [&](double value, const char* what) {
      if (value >= least && value <= largest) return;
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "]: ", what, " is ", value,
                 ", not within ", least, " … ", largest,
                 ", in which fields can be reckoned; choose other units");
    };
    check(object.grid.cell, "a cell of its field");
    check(object.thickness, "its thickness");
    check(object.grid.cell * least_scale(scene, object), "a cell in the world, at its smallest");
    check(object.thickness * greatest_scale(scene, object), "its thickness in the world");
    check(object.grid.cell * object.frame.scale / scene.dt, "a cell a step, as a speed,");
  }
}

/// A cell must be wide against what tells positions apart where the object is: particles there
/// stand on a lattice of doubles.
void check_offset(const Scene& scene, const std::string& file) {
  constexpr double positions_a_cell = 16, unit = 2.2e-16;  // of a double, relative
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const double cell = object.grid.cell * least_scale(scene, object),
                 reach = furthest(scene, object);
    if (cell >= positions_a_cell * unit * reach) continue;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "]: a cell of its field is ",
               cell, " wide in the world, and positions ", reach,
               " from the origin, where it gets, are ", unit * reach,
               " apart; move the scene to the origin, or choose a coarser field");
  }
}

void check_magnitude(const Scene& scene, const std::string& file) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const double reach = furthest(scene, scene.objects[i]);
    if (reach <= largest_number) continue;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
               "]: by its shape, transform and motion it reaches ", reach, " from the origin in ",
               scene.steps, " steps of ", scene.dt, ", beyond ", largest_number,
               ", the largest that can be reckoned with; choose other units, or a slower motion");
  }
}

/// A field knows no wall that fits between its voxels: particles would pass and nobody see it.
void check_walls(const Scene& scene, const std::string& file) {
  constexpr double most_thin = 0.1, most_slanted = 0.5;  // of the surface; the latter with edges
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const double needed = least_wall(scene, object), thin = thin_share(scene, object);
    const bool by_walls = object.walls.share_thinner(needed) > most_thin;
    if (thin == 0 || (!by_walls && thin <= most_slanted)) continue;
    // All but as many as are let through are thicker than this one.
    const auto& list = by_walls ? object.walls.opposite : object.walls.slanted;
    const double let_through = (by_walls ? most_thin : most_slanted) * object.walls.n_places();
    const double wall =
        list[static_cast<std::size_t>(std::min(let_through, static_cast<double>(list.size() - 1)))];
    const double shrink = (wall + kept_off(scene, object)) / (needed + kept_off(scene, object));
    const double resolution = std::ceil((object.grid.n[0] - 1) / shrink) + 1;
    tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i, "].shape: ", 100 * thin,
               " % of its surface is an open sheet, or a wall thinner than ", needed,
               ", which a field of ", object.grid.n[0],
               " voxels needs; particles would pass it: take ",
               object.field.empty() ? "" : "a field of ", "sides two",
               object.method == tess::dn::Method::normals ? " and another method" : "",
               shrink > 0 && resolution <= 1024
                   ? tess::text(", or a resolution of ", resolution, " or more")
                   : "");
  }
}

/// What no key by itself can say: the rules fit the masses, the fields cover the rules.
void check_rules(const Scene& scene, const std::string& file) {
  for (const double mass : masses_of(scene)) {
    try {
      validate(for_mass(scene.rules, mass));
    } catch (const tess::Error& error) {
      tess::fail(tess::ErrorCode::bad_value, file, ": rules.", error.what(), " (mass ", mass, ")");
    }
  }
  const bool sweeps = scene.rules.impact && scene.rules.impact->sweep == tess::dn::Sweep::on;
  const double reach = tess::dn::reach(scene.rules);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const tess::dn::Frame& frame = object.frame;
    const double least = least_scale(scene, object);
    if (!(least > 0))
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
                 "].motion.scale: ", frame.scale_rate, " a second takes the scale from ",
                 frame.scale, " to ", least, " in ", scene.steps, " steps of ", scene.dt,
                 "; it must stay above 0");
    const double covered = object.thickness * least,
                 within = least * tess::dn::covered(object.thickness, object.grid.cell,
                                                    object.sides, look_up_of(scene.rules));
    if (reach > within)
      tess::fail(tess::ErrorCode::bad_value, file, ": objects[", i,
                 "].thickness: ", object.thickness, " times scale ", least,
                 within < covered
                     ? tess::text(", less ", covered - within, " that a sheet keeps off,")
                     : "",
                 " is below the distance ", reach, " at which a rule begins to act");
    if (sweeps || !needs_field(scene.rules)) continue;
    const double extent = norm(bounds(object.surface).size());
    const double surface = norm(frame.velocity) +
                           norm(frame.angular_velocity) * frame.scale * extent +
                           std::abs(frame.scale_rate) * extent;
    for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
      const Emitter& emitter = scene.emitters[e];
      const double speed = norm(emitter.velocity) + std::sqrt(3.0) * emitter.spread +
                           std::abs(emitter.outward) + surface;
      if (speed * scene.dt > covered)
        tess::fail(tess::ErrorCode::bad_value, file, ": emitters[", e, "]: speed ", speed,
                   " times dt ", scene.dt, " passes the field of objects[", i, "], ", covered,
                   " thick, in one step; use impact with sweep, a thicker field or a shorter step");
    }
  }
}

Scene read(const JsonFile& file, const std::string& name) {
  const Keys keys = file.root().keys({"dt", "steps", "block", "exchange", "compression", "objects",
                                      "emitters", "rules", "outputs"});
  constexpr int most = static_cast<int>(most_steps);
  Scene scene;
  scene.name = name;
  scene.dt = keys.need("dt", "the time step").number(positive);
  scene.steps = static_cast<int>(keys.need("steps", "how many steps").whole(0, most));
  keys.read("block", scene.block, positive);
  keys.read("exchange", scene.exchange, 1, most);
  if (keys.has("compression")) scene.compression = read_compression(keys["compression"]);
  if (keys.has("rules")) scene.rules = read_rules(keys["rules"]);
  const std::string folder = std::filesystem::path(name).parent_path().string();
  if (keys.has("objects"))
    for (const Node& item : keys["objects"].items())
      scene.objects.push_back(read_object(item, folder, scene.dt, scene.rules));
  for (const Node& item : keys.need("emitters", "a list of at least one emitter").items(1))
    scene.emitters.push_back(read_emitter(item, scene.objects.size()));
  if (scene.n_particles() > static_cast<std::uint64_t>(most_particles))
    keys["emitters"].refuse(tess::text("makes more than ", most_particles, " particles"));
  if (keys.has("outputs")) scene.outputs = read_outputs(keys["outputs"], scene.objects);
  if (scene.compression) compress_fields(scene);
  check_scene(scene);
  return scene;
}

}  // namespace

void check_scene(const Scene& scene) {
  check_magnitude(scene, scene.name);
  check_rules(scene, scene.name);
  if (builds_fields(scene)) check_units(scene, scene.name);
  if (needs_field(scene.rules)) check_offset(scene, scene.name);
  check_walls(scene, scene.name);
}

Scene read_scene(const std::string& path) {
  return read(JsonFile(path), path);
}

Scene parse_scene(const std::string& text, const std::string& name) {
  return read(JsonFile(text, name), name);
}

}  // namespace particles
