// One generation of a section's lists on one PE: the members that the PE delivers multicasts to,
// and the children in the tree of PEs that it passes them on to. It stays until all its multicasts
// are delivered here. Multicasts, Setup and Retire arrive in any order.
#pragma once

#include "runtime/arrays/sections.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

/// A member on the list of a PE.
template <class Index>
struct SectionEntry {
  std::uint32_t ordinal = 0;
  Index index{};
  template <class Ar>
  void serialize(Ar& ar) {
    ar(ordinal, index);
  }
};

template <class Index>
struct SectionGeneration {
  using Entry = SectionEntry<Index>;

  bool known = false;          // Setup has arrived
  std::vector<Entry> entries;  // ordinals ascending
  std::vector<PeId> children;
  std::uint64_t n_done = 0;
  bool retired = false;
  std::uint64_t n_calls = 0;       // once retired
  std::vector<WaitingCall> early;  // multicasts that arrived before Setup

  [[nodiscard]] bool finished() const { return known && retired && n_done == n_calls; }
  [[nodiscard]] std::vector<std::uint32_t> ordinals() const {
    std::vector<std::uint32_t> all;
    all.reserve(entries.size());
    for (const Entry& entry : entries) all.push_back(entry.ordinal);
    return all;
  }
};

}  // namespace tess::detail
