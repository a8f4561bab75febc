// What waits on a PE, for the reports of a deadlock, a hang and a signal: coroutines, collections,
// epochs and messages. Reads the state of the PE on its own thread and changes nothing.
#include "runtime/pe/pe.hpp"
#include "runtime/pe/queues/outbox.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/pe/tables/collection_table.hpp"
#include "runtime/watch/report/waiting.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {

Waits Pe::census(std::span<void* const> except) const {
  Waits waits;
  waits.audit = audit_rows();
  const ElementWords& words = runtime_.element_words();
  for (const Suspended* at = suspended_.first(); at != nullptr; at = at->after) {
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
    waits.add(WaitRank::coroutine, text(asker.text, " on ", id_, state.empty() ? "" : ", ", state,
                                        ": ", code, " waits for ", reason.text));
    for (NamedElement& asked : reason.asked) waits.add_need({asker, std::move(asked)});
  }
  std::vector<std::string> lines;
  for (const HostedCollection* collection : collection_table_->all())
    collection->describe_waiting(lines);
  for (std::string& line : lines) waits.add(WaitRank::collective, std::move(line));
  for (const Ending& one : ending_)
    waits.add(WaitRank::collective, text(one.collection->name(), " on ", id_,
                                         " was destroyed, but coroutines of its elements wait"));
  for (const auto& [id, n] : collection_table_->n_early())
    waits.add(WaitRank::message,
              text(n, n == 1 ? " message" : " messages", " on ", id_, n == 1 ? " waits" : " wait",
                   " for the array or group ", id.value,
                   ", which is not known there: is the proxy of an earlier run?"));
  lines.clear();
  completion_.describe_open(lines);
  for (std::string& line : lines) waits.add(WaitRank::epoch, std::move(line));
  return waits;
}

Waits Pe::census_of_running() const {
  Waits waits = census();
  std::size_t n_ready = 0;  // without those that end the run or ask for this census
  ready_.for_each(
      [&](const Link* one) { n_ready += static_cast<const Envelope*>(one)->counted ? 1U : 0U; });
  if (n_ready != 0)
    waits.add(WaitRank::queue,
              text(id_, n_ready == 1 ? ": 1 message is" : text(": ", n_ready, " messages are"),
                   " ready to run"));
  for (std::int32_t process = 0; process < machine_.n_processes(); ++process) {
    if (const std::size_t n = outbox_->n_waiting(ProcessId{process}); n != 0)
      waits.add(WaitRank::queue,
                text(id_, n == 1 ? ": 1 message waits" : text(": ", n, " messages wait"),
                     " for room to ", ProcessId{process}));
  }
  if (const std::size_t n = timers_.n_waiting(); n != 0)
    waits.add(WaitRank::queue,
              text(id_, n == 1 ? ": 1 timer is" : text(": ", n, " timers are"), " set"));
  return waits;
}

}  // namespace tess::detail
