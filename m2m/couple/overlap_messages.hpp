// The messages of conservative couplings, between pieces whose tetrahedra overlap.
#pragma once

#include "m2m/couple/messages.hpp"
#include "m2m/rows/conservative/overlap_rows.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tess::m2m {

/// From a target piece to a source piece: which of your tetrahedra overlap these?
struct OverlapQuery {
  CouplingId coupling{};
  collide::OwnerId from{};
  TargetTets tets;
};
/// The reply: which tetrahedra overlap, how much of them, and which unknowns have a row.
struct OverlapAnswer {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint32_t> tets;  ///< positions in the query
  std::vector<std::array<double, 4>> covered;
  std::vector<std::uint32_t> rows;  ///< positions among the query's unknowns
  std::uint64_t n_tested = 0;
};
/// From a target piece: the rows of an answer that other source pieces have a part of, too. The
/// target adds the parts and applies these rows itself, to values of the source's unknowns.
struct SharedRows {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<std::uint8_t> shared;  ///< per row of the answer: 0 or 1
};
/// The reply: the source piece's part of the shared rows.
struct PartialRows {
  CouplingId coupling{};
  collide::OwnerId from{};
  std::vector<GlobalId> ids;            ///< of all unknowns in them, ascending
  std::vector<std::uint32_t> first{0};  ///< per row, and the end: its first column
  std::vector<std::uint32_t> columns;   ///< positions in ids, ascending in a row
  std::vector<double> weights;
};

// In an application a source piece sends GivenValues: the loads of the rows that are not shared; if
// the kind is bounded, as many pairs (low, high); then the values of PartialRows::ids. All have
// n_components columns.

/// Values of points that the receiver holds as ghosts, within a projection.
struct GhostValues {
  CouplingId coupling{};
  collide::OwnerId from{};
  detail::Taker take;
  std::uint32_t step = 0;      ///< counts all steps of the channel
  std::vector<double> values;  ///< rows in the order of ids
};

}  // namespace tess::m2m
