// Counts of tetrahedra per cell of a Hilbert curve. A PE has tetrahedra in few of the cells, so
// only blocks of 64 cells that hold some are kept: a reduction over many PEs moves little until it
// is near its root.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace tess::m2m {

struct CellCounts {
  static constexpr std::size_t block_size = 64;
  std::vector<std::uint32_t> blocks;  ///< ascending
  std::vector<std::uint32_t> counts;  ///< block_size per block
};

/// Adds counts of the same cells.
struct JoinCounts {
  CellCounts operator()(CellCounts a, const CellCounts& b) const {
    constexpr std::size_t size = CellCounts::block_size;
    CellCounts sum;
    sum.blocks.reserve(a.blocks.size() + b.blocks.size());
    std::set_union(a.blocks.begin(), a.blocks.end(), b.blocks.begin(), b.blocks.end(),
                   std::back_inserter(sum.blocks));
    if (sum.blocks.size() == a.blocks.size()) {
      sum = std::move(a);
    } else {
      sum.counts.resize(sum.blocks.size() * size);
      add(a, sum);
    }
    add(b, sum);
    return sum;
  }

 private:
  /// `into` has all blocks of `from`.
  static void add(const CellCounts& from, CellCounts& into) {
    constexpr std::size_t size = CellCounts::block_size;
    std::size_t to = 0;
    for (std::size_t block = 0; block < from.blocks.size(); ++block, ++to) {
      while (into.blocks[to] != from.blocks[block]) ++to;
      for (std::size_t i = 0; i < size; ++i)
        into.counts[to * size + i] += from.counts[block * size + i];
    }
  }
};

}  // namespace tess::m2m
