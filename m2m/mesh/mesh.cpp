#include "m2m/mesh.hpp"

#include "runtime/core/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tess::m2m {

Aabb bounds(const TetMesh& mesh) {
  return collide::box_around(mesh.points);
}

double signed_volume(const TetMesh& mesh, std::size_t tet) {
  return signed_volume(corners_of(mesh.points, mesh.tets[tet]));
}

double area_or_length(const std::array<Point, 4>& corners, std::int32_t dimension) {
  const Point along = difference(corners[1], corners[0]);
  if (dimension == 1) return std::hypot(along[0], along[1], along[2]);
  const Point normal = cross(along, difference(corners[2], corners[0]));
  return std::hypot(normal[0], normal[1], normal[2]) / 2;
}

std::string skipped_text(const TetMesh& mesh) {
  std::string out;
  for (const Skipped& skipped : mesh.skipped) {
    if (!out.empty()) out += ", ";
    out += std::to_string(skipped.n_elements) + " " + skipped.type;
  }
  return out;
}

std::string split_text(const TetMesh& mesh) {
  std::string out;
  for (const SplitElements& split : mesh.split) {
    if (!out.empty()) out += ", ";
    out += std::to_string(split.n_elements) + " " + split.type + " into " +
           std::to_string(split.n_tets) + " " + cells_of(mesh.dimension);
    if (split.n_folded > 0)
      out += " (" + std::to_string(split.n_folded) +
             " folded, so that their parts overlap: check the order of their vertices)";
  }
  return out;
}

namespace {

/// How many have an equal; empty if none has.
template <class T>
std::string equals_text(std::vector<T> all, const char* what) {
  std::sort(all.begin(), all.end());
  std::size_t n = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((i > 0 && all[i] == all[i - 1]) || (i + 1 < all.size() && all[i] == all[i + 1])) ++n;
  return n == 0 ? std::string() : text(n, " of ", all.size(), what);
}

}  // namespace

std::size_t n_unused(const TetMesh& mesh) {
  std::vector<char> used(mesh.n_points(), 0);
  for (const Tet& tet : mesh.tets)
    for (const VertexId v : tet) used[static_cast<std::size_t>(v)] = 1;
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
}

std::string unused_text(std::size_t n_unused, std::size_t n_points) {
  if (n_unused == 0) return {};
  return text(n_unused, " of ", n_points, " vertices belong to no element");
}

std::string coincident_text(const TetMesh& mesh) {
  return equals_text(mesh.points, " vertices have the place of another");
}

std::string repeated_text(const TetMesh& mesh) {
  std::vector<Tet> tets = mesh.tets;
  for (Tet& tet : tets) std::sort(tet.begin(), tet.end());
  return equals_text(std::move(tets),
                     text(" ", cells_of(mesh.dimension), " have the corners of another").c_str());
}

}  // namespace tess::m2m
