// Coroutines, collections, epochs and messages. Reads the state of the PE on its own thread and
// changes nothing.
#include "runtime/pe/census.hpp"

#include "runtime/pe/pe.hpp"
#include "runtime/pe/queues/outbox.hpp"
#include "runtime/pe/report/waiting.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {

Waits census(Pe& pe, std::span<void* const> except) {
  Waits waits;
  waits.audit = pe.measuring().audit_rows();
  const ElementWords& words = pe.runtime().element_words();
  for (const Suspended* at = pe.suspended().first(); at != nullptr; at = at->after) {
    const Suspended& one = *at;
    if (std::find(except.begin(), except.end(), one.frame) != except.end()) continue;
    NamedElement asker{"main", "the main program"};
    std::string state, code = "run()";
    if (one.element != nullptr) {
      asker = {words.key(*one.element), words.text(*one.element)};
      state = words.state(*one.element);
      if (one.action != nullptr) code = plain_name(one.action->name());
    }
    WaitReason reason = one.waits_for();
    waits.add(WaitRank::coroutine, text(asker.text, " on ", pe.id(), state.empty() ? "" : ", ",
                                        state, ": ", code, " waits for ", reason.text));
    for (NamedElement& asked : reason.asked) waits.add_need({asker, std::move(asked)});
  }
  pe.collections().add_waiting(waits);
  std::vector<std::string> lines;
  pe.completion().describe_open(lines);
  for (std::string& line : lines) waits.add(WaitRank::epoch, std::move(line));
  return waits;
}

Waits census_of_running(Pe& pe) {
  Waits waits = census(pe);
  std::size_t n_ready = 0;  // without those that end the run or ask for this census
  pe.ready().for_each(
      [&](const Link* one) { n_ready += static_cast<const Envelope*>(one)->counted ? 1U : 0U; });
  if (n_ready != 0)
    waits.add(WaitRank::queue,
              text(pe.id(), n_ready == 1 ? ": 1 message is" : text(": ", n_ready, " messages are"),
                   " ready to run"));
  for (std::int32_t process = 0; process < pe.machine().n_processes(); ++process) {
    if (const std::size_t n = pe.peers().outbox().n_waiting(ProcessId{process}); n != 0)
      waits.add(WaitRank::queue,
                text(pe.id(), n == 1 ? ": 1 message waits" : text(": ", n, " messages wait"),
                     " for room to ", ProcessId{process}));
  }
  if (const std::size_t n = pe.timers().n_waiting(); n != 0)
    waits.add(WaitRank::queue,
              text(pe.id(), n == 1 ? ": 1 timer is" : text(": ", n, " timers are"), " set"));
  return waits;
}

}  // namespace tess::detail
