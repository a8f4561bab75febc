// The part of a collection on one PE in a checkpoint, and its way back:
//
//     | n | incarnation, kind, [past load], length, index, state … |
//
// After a restart any PE reads these bytes and sends each element to the home of its index. The
// load of an element that was balanced waits there for the next balancer.
#include "runtime/arrays/typed/saving.hpp"

#include "runtime/arrays/collection_action.hpp"
#include "runtime/arrays/elements/balance_record.hpp"
#include "runtime/arrays/sections.hpp"
#include "runtime/core/error.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <exception>
#include <span>

namespace tess::detail {
namespace {

struct Saved {
  std::uint32_t incarnation = 0;
  SavedKind kind{};
  PastLoad load;
  Buffer bytes;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(incarnation, kind, load, bytes);
  }
};
void take(Collection& collection, const Saved& saved, Reader& ar) {
  const std::size_t n_before = collection.elements().size();
  collection.take_saved(saved.incarnation, saved.kind != SavedKind::destroyed, ar);
  // The element is the last one now, unless it is a member of a group that another one absorbed.
  if (saved.kind == SavedKind::balanced && collection.elements().size() > n_before)
    BalancedElements::make_record(*collection.elements().back()).past = saved.load;
}
void saved_arrives(Collection& collection, Saved&& saved) {
  Reader ar(std::span<const std::byte>(saved.bytes.data(), saved.bytes.size()));
  take(collection, saved, ar);
}

}  // namespace

void Collection::save(Writer& ar, const std::function<void()>& written) {
  Writer count{std::span<std::byte>()};
  ar(save_destroyed(count) + n_local());
  (void)save_destroyed(ar);
  for (Element* element : elements_) {
    ar(element->state_.version.incarnation);
    if (element->balance_)
      ar(SavedKind::balanced, element->balance_->to_save(pe_.measuring().start_meter()));
    else
      ar(SavedKind::alive);
    try {
      pack_framed(ar, [this, element](Writer& body) { save_element(*element, body); });
    } catch (const std::exception& error) {
      fail(ErrorCode::bad_value, element_text(*element), ": ", error.what());
    }
    written();
  }
}

void Collection::restore(Reader& ar) {
  for (auto n = ar.take<std::uint64_t>(); n > 0; --n) {
    Saved saved;
    ar(saved.incarnation, saved.kind);
    if (saved.kind == SavedKind::balanced) ar(saved.load);
    Reader body = ar.part(ar.take<std::uint64_t>());
    const PeId to = home_of_saved(body);  // the reader is a copy
    if (to == pe_.id()) {
      take(*this, saved, body);
    } else {
      saved.bytes.append(body.view(body.remaining()));
      send_to_collection<&saved_arrives, Traffic::migration>(*this, to, std::move(saved));
    }
  }
}

std::vector<SectionId> Collection::save_sections(Writer& ar) const {
  if (sections_ && sections_->lists()) return sections_->lists()->save(ar);
  ar(std::uint64_t{0});
  return {};
}

void Collection::section_had_ended(SectionId id) {
  sections().had_ended(id);
}

void Collection::describe_unsaved(std::vector<std::string>& lines) const {
  for (const Element* element : elements_)
    if (BalancedElements::waits(*element))
      lines.push_back(element_text(*element) + " waits at at_sync()");
}

}  // namespace tess::detail
