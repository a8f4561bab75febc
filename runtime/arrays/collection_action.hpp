// Messages to a collection on a PE that do not involve chares: a handler function of (Collection
// type&, Payload&&) or, if they count in their epoch, (Collection type&, Payload&&, Counted). A
// message that arrives before its collection is known on the PE waits for it.
#pragma once

#include "runtime/arrays/collection.hpp"
#include "runtime/pe/message.hpp"

namespace tess::detail {

template <class P>
struct ToCollection {
  CollectionId collection;
  P payload;
  using GivesMembers = void;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collection, payload);
  }
};

template <auto Handler, Traffic Kind = Traffic::control>
struct CollectionAction {
  using Of = HandlerType<decltype(Handler)>;
  using Payload = typename Of::Payload;
  using Held = Message<ToCollection<Payload>>;

  static void run(Pe& pe, Envelope* envelope) {
    auto* message = static_cast<Held*>(envelope);
    Collection* collection = find_collection(pe, message->payload.collection);
    if (collection == nullptr) {
      pe.collections().keep_early(message->payload.collection, envelope, &drop);
      return;
    }
    Payload payload = std::move(message->payload.payload);
    const EpochId epoch = envelope->epoch;
    Held::destroy(envelope);
    Of::template call<Handler>(pe, epoch, static_cast<typename Of::Receiver&>(*collection),
                               std::move(payload));
  }
  /// The collection has ended. A payload may have more to do then, in the epoch of its message; it
  /// returns the number of user messages that are lost.
  static std::uint64_t drop(Pe& pe, Envelope& envelope) {
    const Counted counted(pe.completion(), Of::counts ? envelope.epoch : EpochId{});
    const Payload& payload = static_cast<Held&>(envelope).payload.payload;
    if constexpr (requires { payload.drop(pe); }) {
      return payload.drop(pe);
    } else {
      return 0;
    }
  }
  static std::int64_t priority_of(const Envelope& envelope)
    requires requires(const Payload& payload) { payload.priority(); }
  {
    return static_cast<const Held&>(envelope).payload.payload.priority();
  }
  static constexpr bool has_priority = requires(const Payload& payload) { payload.priority(); };
  static constexpr Action::PriorityOf priority_function() {
    if constexpr (has_priority) {
      return &CollectionAction::priority_of;
    } else {
      return nullptr;
    }
  }
  static constexpr Action::CarriedBy carried_function() {
    if constexpr (requires(const Payload& payload) { payload.carried(); }) {
      return [](const Envelope& envelope) -> const Action& {
        return static_cast<const Held&>(envelope).payload.payload.carried();
      };
    } else {
      return nullptr;
    }
  }
  static inline const Action action{naming::name_of<Handler>(),
                                    &run,
                                    destroy_of<Held>(),
                                    &Held::pack,
                                    &Held::unpack,
                                    Kind,
                                    priority_function(),
                                    carried_function()};
};

/// Sends a payload to the part of a collection on a PE, where it may not be known yet. It counts as
/// a hop of epoch 0 and, if the handler takes a Counted, in the current epoch.
template <auto Handler, Traffic Kind = Traffic::control>
void send_to_collection(Pe& pe, CollectionId id, PeId to,
                        typename CollectionAction<Handler, Kind>::Payload payload) {
  using A = CollectionAction<Handler, Kind>;
  auto* message =
      A::Held::make(pe, A::action, ToCollection<typename A::Payload>{id, std::move(payload)});
  if constexpr (A::has_priority) message->prioritised = message->payload.payload.priority() != 0;
  pe.stamp(message);
  if constexpr (A::Of::counts) pe.count(*message);
  pe.send(to, message);
}
template <auto Handler, Traffic Kind = Traffic::control>
void send_to_collection(Collection& collection, PeId to,
                        typename CollectionAction<Handler, Kind>::Payload payload) {
  send_to_collection<Handler, Kind>(collection.pe(), collection.id(), to, std::move(payload));
}

}  // namespace tess::detail
