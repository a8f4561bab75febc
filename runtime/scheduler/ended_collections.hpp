// Ids of collections, and which have ended on a PE. An id is never used again, and a message to an
// ended collection may come at any time later, so a PE never forgets: ids are kept as intervals of
// each creator's numbers, as many as there are collections that live between those that ended.
#pragma once

#include "runtime/base/interval_set.hpp"
#include "runtime/core/ids.hpp"

namespace tess {

/// What becomes of a message to a collection that has ended: it is dropped, and
enum class LateMessages : std::uint8_t {
  counted,  ///< counts as a dead letter
  ignored,  ///< nothing is said of it: a library's own collection
};

/// The numbers that a PE gives to the collections it creates: a row of each kind.
///
///     | 1 bit: ignored | 39 bits: how many of the kind before | 24 bits: the creator |
class CollectionNumbers {
 public:
  [[nodiscard]] CollectionId next(PeId creator, LateMessages late) {
    const bool ignored = late == LateMessages::ignored;
    return CollectionId{(ignored ? ignored_bit : 0) | ++n_made_[ignored ? 1 : 0] << 24U |
                        static_cast<std::uint64_t>(creator.value)};
  }
  [[nodiscard]] static LateMessages late_messages(CollectionId id) {
    return (id.value & ignored_bit) != 0 ? LateMessages::ignored : LateMessages::counted;
  }

 private:
  static constexpr std::uint64_t ignored_bit = std::uint64_t{1} << 63U;
  std::uint64_t n_made_[2] = {0, 0};
};

class EndedCollections {
 public:
  void add(CollectionId id) { ended_.insert(key(id)); }
  [[nodiscard]] bool contains(CollectionId id) const { return ended_.contains(key(id)); }

 private:
  /// The numbers of one creator and kind stand in a row.
  [[nodiscard]] static std::uint64_t key(CollectionId id) {
    return id.value << 40U | id.value >> 24U;
  }

  IntervalSet ended_;
};

}  // namespace tess
