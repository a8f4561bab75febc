// What was measured before a balance round: loads of elements, speeds and limits of PEs, messages
// between elements. The balancer fills it, a strategy reads it. Structure of arrays; an element is
// its position in them.
#pragma once

#include "runtime/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tess::balance {

/// Who an element is, across rounds.
struct ElementKey {
  std::int32_t array = 0;
  std::uint64_t element = 0;
  friend auto operator<=>(const ElementKey&, const ElementKey&) = default;
};

/// Messages from one element to another since the last round; ends are positions in Elements.
struct Edge {
  std::size_t from = 0;
  std::size_t to = 0;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
};

/// All arrays have one entry an element.
struct Elements {
  std::vector<ElementKey> key;
  std::vector<PeId> pe;
  std::vector<double> load;               ///< seconds on a PE of speed 1
  std::vector<std::uint8_t> migratable;   ///< 0 stays where it is
  std::vector<std::uint64_t> size_bytes;  ///< packed, and what it counts against a memory limit
  [[nodiscard]] std::size_t size() const { return key.size(); }
};

/// All arrays have one entry a PE.
struct Pes {
  std::vector<double> background;                 ///< seconds of wall time not spent in elements
  std::vector<double> speed;                      ///< relative, above 0
  std::vector<std::uint64_t> memory_limit_bytes;  ///< of elements together; 0: none
  [[nodiscard]] std::size_t size() const { return speed.size(); }
};

struct Snapshot {
  Elements elements;
  Pes pes;
  std::vector<Edge> edges;
};

/// The PE of every element after a round.
using Assignment = std::vector<PeId>;

/// Throws Error where array lengths differ, a PE is out of range, or a load or speed cannot be.
void validate(const Snapshot& snapshot);

}  // namespace tess::balance
