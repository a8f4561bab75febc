// The measurements before a balance round: loads of elements, speeds and limits of PEs, messages
// between elements. The balancer fills it, and a strategy reads it. It is a structure of arrays; an
// element is identified by its position.
#pragma once

#include "runtime/core/element_key.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tess::balance {

/// Messages from one element to another since the last round; the ends are positions in Elements.
struct Edge {
  std::size_t from = 0;
  std::size_t to = 0;
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// All arrays have one entry per element. `position` may be empty if no element has one, and
/// `measured` may be empty if all loads are measured.
struct Elements {
  std::vector<ElementKey> key;
  std::vector<PeId> pe;
  std::vector<double> load;                 ///< seconds on a PE of speed 1
  std::vector<std::uint8_t> measured;       ///< 0: the load is unknown and its entry meaningless
  std::vector<std::uint8_t> migratable;     ///< 0 stays where it is
  std::vector<std::uint64_t> size_bytes;    ///< packed size: what a migration sends
  std::vector<std::uint64_t> memory_bytes;  ///< resident size: what counts against a memory limit
  std::vector<std::array<double, 3>> position;  ///< for rcb and hilbert
  [[nodiscard]] std::size_t size() const { return key.size(); }
  [[nodiscard]] bool knows_load(std::size_t i) const {
    return measured.empty() || measured[i] != 0;
  }
};

/// All arrays have one entry per PE.
struct Pes {
  std::vector<double> background;                 ///< seconds of wall time not spent in elements
  std::vector<double> speed;                      ///< relative, above 0
  std::vector<std::uint64_t> memory_limit_bytes;  ///< limit of all elements together; 0: none
  [[nodiscard]] std::size_t size() const { return speed.size(); }
};

struct Snapshot {
  Elements elements;
  Pes pes;
  std::vector<Edge> edges;
};

/// The PE of every element after a round.
using Assignment = std::vector<PeId>;

/// The position of a PE in Pes, and back.
[[nodiscard]] constexpr std::size_t slot(PeId pe) {
  return static_cast<std::size_t>(pe.value);
}
[[nodiscard]] constexpr PeId pe_at(std::size_t slot) {
  return PeId{static_cast<std::int32_t>(slot)};
}

/// Throws Error if array lengths differ, a PE is out of range, or a load or speed is invalid.
void validate(const Snapshot& snapshot);

}  // namespace tess::balance
