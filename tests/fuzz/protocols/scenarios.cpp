#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>

namespace tess::fuzz {
namespace {

constexpr std::array all_scenarios{
    Scenario{"create_at_once",
             "of all PEs that demand an index at once one creates it, and no message is lost",
             &create_at_once, 120, On::threads},
    Scenario{"message_first",
             "a message to an absent index waits for its element, however it comes to be",
             &message_first, 150, On::threads},
    Scenario{"create_and_destroy",
             "an index has one element at a time while it is created, inserted and destroyed",
             &create_and_destroy, 100, On::threads},
    Scenario{"broadcasts",
             "every element meets every broadcast of its life once, in one order, wherever it goes",
             &broadcasts, 50, On::threads},
    Scenario{"rounds", "broadcast and reduction are exact while elements move, come and go",
             &rounds, 200, On::threads},
    Scenario{"inner_rounds",
             "reduce() inside of elements, by many at once: each result is that of its question",
             &inner_rounds, 90, On::job},
    Scenario{"driven_rounds",
             "rounds that overlap, driven by another array, are exact while elements are inserted",
             &driven_rounds, 20, On::job},
    Scenario{"created_after_results",
             "an element created after a result was awaited takes part in later rounds only",
             &created_after_results, 250, On::job, Pes::two_to_eight},
    Scenario{"created_in_steps",
             "elements created in the middle of a step are never one ahead or behind",
             &created_in_steps, 350, On::job, Pes::two_to_eight},
    Scenario{"sections",
             "members meet each multicast once and in order, and section reductions are exact",
             &sections, 500, On::threads},
    Scenario{"sections_end", "a section ends in mid-use, and later ones lack nothing",
             &sections_end, 1, On::threads},
    Scenario{"scans", "each element gets what stands before it, while elements move, come and go",
             &scans, 100, On::threads, Pes::usual, true},
    Scenario{"maps", "elements begin where a map puts them, and are found wherever they go", &maps,
             10, On::job},
    Scenario{"interfaces",
             "a call through an interface reaches its element, and runs what its class overrides",
             &interfaces, 10, On::job},
    Scenario{"visits_all_pes", "messages find an element that visits every PE", &visits_all_pes,
             100, On::threads},
    Scenario{"epochs", "an epoch ends after all that it caused, and it ends", &epochs, 18,
             On::threads},
    Scenario{"idle_reports", "the run is not over while an epoch's report is due", &idle_reports,
             20, On::simulated},
    Scenario{"epoch_migrations", "an epoch ends after the migrations that it caused",
             &epoch_migrations, 40, On::threads},
    Scenario{"exit_under_load", "exit while messages flow: the greatest code, nothing leaks",
             &exit_under_load, 250, On::threads},
    Scenario{"mailboxes", "coroutines and early messages under migration", &mailboxes, 200,
             On::threads},
    Scenario{"timers", "every timer runs once, not too early, and its epoch waits for it", &timers,
             20, On::job},
    Scenario{"asks",
             "every ask gets its reply or its error, also late, given up or of several at once",
             &asks, 1, On::threads},
    Scenario{"values", "coroutines give values over elements that move, are late, or on demand",
             &values, 50, On::job},
    Scenario{
        "all_at_once",
        "replies, sections, scans, interfaces, priorities, timers and checkpoints in one program",
        &all_at_once, 400, On::threads, Pes::usual, true},
    Scenario{"payloads", "values of every kind arrive as they were sent", &payloads, 40,
             On::threads},
    Scenario{"flow_control", "messages without credit wait, and no budget is too small",
             &flow_control, 1000, On::threads},
    Scenario{"priorities", "messages that are ready on a PE run in the order of their priorities",
             &priorities, 40, On::job},
    Scenario{"process_groups", "one object per process: nothing that its PEs do to it is lost",
             &process_groups, 40, On::job},
    Scenario{"deadlocks", "a run that cannot continue reports what each wait is for", &deadlocks, 4,
             On::simulated},
    Scenario{"exceptions", "an exception names element, entry method and PE", &exceptions, 3,
             On::simulated},
    Scenario{"undelivered_messages", "messages to destroyed elements are counted",
             &undelivered_messages, 2, On::simulated},
    Scenario{"destroyed",
             "arrays end in mid use: no message is lost unseen, and nothing of them is left",
             &destroyed, 40, On::threads},
    Scenario{"waits_after_destroy",
             "an element that waits after destroy() lacks nothing until it is done",
             &waits_after_destroy, 50, On::job},
    Scenario{"ends_at_once", "what several PEs end at once, while it is created, has ended on all",
             &ends_at_once, 10, On::job, Pes::one_to_forty, true},
    Scenario{"constructors",
             "constructors contribute and reach the balance barrier, once in an element's life",
             &constructors, 6, On::threads},
    Scenario{"groups", "one member on each PE, broadcast and reduction over all", &groups, 100,
             On::threads},
    Scenario{"balance_rounds",
             "each wait at the balance barrier is resumed once, while elements move, come and go",
             &balance_rounds, 35, On::threads},
    Scenario{"balance_barrier",
             "no element passes the barrier before all have reached it, wherever they are",
             &balance_barrier, 80, On::threads},
    Scenario{"balance_created_in_epochs",
             "an element that is created in an awaited epoch is in the round that is open then",
             &balance_created_in_epochs, 10, On::threads},
    Scenario{"balance_rotate", "after each round elements are where it put them", &balance_rotate,
             300, On::threads},
    Scenario{"balance_first_round",
             "a load that a strategy is shown as all is that of a whole phase",
             &balance_first_round, 20, On::simulated},
    Scenario{"balance_periodic", "rounds without a barrier lose no message", &balance_periodic, 3,
             On::threads},
    Scenario{"balance_epochs",
             "rounds between epochs, while elements are created on demand and end", &balance_epochs,
             6, On::threads},
};

}  // namespace

std::span<const Scenario> scenarios() {
  return all_scenarios;
}

const Scenario& scenario(std::string_view name) {
  std::string names;
  for (const Scenario& one : all_scenarios) {
    if (one.name == name) return one;
    names += (names.empty() ? "" : ", ") + std::string(one.name);
  }
  fail(ErrorCode::bad_argument, "there is no scenario ", name, " (", names, ")");
}

}  // namespace tess::fuzz
