// A migrating element. Within a process the object itself travels (except with TESS_CHECKS=all);
// between processes its serialised state. The array sends it by ship() and receives it by
// take_in().
#pragma once

#include "runtime/arrays/typed/array_of.hpp"

#include <memory>
#include <type_traits>
#include <utility>

namespace tess::detail {

/// The action of arriving elements of one class, with what needs the class.
struct ArrivalAction : Action {
  template <class Index>
  ArrivalAction(naming::Name name, std::type_identity<Index> /*of*/, Collection::PackElement pack_,
                const CollectionKind& kind_)
      : Action(name, &Arrival<Index>::run, &Arrival<Index>::destroy, &Arrival<Index>::pack,
               &Arrival<Index>::unpack, Traffic::migration),
        pack_element(pack_),
        kind(kind_) {}

  Collection::PackElement pack_element;
  const CollectionKind& kind;
};

template <class Index>
struct Arrival final : Envelope {
  CollectionId collection{};
  PeId from{};
  TessIndexedElement<Index>* element = nullptr;
  Buffer state;  // the serialised state, once the object is gone
  Memberships memberships;

  static void run(Pe& pe, Envelope* envelope);
  static void destroy(Envelope* envelope);
  static void pack(Envelope& envelope, Writer& ar);
  static Envelope* unpack(Pe& pe, Reader& ar);
  /// Replaces the object by its bytes.
  void pack_state();
};

template <class Index>
void Arrival<Index>::run(Pe& pe, Envelope* envelope) {
  auto* arrival = static_cast<Arrival*>(envelope);
  Collection* collection = find_collection(pe, arrival->collection);
  if (collection == nullptr) {
    pe.collections().keep_early(arrival->collection, envelope, &ArrayOf<Index>::drop_arrival);
    return;
  }
  const Counted counted(pe.completion(), arrival->epoch);
  static_cast<ArrayOf<Index>*>(collection)->take_in(*arrival);
  destroy(envelope);
}

template <class Index>
void Arrival<Index>::destroy(Envelope* envelope) {
  auto* arrival = static_cast<Arrival*>(envelope);
  delete arrival->element;
  delete arrival;
}

template <class Index>
void Arrival<Index>::pack_state() {
  state = Collection::bytes_of(*element, static_cast<const ArrivalAction&>(*action).pack_element);
  delete std::exchange(element, nullptr);
}

template <class Index>
void Arrival<Index>::pack(Envelope& envelope, Writer& ar) {
  auto& arrival = static_cast<Arrival&>(envelope);
  if (arrival.element != nullptr) arrival.pack_state();
  ar(arrival.collection, arrival.from, arrival.state, arrival.memberships);
}

template <class Index>
Envelope* Arrival<Index>::unpack(Pe& /*pe*/, Reader& ar) {
  auto arrival = std::make_unique<Arrival>();
  ar(arrival->collection, arrival->from, arrival->state, arrival->memberships);
  return arrival.release();
}

// The usual types of indices are compiled once, in array_of.cpp.
extern template struct Arrival<Index1>;
extern template struct Arrival<Index2>;
extern template struct Arrival<Index3>;

}  // namespace tess::detail
