// What a run reports while it goes on or when it cannot: what a PE runs, and the audit.
#include "runtime/core/check.hpp"
#include "runtime/pe/census.hpp"
#include "runtime/pe/report/pe_watch.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace tess::detail {
namespace {

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

bool Runtime::report_audit() {
  if (!options_.audit) return true;
  const AuditResult result =
      compare(census_.waits.audit, &name_of_action, [](PeId) { return true; });
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
