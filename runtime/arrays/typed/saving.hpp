// The elements of an array in a checkpoint, as far as they depend on the type of index; saving.cpp
// has the rest. The home of an index also saves that its last element was destroyed.
//
// After a restart an element begins as an initial element does: it has received no broadcast and
// joins the first reduction. All elements of an array begin so, and nothing is under way at a
// checkpoint, so the numbers agree on all PEs.
#pragma once

#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/section_lists.hpp"
#include "runtime/wire/messages/read_all.hpp"

namespace tess::detail {

/// `balanced`: an element with the load that it had.
enum class SavedKind : std::uint8_t { destroyed, alive, balanced };

template <class Index>
std::uint64_t ArrayOf<Index>::save_destroyed(Writer& ar) const {
  std::uint64_t n = 0;
  table_.for_each([&](const Index& index, const Record& record) {
    if (record.state() != IndexState::destroyed) return;
    ar(record.version().incarnation, SavedKind::destroyed);
    pack_framed(ar, [&index](Writer& body) { body(index); });
    ++n;
  });
  return n;
}

template <class Index>
void ArrayOf<Index>::restore_sections(Reader& ar) {
  SectionListsOf<Index>::of(*this).restore(ar);
}

template <class Index>
void ArrayOf<Index>::restore_destroyed(const Index& index, std::uint32_t incarnation) {
  table_.at(index).set(IndexState::destroyed, pe_.id(), Version{incarnation, 1});
}

template <class Index>
void ArrayOf<Index>::add_restored(Indexed& element, std::uint32_t incarnation) {
  element.state_.version = Version{incarnation, 1};
  register_new(element);
  table_.at(element.index_).set_here(element);
  list(element);
  reroute(unpark(element.index_, Parked::waiting));  // of sections that were restored before
}

}  // namespace tess::detail
