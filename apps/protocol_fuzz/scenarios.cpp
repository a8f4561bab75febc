#include "apps/protocol_fuzz/scenarios.hpp"

#include <array>

namespace tess::fuzz {
namespace {

constexpr std::array known{
    Scenario{"create_at_once",
             "of all PEs that demand an index at once one creates it, and no message is lost",
             &create_at_once, 120},
    Scenario{"message_first",
             "a message to an absent index waits for its element, however it comes to be",
             &message_first, 150},
    Scenario{"lives",
             "create, insert, destroy and insert elsewhere: one life at a time, nothing lost",
             &lives, 100},
    Scenario{"broadcasts",
             "every element meets every broadcast of its life once, in one order, wherever it goes",
             &broadcasts, 50},
    Scenario{"rounds", "broadcast and reduction are exact while elements move, come and go",
             &rounds, 200},
    Scenario{"inner_rounds",
             "reduce() inside of elements, by many at once: each result is that of its question",
             &inner_rounds, 90, true},
    Scenario{"driven_rounds",
             "rounds that overlap, driven by another array, are exact while elements are inserted",
             &driven_rounds, 20, true},
    Scenario{"newborns",
             "an element created after a result was awaited takes part in later rounds only",
             &newborns, 250, true},
    Scenario{"refinement", "elements created in the middle of a step are never one ahead or behind",
             &refinement, 350, true},
    Scenario{"sections",
             "members meet each multicast once and in order, and section reductions are exact",
             &sections, 500},
    Scenario{"sections_end", "a section ends in mid-use, and later ones lack nothing",
             &sections_end, 1},
    Scenario{"scans", "each element gets what stands before it, while elements move, come and go",
             &scans, 100},
    Scenario{"maps", "elements begin where a map puts them, and are found wherever they go", &maps,
             10, true},
    Scenario{"interfaces",
             "a call through an interface reaches its element, and runs what its class overrides",
             &interfaces, 10, true},
    Scenario{"tour", "messages find an element that visits every PE", &tour, 100},
    Scenario{"epochs", "an epoch ends after all that it caused, and it ends", &epochs, 18},
    Scenario{"pauses", "the run is not over while an epoch's report is due", &pauses, 20},
    Scenario{"epoch_migrations", "an epoch ends after the migrations that it caused",
             &epoch_migrations, 40},
    Scenario{"flood_exit", "exit in mid flood: the greatest code, nothing leaks", &flood_exit, 250},
    Scenario{"mailboxes", "coroutines and early messages under migration", &mailboxes, 200},
    Scenario{"timers", "every timer runs once, not too early, and its epoch waits for it", &timers,
             20, true},
    Scenario{"asks",
             "every ask gets its reply or its error, also late, given up or of several at once",
             &asks, 1},
    Scenario{"values", "coroutines give values over elements that move, are late, or on demand",
             &values, 50, true},
    Scenario{
        "all_at_once",
        "replies, sections, scans, interfaces, priorities, timers and checkpoints in one program",
        &all_at_once, 400},
    Scenario{"payloads", "values of every kind arrive as they were sent", &payloads, 40},
    Scenario{"floods", "messages without credit wait, and no budget is too small", &floods, 1000},
    Scenario{"priorities", "messages that are ready on a PE run in the order of their priorities",
             &priorities, 40, true},
    Scenario{"process_groups", "one object per process: nothing that its PEs do to it is lost",
             &process_groups, 40, true},
    Scenario{"deadlocks", "a run that cannot continue reports what each wait is for", &deadlocks,
             4},
    Scenario{"exceptions", "an exception names element, entry method and PE", &exceptions, 3},
    Scenario{"dead_letters", "messages to destroyed elements are counted", &dead_letters, 2},
    Scenario{"destroyed",
             "arrays end in mid use: no message is lost unseen, and nothing of them is left",
             &destroyed, 40},
    Scenario{"farewells", "an element that waits after destroy() lacks nothing until it is done",
             &farewells, 50, true},
    Scenario{"ends_at_once", "what several PEs end at once, while it is created, has ended on all",
             &ends_at_once, 10, true},
    Scenario{"constructors",
             "constructors contribute and reach the balance barrier, once in an element's life",
             &constructors, 6},
    Scenario{"groups", "one member on each PE, broadcast and reduction over all", &groups, 100},
    Scenario{"balance_rounds",
             "each wait at the balance barrier is resumed once, while elements move, come and go",
             &balance_rounds, 35},
    Scenario{"balance_barrier",
             "no element passes the barrier before all have reached it, wherever they are",
             &balance_barrier, 80},
    Scenario{"balance_newcomers",
             "an element that is created in an awaited epoch is in the round that is open then",
             &balance_newcomers, 10},
    Scenario{"balance_rotate", "after each round elements are where it put them", &balance_rotate,
             300},
    Scenario{"balance_first_round",
             "a load that a strategy is shown as known is that of a whole phase",
             &balance_first_round, 20},
    Scenario{"balance_periodic", "rounds without a barrier lose no message", &balance_periodic, 3},
    Scenario{"balance_epochs",
             "rounds between epochs, while elements are created on demand and end", &balance_epochs,
             6},
};

}  // namespace

std::string too_few_checks(const Scenario& scenario, std::uint64_t n_trials,
                           std::uint64_t n_checks) {
  const std::uint64_t least = n_trials * (n_trials < many_seeds ? 1 : scenario.usual_checks);
  if (n_checks >= least) return {};
  return text("scenario ", scenario.name, " checked ", n_checks, " statements in ", n_trials,
              " trials; ", least, " or more are usual: does it still run its program?");
}

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
