// The messages of conservative couplings, between pieces whose tetrahedra overlap.
#pragma once

#include "m2m/conservative/overlaps.hpp"
#include "m2m/parallel/messages.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// From a target piece to a source piece: which of your tetrahedra overlap these?
struct OverlapQuery {
  CouplingId coupling{};
  collide::OwnerId from{};
  TargetTets tets;
};
/// The reply: per tetrahedron that overlaps, the ids of the source tetrahedra, ascending.
struct OverlapAnswer {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> tets;   ///< positions in the query
  std::vector<std::uint32_t> first;  ///< per entry of tets, and the end: its first id
  std::vector<GlobalId> ids;
  std::uint64_t n_tested = 0;
};
/// The end of a search: the entries of an answer that other source pieces overlap, too. Their loads
/// are sent overlap by overlap; so the target adds all of a tetrahedron in the order of ids,
/// wherever the source is cut. The loads of the others are added by the source, in the same order.
struct SharedTets {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint8_t> shared;  ///< per entry: 0 or 1
};

/// Loads for a target piece are GivenValues: a block for each entry of the answer, or for each
/// overlap of a shared one; in a block 4 × n_components loads, or n_components for cells, and if the
/// kind is bounded n_components ranges.
/// Values of points that the receiver holds as ghosts, within a projection.
struct GhostValues {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::uint64_t channel = 0;
  std::uint32_t step = 0;      ///< counts all steps of the channel
  std::vector<double> values;  ///< rows in the order of ids
};

}  // namespace tess::m2m
