// A generated mesh that needs no file: N³ cubes of the unit cube, each cut along its main diagonal
// into six tetrahedra (Kuhn 1960). The mesh is conforming, and all tetrahedra have positive
// orientation.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tess::m2m {

struct KuhnBox {
  std::int32_t n = 1;   ///< cubes per side, 1 to 700
  double jitter = 0.0;  ///< inner vertices move by up to this part of a cube on each axis, 0 to 0.2
};

/// "kuhn:8", or "kuhn:8@0.2" with jitter. Throws Error (bad_argument) for any other name.
[[nodiscard]] KuhnBox parse_kuhn(std::string_view name);

/// (n+1)³ vertices, x fastest, and 6 n³ tetrahedra. The jitter is a hash of the vertex id, so it is
/// the same on every machine.
[[nodiscard]] TetMesh kuhn_mesh(KuhnBox box);

/// Gives the same mesh in ranges of ids, for PEs that hold a part of it.
[[nodiscard]] GlobalId n_points(KuhnBox box);
[[nodiscard]] GlobalId n_tets(KuhnBox box);
void kuhn_points(KuhnBox box, GlobalId first, std::span<Point> points);
void kuhn_tets(KuhnBox box, GlobalId first, std::span<Tet> tets);

}  // namespace tess::m2m
