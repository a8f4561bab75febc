// Moves fields in the elements of one mesh to the tetrahedra of another that overlaps it. The
// library cuts both meshes. What a kind makes of cells:
//
// | kind                   | value of a target cell                                    | order |
// |------------------------|-----------------------------------------------------------|-------|
// | `nearest`              | of the source tetrahedron with the nearest centroid       | 1     |
// | `moving_least_squares` | of the fit to source tetrahedra's values at centroids     | 2, 1  |
// | `linear`               | of the source cell that holds its centroid                | 1     |
// | `native`               | the same                                                  | 1     |
// | `projection`           | the same, and outside of the nearest one                  | 1     |
// | `second_order`         | the same, with the recovered gradient of the source cell  | 2     |
// | `limited`              | the same, kept within the source cells around             | 2     |
// | `conservative`         | mean over what overlaps it, with recovered gradients      | 2     |
// | `conservative_bounded` | the same, kept within the source cells around             | 2     |
// | `conservative_lumped`  | mean over what overlaps it of the source cells' values    | 1     |
//
// Kinds with gradients are exact for linear fields; limits lower the order at extrema and
// boundaries. Moving least squares are of order 1 if source elements were split. Across a single layer of elements that is flat, or so gently curved that the
// neighbours of an element lie less than a quarter as far off its plane as its own corners, the
// gradient is zero. An element that was split is one cell of the source (TetMesh::element_of_tet).
// In the target each of its tetrahedra gets a value of its own. The result depends only on the
// meshes and the fields, as for transfers between vertices.
#pragma once

#include "m2m/field.hpp"
#include "m2m/partition_method.hpp"
#include "m2m/transfer.hpp"

#include <vector>

namespace tess::m2m {

struct CellOutcome {
  std::vector<Field> fields;  ///< n_tets × n_components of the target each
  /// Per target tetrahedron: where its centroid is; of conservative kinds, if it is covered; of
  /// `nearest` always outside, since that kind compares only centroids.
  std::vector<Status> status;
  SearchSummary search;
};

/// `fields`: n_tets rows of the source each; the tetrahedra of an element have the same value. Cuts
/// each mesh into `n_parts`. Target cells that the policy keeps have the value 0. Without fields it
/// finds the status of the target's cells. `source`, `fields` and `target` must outlive the task.
///
/// Throws Error (bad_argument), before anything is sent, for a kind and a policy that do not go
/// together (only kind nearest has a nearest cell, and none that is outside), for a tolerance that
/// is not from 0 to 1e100, and for a tolerance or clamp with conservative kinds.
TaskOf<CellOutcome> transfer_cells(const TetMesh& source, const std::vector<Field>& fields,
                                   const TetMesh& target, std::int32_t n_parts,
                                   PartitionMethod method, TransferOptions options);

}  // namespace tess::m2m
