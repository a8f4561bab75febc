// What the root of a section knows of its members, by ordinal: the PE each was last seen on, and
// whether the current lists have it. It decides nothing about messages: SectionLists sends them.
//
//     unjoined --seen--> joined, outside the lists --new_lists--> joined, listed
//         |                          |                                  |
//         +----------- gone ---------+---------------- gone ------------+
//
// An entry of the lists is stale once its member was seen elsewhere or is gone. So is the place of
// a member that the lists do not have.
#pragma once

#include "runtime/arrays/typed/array_of.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace tess::detail {

class SectionRoster {
 public:
  enum class State : std::uint8_t { unjoined, joined, gone };
  struct Member {
    Place place;
    State state = State::unjoined;
    bool listed = false;
    /// It gets multicasts as ordinary messages from the root.
    [[nodiscard]] bool outside() const { return state == State::joined && !listed; }
  };

  void create(std::size_t n_members);
  [[nodiscard]] bool created() const { return created_; }
  /// By ordinal; those that are gone keep their ordinals.
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  [[nodiscard]] std::size_t n_unjoined() const { return n_unjoined_; }
  [[nodiscard]] bool any_outside() const { return n_outside_ > 0; }

  /// A member was seen at a place. Returns true if it had not joined before.
  [[nodiscard]] bool seen(std::uint32_t ordinal, const Place& place);
  /// A member was destroyed. Returns true if it had not joined.
  [[nodiscard]] bool gone(std::uint32_t ordinal);

  /// The stale entries are at least a sixteenth of the members.
  [[nodiscard]] bool wants_lists() const;
  /// Lists the members that have joined, by the PE they were last seen on: ordinals, ascending.
  [[nodiscard]] std::map<PeId, std::vector<std::uint32_t>> new_lists();

 private:
  bool created_ = false;
  std::vector<Member> members_;
  std::size_t n_unjoined_ = 0, n_alive_ = 0, n_outside_ = 0;
  std::size_t n_stale_ = 0;  // changes since the lists were made
};

}  // namespace tess::detail
