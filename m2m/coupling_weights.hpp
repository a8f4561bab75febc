// The weights of a coupling as a sparse matrix, for files (weights_file.hpp) and other programs:
//
//     const WeightMatrix weights =
//         co_await collect_weights(coupling, n_source_vertices, n_target_vertices);
//
// The rows travel to one PE, whose memory holds the matrix: about 100 bytes per target vertex. A
// transfer itself never needs that.
#pragma once

#include "m2m/coupling.hpp"
#include "m2m/transfer.hpp"
#include "m2m/weights_file.hpp"

#include <cstdint>

namespace tess::m2m {

struct GlobalRows;

/// The matrix of rows over global ids. Throws Error (bad_value) if an id is not in range or a
/// target occurs twice.
[[nodiscard]] WeightMatrix matrix_of(const GlobalRows& rows, std::int64_t n_sources,
                                     std::int64_t n_targets);

/// Throws Error (bad_argument) unless values of this kind are a matrix times the source values.
void require_weights(TransferKind kind, bool clamp);

/// Collects the donors of the last search. No search is under way, and no piece has changed since
/// the last one. Points are named by MeshView::point_ids, which must be 0 to n_sources - 1 and 0 to
/// n_targets - 1. For linear couplings apply() of the matrix gives the bits of the coupling; for
/// second_order the same up to rounding; `limited` has no weights and is refused. Targets outside
/// the source have no weights, except those with the nearest vertex (Nearest): one weight of 1.
TaskOf<WeightMatrix> collect_weights(const AnyCoupling& coupling, std::int64_t n_sources,
                                     std::int64_t n_targets);

/// Does the same for a transfer between meshes that the library holds.
inline TaskOf<WeightMatrix> collect_weights(const Transfer& transfer, std::int64_t n_sources,
                                            std::int64_t n_targets) {
  return collect_weights(transfer.coupling(), n_sources, n_targets);
}

}  // namespace tess::m2m
