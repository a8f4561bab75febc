// What a run reports while it goes on or when it cannot: what a PE runs, the audit, and the watch
// of a simulated machine, which uses virtual time.
#include "runtime/core/check.hpp"
#include "runtime/pe/census.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/watch/report/pe_watch.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace tess::detail {
namespace {

/// PE 0 of a simulated machine compares the number of entry methods on all PEs with an earlier one.
struct VirtualTick {
  std::uint64_t n_entered = 0;
  std::int64_t since_ns = 0;  // when the number was first seen
  std::uint32_t n_late = 0;   // ticks since the report
};
void virtual_tick_arrives(Pe& pe, VirtualTick&& tick) {
  pe.runtime().on_virtual_tick(pe, tick.n_entered, tick.since_ns, tick.n_late);
}
void set_virtual_tick(Pe& pe, Time delay, const VirtualTick& tick) {
  auto* const message = make_message<&virtual_tick_arrives>(pe, tick);
  message->source = pe.id();
  message->counted = false;
  pe.post_after(delay, message);
}

/// A run that waits for ever would tick for ever: after the report the ticks become rarer, each
/// after twice the time of the last one, and after so many nothing is expected any more.
constexpr std::uint32_t most_late_ticks = 16;

std::string name_of_action(std::uint32_t id) {
  return plain_name(Registry::at(id).name());
}

/// A line for each difference; the last ones of many are left out.
std::string listed(const std::vector<std::string>& differences) {
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, differences.size()); ++i)
    list += "\n  " + differences[i];
  if (differences.size() > most) list += text("\n  … and ", differences.size() - most, " more");
  return list;
}

}  // namespace

std::string reply_key(CollectionId id, std::uint64_t index_hash) {
  return text(id.value, "/", index_hash);
}

std::string seconds_text(double seconds) {
  return fmt::format("{:.3g} s", seconds);
}

std::optional<Runtime::Running> Runtime::watched(PeId id) {
  std::optional<Running> running;
  PeWatch* const watch = pe(id).measuring().watch();
  if (watch == nullptr) return running;
  watch->look([&](const Element* element, const Action* action, double seconds) {
    const std::string where =
        element != nullptr
            ? text(element_words_.text(*element), " on ", id, " has been in ",
                   action != nullptr ? plain_name(action->name()) : std::string("an entry method"))
            : text("the main program on ", id, " has been running");
    running = Running{text(where, " for ", seconds_text(seconds)), seconds};
  });
  return running;
}

std::string Runtime::running_text(PeId id) {
  if (const std::optional<Running> running = watched(id)) return running->text;
  const Action* action = pe(id).running();
  return text("it runs ", action != nullptr ? plain_name(action->name()) : std::string("nothing"));
}

void Runtime::start_virtual_watch(Pe& pe) {
  set_virtual_tick(pe, options_.hang_report / 2, VirtualTick{});
}

void Runtime::on_virtual_tick(Pe& pe, std::uint64_t n_before, std::int64_t since_ns,
                              std::uint32_t n_late) {
  if (pe.stopped() || n_late == most_late_ticks) return;
  std::uint64_t n_entered = 0;
  for (const auto& one : pes_) n_entered += one->measuring().watch()->n_entered();
  const Time now = pe.now(), half = options_.hang_report / 2;
  if (n_entered != n_before) return set_virtual_tick(pe, half, {n_entered, now.count(), 0});
  const Time idle = now - Time(since_ns);
  if (idle < options_.hang_report) return set_virtual_tick(pe, half, {n_entered, since_ns, 0});
  if (n_late == 0) report_virtual_hang(now, idle);
  set_virtual_tick(pe, options_.hang_report * (1U << n_late), {n_entered, since_ns, n_late + 1});
}

void Runtime::report_virtual_hang(Time now, Time idle) {
  Waits waits;
  std::vector<AuditRow> rows;
  for (const auto& one : pes_) {
    waits.merge(census_of_running(*one));
    const std::vector<AuditRow> more = one->measuring().audit_rows();
    rows.insert(rows.end(), more.begin(), more.end());
    if (const Time until = one->now(); until > now && one->measuring().watch()->last() != nullptr)
      waits.add(WaitRank::handler,
                text(one->id(), " runs ", plain_name(one->measuring().watch()->last()->name()),
                     " for another ", seconds_text(seconds(until - now))));
  }
  error_line(text(hang_heading(idle),
                  waits.empty() ? "nothing waits" : list_of_waiting(std::move(waits)),
                  audit_text(rows, [](PeId) { return true; })));
}

std::string hang_heading(Time idle) {
  return text("tessera: hang: no entry method has begun on any PE for ",
              seconds_text(seconds(idle)), "; ");
}

bool Runtime::report_audit() {
  if (!options_.audit) return true;
  const AuditResult result = compare(census_.audit, &name_of_action, [](PeId) { return true; });
  if (result.differences.empty()) {
    error_line(text("tessera: audit: ", result.n_sent,
                    " messages between PEs, each of which arrived once"));
    return true;
  }
  error_line("tessera: audit: the run is over, but" + listed(result.differences));
  return false;
}

std::string Runtime::audit_text(const std::vector<AuditRow>& rows,
                                const std::function<bool(PeId)>& answered) const {
  if (!options_.audit) return {};
  const AuditResult result = compare(rows, &name_of_action, answered);
  if (result.differences.empty())
    return text("\n  audit: each of ", result.n_sent, " messages between PEs has arrived once");
  return "\n  audit (a message may also be under way):" + listed(result.differences);
}

}  // namespace tess::detail
