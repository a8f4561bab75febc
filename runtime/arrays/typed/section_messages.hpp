// The messages by which the PEs of a section keep its lists: from any PE to the root (Create,
// Start), from the root down the tree of PEs (Setup, Multicast, Retire), from members' PEs to the
// root (Seen, Lost), and what an element gets (Join, Token). SectionLists sends and receives them.
#pragma once

#include "runtime/arrays/membership.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/section_generation.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

template <class Index>
struct SectionCreate {
  SectionId section;
  std::vector<Index> indices;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, indices);
  }
};
struct SectionStart {
  SectionId section;
  SectionCall call;
  [[nodiscard]] std::int64_t priority() const { return call.numbered.priority(); }
  [[nodiscard]] const Action& carried() const { return call.numbered.carried(); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, call);
  }
  std::uint64_t drop(Pe& pe) const { return call.numbered.drop(pe); }
};

/// The members that a PE delivers to.
template <class Index>
struct SectionPeList {
  PeId pe;
  std::vector<SectionEntry<Index>> entries;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(pe, entries);
  }
};
template <class Index>
struct SectionSetup {
  SectionId section;
  std::uint64_t generation = 0;
  std::vector<SectionPeList<Index>> subtree;  // the first is the receiver's
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, generation, subtree);
  }
};
struct SectionMulticast {
  SectionId section;
  std::uint64_t generation = 0;
  SectionCall call;
  [[nodiscard]] std::int64_t priority() const { return call.numbered.priority(); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, generation, call);
  }
  std::uint64_t drop(Pe& pe) const { return call.numbered.drop(pe); }
};
struct SectionRetire {
  SectionId section;
  std::uint64_t generation = 0;
  std::uint64_t n_calls = 0;
};

/// A member was seen on a PE: it has joined there, or an ordinary message met it there.
struct SectionSeen {
  SectionId section;
  std::uint32_t ordinal = 0;
  Place place;
};
/// There is no element of this index; it was destroyed before it could join.
struct SectionLost {
  SectionId section;
  std::uint32_t ordinal = 0;
};

struct SectionJoin {
  SectionId section;
  std::uint32_t ordinal = 0;
};
struct SectionToken {
  SectionId section;
  SectionCall call;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, call);
  }
};

}  // namespace tess::detail
