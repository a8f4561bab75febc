// The tree over all PEs that broadcasts, reductions and waves go along: any PE can be its root,
// each has up to four children. A pure function of the number of PEs and the root, so that all
// agree.
#pragma once

#include "runtime/ids.hpp"

#include <vector>

namespace tess {

class SpanningTree {
 public:
  /// As seen from `self`; PEs are 0 … n_pes - 1.
  SpanningTree(PeId self, PeId root, std::int32_t n_pes)
      : root_(root.value), n_pes_(n_pes), rank_((self.value - root.value + n_pes) % n_pes) {}

  /// The next PE towards the root; not asked of the root itself.
  [[nodiscard]] PeId parent() const { return at((rank_ - 1) / fan_out); }

  [[nodiscard]] std::vector<PeId> children() const {
    std::vector<PeId> out;
    for (std::int64_t k = 1; k <= fan_out; ++k) {
      const std::int64_t child = std::int64_t{rank_} * fan_out + k;
      if (child < n_pes_) out.push_back(at(child));
    }
    return out;
  }

 private:
  static constexpr std::int32_t fan_out = 4;
  [[nodiscard]] PeId at(std::int64_t rank) const {
    return PeId{static_cast<std::int32_t>((rank + root_) % n_pes_)};
  }

  std::int32_t root_, n_pes_, rank_;
};

}  // namespace tess
