#include "apps/particles/shape_reader.hpp"

#include "apps/particles/box_union.hpp"
#include "apps/particles/shown.hpp"
#include "collide/dn_field/grid.hpp"
#include "collide/dn_field/outward.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <filesystem>
#include <numbers>

namespace particles {
namespace {
using tess::dn::Surface;
using tess::dn::Vec3;

constexpr int most_rings = 2000;

/// A closed cylinder around the z axis, |z| <= half_height.
Surface make_cylinder(double radius, double half_height, int sides) {
  Surface out;
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    const double x = radius * std::cos(turn), y = radius * std::sin(turn);
    out.vertices.push_back({x, y, -half_height});
    out.vertices.push_back({x, y, half_height});
  }
  out.vertices.push_back({0, 0, -half_height});
  out.vertices.push_back({0, 0, half_height});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    out.triangles.push_back({a, b, b + 1});
    out.triangles.push_back({a, b + 1, a + 1});
    out.triangles.push_back({2 * n, b, a});
    out.triangles.push_back({2 * n + 1, a + 1, b + 1});
  }
  return out;
}

Surface read_boxes(const Node& node) {
  std::vector<tess::dn::Bounds> boxes;
  for (const Node& item : node.items(1)) {
    const Keys box = item.keys({"low", "high"});
    const Vec3 low = box.need("low", "a corner [x, y, z]").vector(),
               high = box.need("high", "the other corner [x, y, z]").vector();
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
      box["high"].refuse("is not above low on every axis");
    boxes.push_back({low, high});
  }
  try {
    return union_of(boxes);
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot be joined: ") + error.what());
  }
}

/// As for the numbers of a scene.
void check_magnitude(const Surface& surface) {
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
    for (const double at : {surface.vertices[v].x, surface.vertices[v].y, surface.vertices[v].z})
      if (!(std::abs(at) <= largest_number))
        tess::fail(tess::ErrorCode::bad_mesh,
                   "vertex ",
                   v,
                   " has the coordinate ",
                   at,
                   ", beyond ±",
                   largest_number,
                   "; choose other units");
}

/// Whatever is wrong with the file is told with the key that names it.
Surface read_file(const Node& node, const std::string& folder) {
  const std::filesystem::path name(node.text());
  const std::string path = (name.is_absolute() ? name : folder / name).string();
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    node.blame(path + ": is a directory; give the path of an OBJ file");
  try {
    Surface surface = tess::dn::read_obj(path);
    check_magnitude(surface);
    return surface;
  } catch (const tess::Error& error) {
    constexpr std::size_t longest = 200;  // it quotes the rest of a line
    const std::string_view what = error.what();
    const bool named = what.starts_with(path);
    node.blame(path + (named ? "" : ": ") +
               shown_text(what.substr(named ? path.size() : 0), longest));
  }
}

Surface read_shape(const Node& node, const std::string& folder, std::string& name) {
  const Keys keys = node.keys({"sphere", "box", "boxes", "torus", "cylinder", "plate", "file"});
  const std::string_view kind =
      keys.one_of({"sphere", "box", "boxes", "torus", "cylinder", "plate", "file"});
  const Node of = keys[kind];
  name = kind;
  if (kind == "file") {
    name = of.text();
    return read_file(of, folder);
  }
  if (kind == "boxes") return read_boxes(of);
  if (kind == "box")
    return tess::dn::make_box(
        of.keys({"half"}).need("half", "half the edges [x, y, z]").vector(positive));
  if (kind == "plate") {
    const Keys plate = of.keys({"half", "n"});
    int n = 1;
    plate.read("n", n, 1, most_rings);
    return tess::dn::make_plate(plate.need("half", "half the edge").number(positive), n);
  }
  if (kind == "sphere") {
    const Keys sphere = of.keys({"radius", "rings"});
    int rings = 48;
    sphere.read("rings", rings, 2, most_rings);
    return tess::dn::make_sphere(sphere.need("radius", "the radius").number(positive), rings);
  }
  if (kind == "cylinder") {
    const Keys cylinder = of.keys({"radius", "half_height", "sides"});
    int sides = 64;
    cylinder.read("sides", sides, 3, most_rings);
    return make_cylinder(cylinder.need("radius", "the radius").number(positive),
                         cylinder.need("half_height", "half the height").number(positive),
                         sides);
  }
  const Keys torus = of.keys({"major", "minor", "n"});
  int n = 64;
  torus.read("n", n, 3, most_rings);
  const double major = torus.need("major", "the radius of the ring").number(positive);
  const Node minor = torus.need("minor", "the radius of the tube");
  if (minor.number(positive) >= major) minor.refuse("is not below major");
  return tess::dn::make_torus(major, minor.number(), n);
}

tess::dn::Frame read_transform(const Node& node) {
  const Keys keys = node.keys({"position", "rotation", "scale", "matrix"});
  tess::dn::Frame frame;
  Vec3 position;
  keys.read("position", position);
  if (keys.has("matrix")) {
    if (keys.has("rotation") || keys.has("scale"))
      node.refuse("has a matrix beside rotation or scale; give either");
    const std::vector<Node> rows = keys["matrix"].items();
    if (rows.size() != 3) keys["matrix"].refuse("is not a list of three rows");
    const Vec3 x = rows[0].vector(), y = rows[1].vector(), z = rows[2].vector();
    try {
      return tess::dn::frame_from({{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}, position);
    } catch (const tess::Error& error) {
      keys["matrix"].refuse(std::string("cannot be used: ") + error.what());
    }
  }
  Vec3 degrees;
  keys.read("rotation", degrees);
  keys.read("scale", frame.scale, positive);
  frame.axes = tess::dn::rotation((std::numbers::pi / 180) * degrees);
  frame.position = position;
  return frame;
}

/// Resolution and thickness from how fast the particles are and how fine the object is.
void choose(const Node& node, const tess::dn::Bounds& box, double dt, SceneObject& object) {
  constexpr std::size_t most_voxels = std::size_t{512} * 512 * 512;
  const Keys keys = node.keys({"max_speed", "detail"});
  const double scale = object.frame.scale;
  const tess::dn::Demand demand{
      keys.need("max_speed", "the largest speed relative to the surface").number(positive) / scale,
      dt,
      keys.need("detail", "the size of the smallest feature").number(positive)};
  try {
    const tess::dn::Choice choice = tess::dn::choose(box, demand, most_voxels);
    object.resolution = choice.grid.n[0];
    object.thickness = choice.thickness;
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot be met: ") + error.what());
  }
}

}  // namespace

SceneObject read_object(const Node& node, const std::string& folder, double dt) {
  const Keys keys = node.keys(
      {"shape", "resolution", "thickness", "method", "sides", "transform", "motion", "choose"});
  SceneObject object;
  const Node shape = keys.need("shape", "one of sphere, box, boxes, torus, cylinder, plate, file");
  object.surface = read_shape(shape, folder, object.name);
  if (keys.has("transform")) object.frame = read_transform(keys["transform"]);
  if (keys.has("motion")) {
    const Keys motion = keys["motion"].keys({"velocity", "spin", "scale"});
    motion.read("velocity", object.frame.velocity);
    motion.read("spin", object.frame.angular_velocity);
    motion.read("scale", object.frame.scale_rate);
  }
  if (keys.has("method"))
    object.method =
        static_cast<tess::dn::Method>(keys["method"].word({"exact", "normals", "potential"}));
  if (keys.has("sides"))
    object.sides = static_cast<tess::dn::Sides>(keys["sides"].word({"one", "two"}));
  // Emitters, audits and the study see the triangles as the field does.
  if (object.sides == tess::dn::Sides::one)
    object.surface = Surface(tess::dn::OutwardSurface(object.surface).surface());
  const tess::dn::Bounds box = tess::dn::bounds(object.surface);
  const Vec3 size = box.size();
  object.thickness = 0.25 * std::max({size.x, size.y, size.z});
  if (keys.has("choose")) {
    if (keys.has("resolution") || keys.has("thickness"))
      keys["choose"].refuse("stands beside resolution or thickness; give either");
    choose(keys["choose"], box, dt, object);
    return object;
  }
  keys.read("thickness", object.thickness, positive);
  keys.read("resolution", object.resolution, 4, 1024);
  const tess::dn::Grid grid = [&] {
    try {
      return tess::dn::grid_around(box, object.resolution, object.thickness);
    } catch (const tess::Error& error) {
      node.refuse(std::string("cannot have a field: ") + error.what());
    }
  }();
  if (object.thickness < 2 * grid.cell)
    (keys.has("thickness") ? keys["thickness"] : node)
        .refuse(tess::text(
            "is thinner than two cells of ", grid.cell, "; raise the thickness or the resolution"));
  return object;
}

}  // namespace particles
