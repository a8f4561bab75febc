// Messages between PEs that do not involve chares: a handler function of (Pe&, Payload&&), known by
// its name, and its payload.
#pragma once

#include "runtime/scheduler/message.hpp"
#include "runtime/scheduler/pe.hpp"

namespace tess::detail {

template <class F>
struct PeHandler;
template <class P>
struct PeHandler<void (*)(Pe&, P&&)> {
  using Payload = P;
};

/// The action that passes its payload to `Handler`.
template <auto Handler>
struct PeAction {
  using Payload = typename PeHandler<decltype(Handler)>::Payload;
  using Held = Message<Payload>;

  static void run(Pe& pe, Envelope* envelope) {
    auto* message = static_cast<Held*>(envelope);
    Payload payload = std::move(message->payload);
    Held::destroy(envelope);
    Handler(pe, std::move(payload));
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

/// Sends a payload to a handler on a PE. It counts as a hop of epoch 0 and for no other epoch.
template <auto Handler>
void send_system(Pe& pe, PeId to, typename PeAction<Handler>::Payload payload) {
  pe.send(to, pe.stamp(make_message<Handler>(pe, std::move(payload))));
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
