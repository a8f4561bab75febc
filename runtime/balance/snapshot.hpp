// The measurements before a balance round: loads of elements, speeds and limits of PEs, messages
// between elements. The balancer fills it, and a strategy reads it. It is a structure of arrays; an
// element is identified by its position.
#pragma once

#include "runtime/balance/load.hpp"
#include "runtime/core/element_key.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
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

/// Data that several elements use. A PE holds it once, however many of them are there.
struct SharedBlock {
  std::uint64_t id = 0;
  std::uint64_t bytes = 0;
  PeId home;  ///< where the block is at first; only reported
  friend auto operator<=>(const SharedBlock&, const SharedBlock&) = default;
};

/// No position in Snapshot::blocks: the element uses none.
inline constexpr std::size_t no_block = std::numeric_limits<std::size_t>::max();

/// All arrays have one entry per element. `position` may be empty if no element has one,
/// `working_bytes` if all are 0, `block` if no element uses one, and `index` unless it was asked for
/// (BalanceOptions::indices).
struct Elements {
  std::vector<ElementKey> key;
  std::vector<PeId> pe;
  std::vector<Load> load;                   ///< seconds on a PE of speed 1, or unknown
  std::vector<std::uint8_t> migratable;     ///< 0 stays where it is
  std::vector<std::uint64_t> size_bytes;    ///< packed size: what a migration sends
  std::vector<std::uint64_t> memory_bytes;  ///< resident size: what counts against a memory limit
  std::vector<std::array<double, 3>> position;  ///< for rcb and hilbert
  std::vector<std::uint64_t> working_bytes;     ///< needed only while the element works
  std::vector<std::size_t> block;               ///< position in Snapshot::blocks, or no_block
  std::vector<std::string> index;               ///< as reports write it: [3], [1,2], ["name"]
  [[nodiscard]] std::size_t size() const { return key.size(); }
  [[nodiscard]] std::uint64_t working_bytes_of(std::size_t i) const {
    return working_bytes.empty() ? 0 : working_bytes[i];
  }
  [[nodiscard]] std::size_t block_of(std::size_t i) const {
    return block.empty() ? no_block : block[i];
  }
};

/// All arrays have one entry per PE. `working_bytes` may be empty if all are 0.
struct Pes {
  std::vector<double> background;                 ///< seconds of wall time not spent in elements
  std::vector<double> speed;                      ///< relative, above 0
  std::vector<std::uint64_t> memory_limit_bytes;  ///< limit of the PE's memory; 0: none
  std::vector<std::uint64_t> working_bytes;       ///< needed whatever elements are there
  [[nodiscard]] std::size_t size() const { return speed.size(); }
  [[nodiscard]] std::uint64_t working_bytes_of(std::size_t p) const {
    return working_bytes.empty() ? 0 : working_bytes[p];
  }
};

struct Snapshot {
  Elements elements;
  Pes pes;
  std::vector<Edge> edges;
  std::vector<SharedBlock> blocks;
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

/// Throws Error if array lengths differ, a PE is out of range, or a load or speed is invalid,
/// or memory adds up to more than any machine has.
void validate(const Snapshot& snapshot);

}  // namespace tess::balance
