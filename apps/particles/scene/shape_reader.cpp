#include "apps/particles/scene/box_union.hpp"
#include "apps/particles/scene/readers.hpp"
#include "collide/dn_field/shapes.hpp"
#include "collide/read_surface.hpp"
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
    Vec3 low, high;
    item.read({{"low", low, any_number, "a corner [x, y, z]"},
               {"high", high, any_number, "the other corner [x, y, z]"}});
    if (!(low.x < high.x && low.y < high.y && low.z < high.z))
      item["high"].refuse("is not above low on every axis");
    boxes.push_back({low, high});
  }
  try {
    return union_of(boxes);
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot be joined: ") + error.what());
  }
}

/// Errors of the file name the key that names the file.
Surface read_file(const Node& node, const std::string& folder) {
  const std::string path = path_beside(folder, node.text());
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown))
    node.blame(path + ": is a directory; give the path of a file .obj, .ply or .stl");
  try {
    Surface surface = tess::dn::read_surface(path);
    tess::dn::validate(surface);
    return surface;
  } catch (const tess::Error& error) {
    constexpr std::size_t longest = 200;  // it quotes the rest of a line
    std::string_view what = error.what();
    const bool named = what.starts_with(path);
    if (named) what.remove_prefix(path.size());
    node.blame(path + (named ? "" : ": ") + shown(what, longest));
  }
}

}  // namespace

std::string path_beside(const std::string& folder, const std::string& name) {
  const std::filesystem::path path(name);
  return (path.is_absolute() ? path : folder / path).string();
}

Surface read_shape(const Node& node, const std::string& folder) {
  Surface out;
  double radius = 0, half = 0, minor = 0;
  int n = 0;
  const auto sphere = [&](const Node& of) {
    n = 48;
    of.read({{"radius", radius, positive, "the radius"}, {"rings", n, 2, most_rings}});
    out = tess::dn::make_sphere(radius, n);
  };
  const auto box = [&](const Node& of) {
    Vec3 edges;
    of.read({{"half", edges, positive, "half the edges [x, y, z]"}});
    out = tess::dn::make_box(edges);
  };
  const auto torus = [&](const Node& of) {
    n = 64;
    of.read({{"major", radius, positive, "the radius of the ring"},
             {"minor", minor, positive, "the radius of the tube"},
             {"n", n, 3, most_rings}});
    if (minor >= radius) of["minor"].refuse("is not below major");
    out = tess::dn::make_torus(radius, minor, n);
  };
  const auto cylinder = [&](const Node& of) {
    n = 64;
    of.read({{"radius", radius, positive, "the radius"},
             {"half_height", half, positive, "half the height"},
             {"sides", n, 3, most_rings}});
    out = make_cylinder(radius, half, n);
  };
  const auto plate = [&](const Node& of) {
    n = 1;
    of.read({{"half", half, positive, "half the edge"}, {"n", n, 1, most_rings}});
    out = tess::dn::make_plate(half, n);
  };
  (void)node.one_of({"sphere", "box", "boxes", "torus", "cylinder", "plate", "file"});
  node.read({{"sphere", sphere},
             {"box", box},
             {"boxes", [&](const Node& of) { out = read_boxes(of); }},
             {"torus", torus},
             {"cylinder", cylinder},
             {"plate", plate},
             {"file", [&](const Node& of) { out = read_file(of, folder); }}});
  return out;
}

}  // namespace particles
