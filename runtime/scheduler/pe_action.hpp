// Messages from PE to PE that no chare sees: a function of (Pe&, Payload&&) by name, and its
// payload.
#pragma once

#include "runtime/scheduler/message.hpp"
#include "runtime/scheduler/pe.hpp"

namespace tess {

namespace detail {
template <class F>
struct PeHandler;
template <class P>
struct PeHandler<void (*)(Pe&, P&&)> {
  using Payload = P;
};
}  // namespace detail

/// The action that hands its payload to `Handler`.
template <auto Handler>
struct PeAction {
  using Payload = typename detail::PeHandler<decltype(Handler)>::Payload;
  using Held = Message<Payload>;

  static void run(Pe& pe, Envelope* envelope) {
    auto* message = static_cast<Held*>(envelope);
    Payload payload = std::move(message->payload);
    Held::destroy(envelope);
    Handler(pe, std::move(payload));
  }
  static inline const Action action{
      naming::value<Handler>(), &run, &Held::destroy, &Held::pack, &Held::unpack, Traffic::control};
};

/// Sends a payload to a handler on a PE; a hop of epoch 0, on no other epoch's account.
template <auto Handler>
void send_system(Pe& pe, PeId to, typename PeAction<Handler>::Payload payload) {
  using Held = Message<typename PeAction<Handler>::Payload>;
  pe.send(to, pe.stamp(Held::make(pe, PeAction<Handler>::action, std::move(payload))));
}

/// The same, outside of epoch 0, too: for what measures epoch 0, and for the end of the run.
template <auto Handler>
void send_uncounted(Pe& pe, PeId to, typename PeAction<Handler>::Payload payload) {
  using Held = Message<typename PeAction<Handler>::Payload>;
  pe.send_uncounted(to, pe.stamp(Held::make(pe, PeAction<Handler>::action, std::move(payload))));
}

}  // namespace tess
