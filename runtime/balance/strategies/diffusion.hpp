// Diffusion by dimension exchange (Cybenko 1989): a PE equalises its load with one neighbour after
// the other. Each has about log2(n_pes) + 1 neighbours, meets one per stage, and sees only that
// neighbour's summary; no number is known to all. An element that is too heavy for a one-way move
// is exchanged for smaller ones.
//
//   stage k pairs p with (2^k − 1 − p) mod n_pes: a matching for every number of PEs, so that no
//   two PEs give to a third at once and a memory limit needs no protocol.
#pragma once

#include "runtime/balance/local_pe.hpp"

namespace tess::balance {

/// Stages until every PE has met all of its neighbours.
[[nodiscard]] std::size_t n_stages(std::size_t n_pes);
/// The partner of a PE in a stage; the PE itself if it has none.
[[nodiscard]] std::size_t partner(std::size_t pe, std::size_t stage, std::size_t n_pes);

/// An element that a PE offers to its partner, and the work that should go with it.
struct Gift {
  Item item;
  double wanted = 0;
};

/// The step of one PE towards its partner, until both finish at about the same time; none if moving
/// work from `self` does not pay off (any more). The partner answers by LocalPe::change_for.
[[nodiscard]] std::optional<Gift> diffuse(const LocalPe& self, const PeSummary& other);

/// Runs the steps of all PEs over a snapshot: at most `n_sweeps` times over all stages, or until
/// one sweep moves nothing.
[[nodiscard]] Assignment diffusion(const Snapshot& snapshot, std::size_t n_sweeps = 8);

}  // namespace tess::balance
