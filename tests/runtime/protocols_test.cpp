// The protocol scenarios of apps/protocol_fuzz as tests: on the simulated machine over many seeds,
// and on the machine of threads. TESS_SEEDS chooses how many seeds (a sanitised build runs few).
#include "apps/protocol_fuzz/scenarios.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdlib>

namespace {

using tess::fuzz::Trial;

std::uint64_t n_seeds() {
  if (const char* given = std::getenv("TESS_SEEDS")) return std::strtoull(given, nullptr, 10);
#ifdef TESS_CHECKS_ALL
  return 30;
#else
  return 1000;
#endif
}

void run_seeds(std::string_view name,
               std::int32_t (*pes_of)(std::uint64_t) = &tess::fuzz::pes_of_seed,
               std::uint64_t most_seeds = ~std::uint64_t{0}) {
  const auto& scenario = tess::fuzz::scenario(name);
  const std::uint64_t n_trials = std::min(n_seeds(), most_seeds);
  std::uint64_t n_checks = 0;
  for (std::uint64_t seed = 0; seed < n_trials; ++seed) {
    const std::int32_t n_pes = pes_of(seed);
    Trial trial(seed, n_pes, Trial::On::simulated);
    scenario.run(trial);
    n_checks += trial.n_checks();
    if (trial.failures().empty()) continue;
    FAIL_CHECK("protocol_fuzz --scenario " << name << " --seeds " << seed << ":" << seed
                                           << " --pes " << n_pes << "\n"
                                           << trial.failures().front());
    return;
  }
  CHECK(tess::fuzz::too_few_checks(scenario, n_trials, n_checks) == "");
}

/// Each number of PEs from 2 to 8 in turn.
std::int32_t two_to_eight(std::uint64_t seed) {
  return 2 + static_cast<std::int32_t>(seed % 7);
}
/// Trees of PEs are four levels deep on 22 PEs and more.
std::int32_t one_to_forty(std::uint64_t seed) {
  return 1 + static_cast<std::int32_t>(seed % 40);
}

}  // namespace

TEST_CASE("an index that all PEs demand at once is created once", "[runtime][protocol]") {
  run_seeds("create_at_once");
}
TEST_CASE("elements begin where a map puts them", "[runtime][protocol]") {
  run_seeds("maps");
}
TEST_CASE("messages through an interface find elements of several classes", "[runtime][protocol]") {
  run_seeds("interfaces");
}
TEST_CASE("all means of control work in one program at the same time",
          "[runtime][protocol][checkpoint]") {
  run_seeds("all_at_once", &tess::fuzz::pes_of_seed, 300);
}
TEST_CASE("each wait at the balance barrier is resumed once", "[runtime][protocol][balance]") {
  run_seeds("balance_rounds");
}
TEST_CASE("no element passes the balance barrier before all have reached it",
          "[runtime][protocol][balance]") {
  run_seeds("balance_barrier");
}
TEST_CASE("rotate puts elements where it says, 40 rounds", "[runtime][protocol][balance]") {
  run_seeds("balance_rotate");
}
TEST_CASE("a load that is shown as known is that of a whole phase, from the first round on",
          "[runtime][protocol][balance]") {
  run_seeds("balance_first_round");
}
TEST_CASE("periodic balance rounds lose no message", "[runtime][protocol][balance]") {
  run_seeds("balance_periodic");
}
TEST_CASE("rounds between epochs leave elements to come and go", "[runtime][protocol][balance]") {
  run_seeds("balance_epochs");
}
TEST_CASE("a balance round waits for the elements that were created in awaited epochs",
          "[runtime][protocol][balance]") {
  run_seeds("balance_newcomers");
}
TEST_CASE("a message to an absent index waits for its element", "[runtime][protocol]") {
  run_seeds("message_first");
}
TEST_CASE("an index has one life at a time", "[runtime][protocol]") {
  run_seeds("lives");
}
TEST_CASE("every element meets every broadcast of its life once", "[runtime][protocol]") {
  run_seeds("broadcasts");
}
TEST_CASE("reductions are exact while elements move, come and go", "[runtime][protocol]") {
  run_seeds("rounds");
}
TEST_CASE("rounds that overlap are exact while elements are inserted", "[runtime][protocol]") {
  run_seeds("driven_rounds");
}
TEST_CASE("an element created after a result was awaited takes part in later rounds only",
          "[runtime][protocol]") {
  run_seeds("newborns", &two_to_eight);
}
TEST_CASE("an element created in the middle of a step is never one ahead or behind",
          "[runtime][protocol]") {
  run_seeds("refinement", &two_to_eight);
}
TEST_CASE("elements that reduce at once, of themselves and of others, get their own results",
          "[runtime][protocol]") {
  run_seeds("inner_rounds");
}
TEST_CASE("each member of a section meets each multicast once, and its reductions are exact",
          "[runtime][protocol][section]") {
  run_seeds("sections");
}
TEST_CASE("a section ends in mid-use, and later ones lack nothing", "[runtime][protocol]") {
  run_seeds("sections_end");
}
TEST_CASE("each element gets from a scan what stands before it, wherever elements go",
          "[runtime][protocol][scan]") {
  run_seeds("scans", &tess::fuzz::pes_of_seed, 300);
}
TEST_CASE("messages find an element that visits every PE", "[runtime][protocol]") {
  run_seeds("tour");
}
TEST_CASE("an epoch ends after all that it caused", "[runtime][protocol]") {
  run_seeds("epochs");
}
TEST_CASE("the run is not over while an epoch's report is due", "[runtime][protocol]") {
  run_seeds("pauses");
}
TEST_CASE("an epoch ends after the migrations that it caused", "[runtime][protocol]") {
  run_seeds("epoch_migrations");
}
TEST_CASE("exit in mid flood gives the greatest code and leaks nothing", "[runtime][protocol]") {
  run_seeds("flood_exit");
}
TEST_CASE("early messages migrate with their mailbox", "[runtime][protocol]") {
  run_seeds("mailboxes");
}
TEST_CASE("every timer runs once, and its epoch waits for it", "[runtime][protocol][timers]") {
  run_seeds("timers");
}
TEST_CASE("every ask gets its reply or its error", "[runtime][protocol][ask]") {
  run_seeds("asks");
}
TEST_CASE("coroutines give values over elements that move, are late, or on demand",
          "[runtime][protocol][ask]") {
  run_seeds("values");
}
TEST_CASE("an element that waits after destroy() lacks nothing until it is done",
          "[runtime][protocol]") {
  run_seeds("farewells");
}
TEST_CASE("values of every kind arrive as they were sent", "[runtime][protocol]") {
  run_seeds("payloads");
}
TEST_CASE("a flood is held back within the budget, and all of it arrives", "[runtime][protocol]") {
  run_seeds("floods");
}
TEST_CASE("messages that are ready on a PE run in the order of their priorities",
          "[runtime][protocol][priority]") {
  run_seeds("priorities");
}
TEST_CASE("the PEs of a process share one object of a process group", "[runtime][protocol]") {
  run_seeds("process_groups");
}
TEST_CASE("a deadlock reports what each wait is for", "[runtime][protocol]") {
  run_seeds("deadlocks");
}
TEST_CASE("an exception names the element, the entry method and the PE", "[runtime][protocol]") {
  run_seeds("exceptions");
}
TEST_CASE("messages to the dead are counted", "[runtime][protocol]") {
  run_seeds("dead_letters");
}
TEST_CASE("arrays that end in mid use leave nothing behind", "[runtime][protocol]") {
  run_seeds("destroyed");
}
TEST_CASE("what several PEs end at once has ended on all", "[runtime][protocol]") {
  run_seeds("ends_at_once", &one_to_forty, 300);
}
TEST_CASE("a constructor contributes to the first reduction of its element",
          "[runtime][protocol]") {
  run_seeds("constructors");
}
TEST_CASE("a group has one member on each PE", "[runtime][protocol]") {
  run_seeds("groups");
}

TEST_CASE("a scenario that checks too little does not pass", "[runtime][protocol]") {
  const tess::fuzz::Scenario ten{"ten", "makes ten checks in each trial", nullptr, 10};
  CHECK(tess::fuzz::too_few_checks(ten, 30, 300) == "");
  CHECK_THAT(tess::fuzz::too_few_checks(ten, 30, 299), Catch::Contains("ten checked 299"));
  CHECK(tess::fuzz::too_few_checks(ten, 3, 3) == "");
  CHECK(tess::fuzz::too_few_checks(ten, 3, 2) != "");
}

TEST_CASE("the scenarios hold on threads", "[runtime][protocol][threads]") {
  // Not the scenarios whose report depends on one order of events, and not balance_first_round,
  // whose loads are those of the simulated clock.
  for (const char* name : {"create_at_once",
                           "message_first",
                           "lives",
                           "broadcasts",
                           "rounds",
                           "driven_rounds",
                           "newborns",
                           "refinement",
                           "sections",
                           "sections_end",
                           "tour",
                           "epochs",
                           "epoch_migrations",
                           "flood_exit",
                           "mailboxes",
                           "destroyed",
                           "constructors",
                           "timers",
                           "asks",
                           "payloads",
                           "floods",
                           "groups",
                           "balance_rounds",
                           "balance_barrier",
                           "balance_rotate",
                           "balance_periodic",
                           "balance_epochs",
                           "priorities",
                           "process_groups",
                           "all_at_once",
                           "scans",
                           "ends_at_once",
                           "balance_newcomers",
                           "maps",
                           "interfaces",
                           "inner_rounds",
                           "values",
                           "farewells"}) {
    for (const std::int32_t n_pes : {1, 2, 4}) {
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Trial trial(seed, n_pes, Trial::On::threads);
        tess::fuzz::scenario(name).run(trial);
        INFO(name << " on " << n_pes << " PEs, seed " << seed);
        for (const std::string& failure : trial.failures()) FAIL_CHECK(failure);
        CHECK(trial.n_checks() > 0);
      }
    }
  }
}
