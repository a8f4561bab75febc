#include "runtime/scheduler/completion_messages.hpp"

#include "runtime/scheduler/pe_action.hpp"
#include "runtime/scheduler/runtime.hpp"

namespace tess::detail {
namespace {

void report_arrives(Pe& pe, completion::Report&& m) {
  pe.completion().on_report(m);
}
void answer_arrives(Pe& pe, completion::Answer&& m) {
  pe.completion().on_answer(m);
}
void wave_arrives(Pe& pe, completion::Wave&& m) {
  pe.completion().on_wave(m);
}
void echo_arrives(Pe& pe, completion::Echo&& m) {
  pe.completion().on_echo(m);
}
void end_arrives(Pe& pe, completion::End&& m) {
  pe.completion().on_end(m);
}

template <auto Handler, class Payload>
void send_control(Pe& pe, PeId to, const Payload& payload) {
  if (payload.epoch.value == 0) {
    send_uncounted<Handler>(pe, to, payload);
  } else {
    send_system<Handler>(pe, to, payload);
  }
}

}  // namespace

void CompletionMessagesOfPe::send(PeId to, const completion::Report& report) {
  send_control<&report_arrives>(pe_, to, report);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Answer& answer) {
  send_control<&answer_arrives>(pe_, to, answer);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Wave& wave) {
  send_control<&wave_arrives>(pe_, to, wave);
}
void CompletionMessagesOfPe::send(PeId to, const completion::Echo& echo) {
  send_control<&echo_arrives>(pe_, to, echo);
}
void CompletionMessagesOfPe::send(PeId to, const completion::End& end) {
  send_control<&end_arrives>(pe_, to, end);
}
void CompletionMessagesOfPe::quiescent() {
  pe_.runtime().quiescent(pe_);
}

}  // namespace tess::detail
