// Contributions to one reduction that have met on a PE: their merged value, their number, and the
// epochs that wait for them.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/reduce/partial.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace tess::detail {

class Completion;

/// Contributions in one epoch: the epoch is not done while they are under way.
struct EpochShare {
  EpochId epoch;
  std::uint64_t n = 0;
};
/// Counts the contributions as processed in their epochs.
void settle(Completion& completion, const std::vector<EpochShare>& shares);

struct Gathered {
  std::uint64_t n = 0;
  PartialBox value;
  std::vector<EpochShare> shares;
  const PartialKind* kind = nullptr;  ///< of the value, once something was merged here

  /// Adds a contribution, which counts as sent until settle(); a value of another kind is misuse.
  void add(Completion& completion, EpochId epoch, std::unique_ptr<Partial> more);
  /// Merges more contributions.
  void merge(Gathered&& more);
  /// True if a contribution of this kind and epoch can be added in place.
  [[nodiscard]] bool takes(const PartialKind& other, EpochId epoch) const {
    return value.held && kind == &other && shares.front().epoch == epoch;
  }
  /// The epoch in which the complete result is sent: that of all contributions, if it is one.
  [[nodiscard]] EpochId epoch() const {
    return shares.size() == 1 ? shares.front().epoch : EpochId{};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n, value, shares);
  }

 private:
  void merge_value(std::unique_ptr<Partial> more);
  void merge_share(const EpochShare& more);
};

}  // namespace tess::detail
