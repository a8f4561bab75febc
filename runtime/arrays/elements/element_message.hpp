// A message to an element, addressed by its index: it finds the element on any PE and may create
// it.
#pragma once

#include "runtime/arrays/elements/element.hpp"
#include "runtime/core/index.hpp"
#include "runtime/pe/block.hpp"
#include "runtime/wire/messages/entry_attributes.hpp"
#include "runtime/wire/messages/envelope.hpp"

namespace tess::detail {

template <class Index>
struct ElementMessage : Envelope {
  CollectionId collection{};
  Index index{};
  Version tried{};  ///< the latest location version that the message was sent after
  PeId asker{};     ///< the PE that creates the element for `here` and `insert`
  Demand demand = Demand::none;
  bool ask = false;  ///< the asker must ask the home for permission to create
  std::uint8_t hops = 0;
  /// The broadcast of this array that led to the message; 0: none. In a constructor call: one past
  /// the round in which the element joins; 0: none is named.
  std::uint32_t led_by = 0;
  /// If there is a receiver: it is here as long as the array's number of departures on this PE has
  /// this value.
  std::uint32_t n_departures = 0;

  template <class Ar>
  void serialize_head(Ar& ar);
};

template <class Index>
template <class Ar>
void ElementMessage<Index>::serialize_head(Ar& ar) {
  ar(collection, index, tried, asker, demand, ask, hops, led_by);
}

// The usual types of indices are compiled once, in array_of.cpp.
extern template void ElementMessage<Index1>::serialize_head(Writer&);
extern template void ElementMessage<Index1>::serialize_head(Reader&);
extern template void ElementMessage<Index2>::serialize_head(Writer&);
extern template void ElementMessage<Index2>::serialize_head(Reader&);
extern template void ElementMessage<Index3>::serialize_head(Writer&);
extern template void ElementMessage<Index3>::serialize_head(Reader&);

/// Messages of this type may be prioritised.
template <class Message>
concept HasPriority = requires(const Envelope& message) { Message::priority_of(message); };

/// The action for an entry method or a constructor of a chare with this type of index.
template <class Index>
struct ElementAction : Action {
  /// Calls the entry method; moves the arguments out of the message.
  using Invoke = void (*)(Element&, ElementMessage<Index>&);
  /// Constructs the element from the constructor's arguments; only for insert demands.
  using Construct = Element* (*)(ElementMessage<Index>&);
  /// The message will never be delivered, since its element or the array was destroyed. Such a
  /// message is no dead letter.
  using Undelivered = void (*)(Pe&, ElementMessage<Index>&);
  /// True if the message has lost its purpose: then it does not wait for its element.
  using Unwanted = bool (*)(Collection&, const ElementMessage<Index>&);

  /// The action of `Message`. `traffic` is user, or control for a message that the user did not
  /// send and that is no dead letter. (A constructor, and no function that returns the action:
  /// where a program never names `Message::entry`, g++ 12 would register a temporary instead.)
  template <class Message>
  explicit ElementAction(std::type_identity<Message> /*of*/, Invoke i, Construct c = nullptr,
                         Traffic t = Traffic::user, Undelivered u = nullptr, Unwanted w = nullptr)
      : Action(naming::name_of<Message>(), Message::run, destroy_of<Message>(), &Message::pack,
               &Message::unpack, t, priority_function<Message>()),
        invoke(i),
        construct(c),
        undelivered(u),
        unwanted(w) {}

  /// The number of dead letters (0 or 1) for a message of this kind that is not delivered.
  [[nodiscard]] std::uint64_t n_dead_letters() const {
    return traffic == Traffic::user && undelivered == nullptr ? 1 : 0;
  }

  Invoke invoke;
  Construct construct;
  Undelivered undelivered;
  Unwanted unwanted;

 private:
  template <class Message>
  static Action::PriorityOf priority_function() {
    if constexpr (HasPriority<Message>) {
      return &Message::priority_of;
    } else {
      return nullptr;
    }
  }
};

}  // namespace tess::detail
