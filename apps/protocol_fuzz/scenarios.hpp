// The protocol scenarios. Each runs a program that stresses one part of the runtime, with a
// delivery order that the trial's seed draws, and compares the outcome with an oracle. Used by the
// program protocol_fuzz and by the tests.
#pragma once

#include "apps/protocol_fuzz/trial.hpp"

#include <span>
#include <string>
#include <string_view>

namespace tess::fuzz {

void create_at_once(Trial& trial);       // elements/create.cpp
void message_first(Trial& trial);        // elements/create.cpp
void lives(Trial& trial);                // elements/lives.cpp
void broadcasts(Trial& trial);           // collectives/broadcasts.cpp
void constructors(Trial& trial);         // elements/constructors.cpp
void rounds(Trial& trial);               // collectives/rounds.cpp
void inner_rounds(Trial& trial);         // collectives/inner_rounds.cpp
void driven_rounds(Trial& trial);        // collectives/driven_rounds.cpp
void newborns(Trial& trial);             // elements/newborns.cpp
void refinement(Trial& trial);           // elements/newborns.cpp
void sections(Trial& trial);             // collectives/sections.cpp
void sections_end(Trial& trial);         // collectives/sections_end.cpp
void scans(Trial& trial);                // collectives/scans.cpp
void maps(Trial& trial);                 // elements/maps.cpp
void interfaces(Trial& trial);           // elements/interfaces.cpp
void tour(Trial& trial);                 // elements/tour.cpp
void epochs(Trial& trial);               // completion/epochs.cpp
void pauses(Trial& trial);               // completion/pauses.cpp
void epoch_migrations(Trial& trial);     // completion/epoch_migrations.cpp
void flood_exit(Trial& trial);           // completion/exits.cpp
void mailboxes(Trial& trial);            // messages/mailboxes.cpp
void asks(Trial& trial);                 // messages/asks.cpp
void values(Trial& trial);               // messages/values.cpp
void all_at_once(Trial& trial);          // all_at_once.cpp
void timers(Trial& trial);               // messages/timers.cpp
void payloads(Trial& trial);             // messages/payloads.cpp
void floods(Trial& trial);               // messages/floods.cpp
void priorities(Trial& trial);           // messages/priorities.cpp
void process_groups(Trial& trial);       // collectives/process_groups.cpp
void deadlocks(Trial& trial);            // completion/ends.cpp
void exceptions(Trial& trial);           // completion/ends.cpp
void dead_letters(Trial& trial);         // completion/ends.cpp
void destroyed(Trial& trial);            // elements/destroyed.cpp
void ends_at_once(Trial& trial);         // elements/ends_at_once.cpp
void farewells(Trial& trial);            // elements/farewells.cpp
void groups(Trial& trial);               // collectives/groups.cpp
void balance_rounds(Trial& trial);       // elements/balance.cpp
void balance_barrier(Trial& trial);      // elements/balance_barrier.cpp
void balance_rotate(Trial& trial);       // elements/balance.cpp
void balance_first_round(Trial& trial);  // elements/balance.cpp
void balance_periodic(Trial& trial);     // elements/balance.cpp
void balance_epochs(Trial& trial);       // elements/balance_epochs.cpp
void balance_newcomers(Trial& trial);    // elements/balance_newcomers.cpp

struct Scenario {
  std::string_view name;
  std::string_view claim;
  void (*run)(Trial&);
  std::uint64_t usual_checks;  ///< of a trial in one process: the mean over 30 seeds is no less
  bool in_jobs = false;        ///< its oracle needs no memory that processes share
};

/// usual_checks holds from this number of seeds on.
inline constexpr std::uint64_t many_seeds = 30;

/// Empty, or a sentence if these trials checked less than the scenario does: it tests nothing then.
[[nodiscard]] std::string too_few_checks(const Scenario& scenario, std::uint64_t n_trials,
                                         std::uint64_t n_checks);

[[nodiscard]] std::span<const Scenario> scenarios();
/// The scenario of this name. Throws Error that lists the names for an unknown one.
[[nodiscard]] const Scenario& scenario(std::string_view name);

}  // namespace tess::fuzz
