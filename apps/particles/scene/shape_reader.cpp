#include "apps/particles/scene/shape_reader.hpp"

#include "apps/particles/scene/box_union.hpp"
#include "apps/particles/scene/shown.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/core/error.hpp"

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
        tess::fail(tess::ErrorCode::bad_mesh, "vertex ", v, " has the coordinate ", at,
                   ", beyond ±", largest_number, "; choose other units");
}

/// Whatever is wrong with the file is told with the key that names it.
Surface read_file(const Node& node, const std::string& folder) {
  const std::string path = path_beside(folder, node.text());
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

}  // namespace

std::string path_beside(const std::string& folder, const std::string& name) {
  const std::filesystem::path path(name);
  return (path.is_absolute() ? path : folder / path).string();
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
                         cylinder.need("half_height", "half the height").number(positive), sides);
  }
  const Keys torus = of.keys({"major", "minor", "n"});
  int n = 64;
  torus.read("n", n, 3, most_rings);
  const double major = torus.need("major", "the radius of the ring").number(positive);
  const Node minor = torus.need("minor", "the radius of the tube");
  if (minor.number(positive) >= major) minor.refuse("is not below major");
  return tess::dn::make_torus(major, minor.number(), n);
}

}  // namespace particles
