// Messages between PEs that do not involve chares: a handler function of (Pe&, Payload&&) or, if
// they count in their epoch, (Pe&, Payload&&, Counted); it is known by its name.
#pragma once

#include "runtime/pe/message.hpp"
#include "runtime/pe/pe.hpp"

namespace tess::detail {

/// The action that passes its payload to `Handler`.
template <auto Handler>
struct PeAction {
  using Of = HandlerType<decltype(Handler)>;
  using Payload = typename Of::Payload;
  using Held = Message<Payload>;

  static void run(Pe& pe, Envelope* envelope) {
    auto* message = static_cast<Held*>(envelope);
    Payload payload = std::move(message->payload);
    const EpochId epoch = envelope->epoch;
    Held::destroy(envelope);
    Of::template call<Handler>(pe, epoch, pe, std::move(payload));
  }
  static inline const Action action{naming::name_of<Handler>(),
                                    &run,
                                    destroy_of<Held>(),
                                    &Held::pack,
                                    &Held::unpack,
                                    Traffic::control};
};

/// The message that passes its payload to `Handler`.
template <auto Handler>
auto* make_message(Pe& pe, typename PeAction<Handler>::Payload payload) {
  return PeAction<Handler>::Held::make(pe, PeAction<Handler>::action, std::move(payload));
}

/// The same, ready to be sent in an epoch, in which it counts if the handler takes a Counted.
template <auto Handler>
auto* make_message_in(Pe& pe, EpochId epoch, typename PeAction<Handler>::Payload payload) {
  auto* message = pe.stamp(make_message<Handler>(pe, std::move(payload)));
  message->epoch = epoch;
  if constexpr (PeAction<Handler>::Of::counts) pe.count(*message);
  return message;
}

/// Sends a payload to a handler on a PE. It counts as a hop of epoch 0 and, if the handler takes a
/// Counted, in the current epoch.
template <auto Handler>
void send_system(Pe& pe, PeId to, typename PeAction<Handler>::Payload payload) {
  pe.send(to, make_message_in<Handler>(pe, pe.context().epoch, std::move(payload)));
}

/// The same, but not counted in epoch 0 either: for messages that measure epoch 0 or end the run.
template <auto Handler>
void send_uncounted(Pe& pe, PeId to, typename PeAction<Handler>::Payload payload) {
  pe.send_uncounted(to, pe.stamp(make_message<Handler>(pe, std::move(payload))));
}

/// A message for Machine::hand_in(), made by a thread that runs no PE. No epoch counts it.
template <auto Handler>
Envelope* make_outside(PeId to, typename PeAction<Handler>::Payload payload) {
  using Held = typename PeAction<Handler>::Held;
  auto* message = new (Pool::allocate(sizeof(Held), nullptr)) Held(std::move(payload));
  message->action = &PeAction<Handler>::action;
  message->source = to;
  message->target = to;
  message->counted = false;
  return message;
}

}  // namespace tess::detail
