// Ids of collections, and the collections that have ended on a PE. An id is never reused, and a
// message to an ended collection may arrive at any later time, so a PE never forgets one. The ended
// numbers of each creator are stored as intervals: there are as many as there are live collections
// between ended ones.
#pragma once

#include "runtime/base/interval_set.hpp"
#include "runtime/core/ids.hpp"

#include <array>
#include <cstdint>

namespace tess::detail {

/// What happens to a message to a collection that has ended: it is dropped, and
enum class LateMessages : std::uint8_t {
  counted,  ///< counted as a dead letter (a message that was never delivered)
  ignored,  ///< not reported: the collection belongs to a library
};

/// The numbers of the collections that a PE creates: one sequence of each kind.
///
///     | 1 bit: ignored | 39 bits: how many of this kind before | 24 bits: the creator |
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

  /// The numbers given so far: how many of each kind. A restart continues after them.
  using Made = std::array<std::uint64_t, 2>;
  [[nodiscard]] const Made& made() const { return n_made_; }
  void continue_after(const Made& made) { n_made_ = made; }

 private:
  static constexpr std::uint64_t ignored_bit = std::uint64_t{1} << 63U;
  Made n_made_{};
};

class EndedCollections {
 public:
  void add(CollectionId id) { ended_.insert(key(id)); }
  [[nodiscard]] bool contains(CollectionId id) const { return ended_.contains(key(id)); }

 private:
  /// The numbers of one creator and kind are consecutive.
  [[nodiscard]] static std::uint64_t key(CollectionId id) {
    return id.value << 40U | id.value >> 24U;
  }

  IntervalSet ended_;
};

}  // namespace tess::detail

namespace tess {

using detail::LateMessages;

}  // namespace tess
