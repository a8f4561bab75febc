#include "m2m/mesh.hpp"

#include <cstddef>

namespace tess::m2m {

Aabb bounds(const TetMesh& mesh) {
  return collide::box_around(mesh.points);
}

double signed_volume(const TetMesh& mesh, std::size_t tet) {
  std::array<Point, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = mesh.points[static_cast<std::size_t>(mesh.tets[tet][k])];
  return signed_volume(corners);
}

double signed_volume(const std::array<Point, 4>& corners) {
  const Point o = corners[0];
  std::array<Point, 3> e{corners[1], corners[2], corners[3]};
  for (Point& edge : e) {
    for (std::size_t axis = 0; axis < 3; ++axis) edge[axis] -= o[axis];
  }
  return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
          e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
          e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
         6.0;
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
           std::to_string(split.n_tets) + " tetrahedra";
  }
  return out;
}

}  // namespace tess::m2m
