// The project's own mesh: N³ cubes of the unit cube, each cut along its main diagonal into six
// tetrahedra (Kuhn 1960). Conforming, all tetrahedra of positive orientation, no file needed.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace tess::m2m {

struct KuhnBox {
  std::int32_t n = 1;  ///< cubes a side, 1 to 700
  double jitter =
      0.0;  ///< inner vertices move by up to this fraction of a cell along each axis, 0 to 0.2
};

/// "kuhn:8", or "kuhn:8@0.2" with jitter; throws Error (bad_argument) otherwise.
[[nodiscard]] KuhnBox parse_kuhn(std::string_view name);

/// (n+1)³ vertices, x fastest, and 6 n³ tetrahedra. The jitter is a hash of the vertex id: the same
/// on every machine.
[[nodiscard]] TetMesh kuhn_mesh(KuhnBox box);

}  // namespace tess::m2m
