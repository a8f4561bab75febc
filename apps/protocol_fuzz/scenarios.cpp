#include "apps/protocol_fuzz/scenarios.hpp"

#include <array>

namespace tess::fuzz {
namespace {

constexpr std::array known{
    Scenario{"create_at_once",
             "of all PEs that demand an index at once one creates it, and no message is lost",
             &create_at_once},
    Scenario{"message_first",
             "a message to an absent index waits for its element, however it comes to be",
             &message_first},
    Scenario{"lives",
             "create, insert, destroy and insert elsewhere: one life at a time, nothing lost",
             &lives},
    Scenario{"broadcasts",
             "every element meets every broadcast of its life once, in one order, wherever it goes",
             &broadcasts},
    Scenario{"rounds", "broadcast and reduction are exact while elements move, come and go",
             &rounds},
    Scenario{"newborns",
             "an element created after a result was awaited takes part in later rounds only",
             &newborns, true},
    Scenario{"refinement", "elements created in the middle of a step are never one ahead or behind",
             &refinement, true},
    Scenario{"tour", "messages find an element that visits every PE", &tour},
    Scenario{"epochs", "an epoch ends after all that it caused, and it ends", &epochs},
    Scenario{"pauses", "the run is not over while an epoch's report is due", &pauses},
    Scenario{"epoch_migrations", "an epoch ends after the migrations that it caused",
             &epoch_migrations},
    Scenario{"flood_exit", "exit in mid flood: the greatest code, nothing leaks", &flood_exit},
    Scenario{"mailboxes", "coroutines and early messages under migration", &mailboxes},
    Scenario{"payloads", "values of every kind arrive as they were sent", &payloads},
    Scenario{"floods", "messages without credit wait, and no budget is too small", &floods},
    Scenario{"deadlocks", "a run that cannot continue reports what each wait is for", &deadlocks},
    Scenario{"exceptions", "an exception names element, entry method and PE", &exceptions},
    Scenario{"dead_letters", "messages to destroyed elements are counted", &dead_letters},
    Scenario{"destroyed",
             "arrays end in mid use: no message is lost unseen, and nothing of them is left",
             &destroyed},
    Scenario{"constructors",
             "constructors contribute and reach the balance barrier, once in an element's life",
             &constructors},
    Scenario{"groups", "one member on each PE, broadcast and reduction over all", &groups},
    Scenario{"balance_rounds",
             "each wait at the balance barrier is resumed once, while elements move, come and go",
             &balance_rounds},
    Scenario{"balance_barrier",
             "no element passes the barrier before all have reached it, wherever they are",
             &balance_barrier},
    Scenario{"balance_rotate", "after each round elements are where it put them", &balance_rotate},
    Scenario{"balance_first_round",
             "a load that a strategy is shown as known is that of a whole phase",
             &balance_first_round},
    Scenario{"balance_periodic", "rounds without a barrier lose no message", &balance_periodic},
    Scenario{"balance_epochs",
             "rounds between epochs, while elements are created on demand and end",
             &balance_epochs},
};

}  // namespace

std::span<const Scenario> scenarios() {
  return known;
}

const Scenario& scenario(std::string_view name) {
  std::string names;
  for (const Scenario& one : known) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  fail(ErrorCode::bad_argument, "there is no scenario ", name, " (", names, ")");
}

}  // namespace tess::fuzz
