// A message to an element by its index: it finds the element wherever it is, and may create it.
#pragma once

#include "runtime/collections/element.hpp"
#include "runtime/messages/envelope.hpp"

namespace tess {

/// What a message asks for if there is no element of its index.
enum class Demand : std::uint8_t {
  none,              ///< wait at home until somebody creates it
  here,              ///< create it, by its default constructor, on the PE that sent this
  home,              ///< create it, by its default constructor, on the home PE of the index
  insert,            ///< this is the constructor call; an element that exists already is misuse
  insert_if_absent,  ///< this is the constructor call; it does nothing if there is an element
};

template <class Index>
struct ElementMessage : Envelope {
  CollectionId collection{};
  Index index{};
  Version tried{};  ///< the latest version of the index's location that this was sent after
  PeId asker{};     ///< where `here` and `insert` create
  Demand demand = Demand::none;
  bool ask = false;  ///< the asker is to ask the home for leave to create
  std::uint8_t hops = 0;
  std::uint32_t led_by = 0;  ///< the broadcast of this array that led to it; 0: none
  /// If there is a receiver: it is here as long as the array has this many departures on this PE.
  std::uint32_t n_departures = 0;

  template <class Ar>
  void serialize_head(Ar& ar) {
    ar(collection, index, tried, asker, demand, ask, hops, led_by);
  }
};

/// An entry method, or a constructor, of a chare with that type of index.
template <class Index>
struct ElementAction : Action {
  /// Calls the entry method; moves the arguments out of the message.
  using Invoke = void (*)(Element&, ElementMessage<Index>&);
  /// Makes the element from the constructor's arguments; for insert demands alone.
  using Construct = Element* (*)(ElementMessage<Index>&);

  /// Traffic::user, or control for a message that the user did not send: it is no dead letter.
  ElementAction(std::string_view name, Run r, Destroy d, Pack p, Unpack u, Invoke i, Construct c,
                Traffic t)
      : Action(name, r, d, p, u, t), invoke(i), construct(c) {}

  /// How many dead messages a message of this kind is that does not meet its element.
  [[nodiscard]] std::uint64_t n_dead_letters() const { return traffic == Traffic::user ? 1 : 0; }

  Invoke invoke;
  Construct construct;
};

}  // namespace tess
