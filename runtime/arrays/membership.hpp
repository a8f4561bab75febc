// What an element keeps of the sections that it is a member of. It migrates with the element.
#pragma once

#include "runtime/arrays/broadcast_call.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/pe/completion/counted.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace tess::detail {

/// A section of an array; unique in the job.
struct SectionId {
  std::uint64_t value = 0;
  friend constexpr auto operator<=>(const SectionId&, const SectionId&) = default;
};

/// A multicast under way; its number is 0 until the section's root assigns it.
struct SectionCall {
  NumberedCall numbered;
  std::uint32_t led_by = 0;  ///< the broadcast of the array that led to it; 0: none
  template <class Ar>
  void serialize(Ar& ar) {
    ar(numbered, led_by);
  }
};

/// A multicast that waits on a PE.
struct WaitingCall {
  SectionCall call;
  Counted counted;
};

/// One element's part in one section.
struct Membership {
  SectionId section;
  std::uint32_t ordinal = 0;       ///< its place in the list that the section was made from
  std::uint32_t next = 0;          ///< the number of its next contribution
  std::uint64_t seen = 0;          ///< the number of the last multicast that it received
  std::vector<SectionCall> early;  ///< multicasts that arrived before their turn, counted as sent
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, ordinal, next, seen, early);
  }
};
using Memberships = std::vector<Membership>;

/// The element arrives where its array has ended: releases the epochs that wait for it.
void drop(Pe& pe, Memberships& memberships);

}  // namespace tess::detail
