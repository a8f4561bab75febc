// Snapshots for tests and benchmarks, in closed form or from a seed.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// PEs of speed 1 without background and limits; no elements yet.
[[nodiscard]] Snapshot idle_pes(std::size_t n_pes);

/// One more element of array 0, number n; returns its position. No bytes.
std::size_t add_element(Snapshot& snapshot, std::size_t pe, double load);

/// 64 elements of work i mod 7 + 1 on 4 PEs, 16 in a row on each (or all on PE 0).
enum class Start { blocks, all_on_first };
[[nodiscard]] Snapshot mod_seven(Start start);

/// n × n elements of a 5-point stencil, 1000 bytes to each neighbour, positions on the unit square,
/// rows in blocks on the PEs; loads 1 … 2, from the seed.
[[nodiscard]] Snapshot stencil(std::size_t n, std::size_t n_pes, std::uint64_t seed);

/// Elements in blocks on the PEs; loads of density ~ x^-2.5 from 1 to 64, heaviest PEs together,
/// so that the present placement is bad; a ring of messages; positions on a line.
[[nodiscard]] Snapshot heavy_tailed(std::size_t n_elements, std::size_t n_pes, std::uint64_t seed);

/// Any valid snapshot: pinned elements, speeds, background, limits (some broken already), no
/// elements, no loads.
[[nodiscard]] Snapshot anything(std::uint64_t seed);

}  // namespace tess::balance
