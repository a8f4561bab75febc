#include "runtime/pe/completion_messages.hpp"

#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"

namespace tess::detail {
namespace {

template <class M>
void arrives(Pe& pe, M&& m) {
  pe.completion().on(m);
}

template <class M>
void send_control(Pe& pe, PeId to, const M& m) {
  if (m.epoch.value == 0) {
    send_uncounted<&arrives<M>>(pe, to, m);
  } else {
    send_system<&arrives<M>>(pe, to, m);
  }
}

}  // namespace

void CompletionMessagesOfPe::send(PeId to, const completion::Report& report) {
  send_control(pe_, to, report);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Answer& answer) {
  send_control(pe_, to, answer);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Wave& wave) {
  send_control(pe_, to, wave);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Echo& echo) {
  send_control(pe_, to, echo);
}
void CompletionMessagesOfPe::send(PeId to, const completion::End& end) {
  send_control(pe_, to, end);
}
void CompletionMessagesOfPe::quiescent() {
  pe_.runtime().quiescent(pe_);
}

}  // namespace tess::detail
