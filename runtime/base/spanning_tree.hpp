// The tree over all PEs along which broadcasts, reductions and waves run. Any PE can be its root;
// each PE has up to four children. It is a pure function of the number of PEs and the root, so all
// PEs agree on it.
#pragma once

#include "runtime/core/algorithm.hpp"
#include "runtime/core/ids.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

class SpanningTree {
 public:
  /// The tree as seen from `self`; PEs are 0 … n_pes - 1.
  SpanningTree(PeId self, PeId root, std::int32_t n_pes)
      : root_(root.value), n_pes_(n_pes), rank_((self.value - root.value + n_pes) % n_pes) {}

  /// The next PE towards the root; the root has none.
  [[nodiscard]] PeId parent() const { return at((rank_ - 1) / fan_out); }

  [[nodiscard]] std::vector<PeId> children() const {
    std::vector<PeId> out;
    out.reserve(static_cast<std::size_t>(n_children()));
    for (std::int32_t slot = 0; slot < n_children(); ++slot) out.push_back(child(slot));
    return out;
  }

  /// The children have the slots 0 … n_children() − 1.
  [[nodiscard]] std::int32_t n_children() const {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(n_pes_ - first_child(), 0, std::int64_t{fan_out}));
  }
  [[nodiscard]] PeId child(std::int32_t slot) const { return at(first_child() + slot); }
  /// The slot of a child.
  [[nodiscard]] std::int32_t slot_of(PeId child) const {
    return static_cast<std::int32_t>((child.value - root_ + n_pes_) % n_pes_ - first_child());
  }

  static constexpr std::int32_t fan_out = 4;

 private:
  [[nodiscard]] std::int64_t first_child() const { return std::int64_t{rank_} * fan_out + 1; }
  [[nodiscard]] PeId at(std::int64_t rank) const {
    return PeId{static_cast<std::int32_t>((rank + root_) % n_pes_)};
  }

  std::int32_t root_, n_pes_, rank_;
};

}  // namespace tess::detail
