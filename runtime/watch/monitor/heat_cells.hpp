// What a PE reports for the heat map of an array.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace tess::detail {

/// What a heat map shows.
enum class HeatBy : std::uint8_t {
  load,  ///< the time that the elements' code takes
  pe,    ///< the PE that holds most of them
};

/// Names a heat map.
struct HeatMapId {
  CollectionId array{};
  HeatBy by{};
  friend auto operator<=>(const HeatMapId&, const HeatMapId&) = default;
};
/// A heat map that PEs are asked for.
struct HeatQuery {
  HeatMapId map;
  std::uint32_t watch = 0;  ///< numbered by process 0: one that begins again begins anew on all PEs
  friend auto operator<=>(const HeatQuery&, const HeatQuery&) = default;
};
/// At most so many at a time.
inline constexpr std::size_t most_heat_maps = 4;

struct HeatCells {
  HeatQuery of;
  PeId pe{};
  Range range;
  /// Of the HeatGrid of the range; only those with elements here.
  std::vector<std::uint32_t> cells;
  /// For each cell. Load: the part of the PE's time since the window began. PE: the number of
  /// elements.
  std::vector<float> values;
};

}  // namespace tess::detail
