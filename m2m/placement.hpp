// Set-up of a distributed mesh by all PEs together: no PE holds the whole mesh. A group, one Placer
// per PE, is led by place(). All PEs wait for each other after `read`, after each round of `count`,
// and before the owners of points are decided; without a halo, for the rest a PE knows how many
// tetrahedra, points and lists of ghosts it gets, and goes on when they are here:
//
//     1  read     every PE reads a range of the points, of which it is the keeper, and of the
//                 tetrahedra
//        corners  asks the keepers for the corners of its tetrahedra; both are checked as by
//                 validate()
//        count    tetrahedra in cells of a Hilbert curve, until it is known where to cut (CurveCut)
//     2  send     every tetrahedron goes to the PE of its part
//     3  points   a part asks the keepers for its points; the lowest part that asks owns a point
//     4  halo     per layer: asks the other parts at its points for their tetrahedra there
//        ghosts   a part reports to the owners of its ghosts where they are, and evaluates its fields
//        load     the parts, complete, go to their Workers
//
// survey() ends after the corners and the shapes of the tetrahedra, and builds nothing.
//
// The parts are those of split(), and depend only on the mesh, their number and the halo.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/mesh/workers/scatter.hpp"

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace tess::m2m {

///     const PlacedMesh placed = co_await place("a.exo", {.n_parts = 16});
struct PlaceOptions {
  std::int32_t n_parts = 1;
  std::int32_t halo_layers = 0;
  /// For kind native: keeps the elements that tetrahedra of a mesh in memory were split from. PE 0
  /// cuts such a mesh.
  bool keeps_elements = false;
};
static_assert(std::is_trivially_destructible_v<PlaceOptions>,
              "g++ 12 destroys an aggregate twice that is written in a co_await expression");

/// What place() knows of a mesh.
struct PlacedMesh {
  DistributedMesh mesh{};
  GlobalId n_points = 0, n_tets = 0;
  MeshCensus census{};
};

/// Reads `name` (as read_mesh() does), cuts it by PartitionMethod::curve, and creates the Workers,
/// which evaluate `fields`. The errors are those of read_mesh(), validate(), make_formula() and
/// sample(). Side sets and node sets of a file that is read in ranges are not read.
TaskOf<PlacedMesh> place(std::string name, PlaceOptions options,
                         std::vector<FormulaField> fields = {});

/// The same for a mesh in the memory of this PE, which it must outlive.
TaskOf<PlacedMesh> place(const TetMesh* mesh, PlaceOptions options,
                         std::vector<FormulaField> fields = {});

/// What survey() finds.
struct MeshSurvey {
  GlobalId n_points = 0, n_tets = 0;
  MeshCensus census{};
  double longest_edge = 0;
  double volume = 0;               ///< sum of measure(), the same bits for any number of PEs
  std::string skipped{}, split{};  ///< as skipped_text() and split_text()
  std::int32_t dimension = 3;      ///< TetMesh::dimension
};

/// True if place() and survey() read the mesh in ranges, so that no PE holds all of it. False for a
/// file that cannot be opened: they report it.
[[nodiscard]] bool is_read_in_ranges(const std::string& name);

/// Reads and checks a mesh by all PEs together, as place() does, and keeps nothing of it. `fields`
/// are evaluated at every point. The errors are those of read_mesh(), validate(), make_formula()
/// and sample().
TaskOf<MeshSurvey> survey(std::string name, std::vector<FormulaField> fields);

/// The same of a mesh in memory, without fields, by the caller alone.
[[nodiscard]] MeshSurvey survey(const TetMesh& mesh);

}  // namespace tess::m2m
