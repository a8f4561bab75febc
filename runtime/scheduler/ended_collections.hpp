// Which collections have ended on a PE. Their ids are never used again, and a message to one may
// come at any time later, so a PE never forgets: ids are kept as intervals of each creator's
// numbers, as many as there are collections that live between those that ended.
#pragma once

#include "runtime/base/interval_set.hpp"
#include "runtime/ids.hpp"

namespace tess {

/// What becomes of a message to a collection that has ended: it is dropped, and
enum class LateMessages : std::uint8_t {
  counted,  ///< counts as a dead letter
  ignored,  ///< nothing is said of it: a library's own collection
};

class EndedCollections {
 public:
  void add(CollectionId id, LateMessages late) {
    ended_.insert(key(id));
    if (late == LateMessages::ignored) ignored_.insert(key(id));
  }
  [[nodiscard]] bool contains(CollectionId id) const { return ended_.contains(key(id)); }
  /// Whether messages to it are dead letters.
  [[nodiscard]] bool counts(CollectionId id) const { return !ignored_.contains(key(id)); }

 private:
  /// An id holds its creator's count above the creator's PE (Pe::new_collection_id); the numbers of
  /// one creator are to stand in a row.
  [[nodiscard]] static std::uint64_t key(CollectionId id) {
    return id.value << 40U | id.value >> 24U;
  }

  IntervalSet ended_, ignored_;
};

}  // namespace tess
