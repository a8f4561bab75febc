// The protocol scenarios. Each runs a program that stresses one part of the runtime, with a
// delivery order that the trial's seed draws, and compares the outcome with an oracle. Used by the
// program protocol_fuzz and by the tests.
#pragma once

#include "apps/protocol_fuzz/trial.hpp"

#include <span>
#include <string>
#include <string_view>

namespace tess::fuzz {

void create_at_once(Trial& trial);       // create.cpp
void message_first(Trial& trial);        // create.cpp
void lives(Trial& trial);                // lives.cpp
void broadcasts(Trial& trial);           // broadcasts.cpp
void constructors(Trial& trial);         // constructors.cpp
void rounds(Trial& trial);               // rounds.cpp
void newborns(Trial& trial);             // newborns.cpp
void refinement(Trial& trial);           // newborns.cpp
void sections(Trial& trial);             // sections.cpp
void sections_end(Trial& trial);         // sections_end.cpp
void scans(Trial& trial);                // scans.cpp
void tour(Trial& trial);                 // tour.cpp
void epochs(Trial& trial);               // epochs.cpp
void pauses(Trial& trial);               // pauses.cpp
void epoch_migrations(Trial& trial);     // epoch_migrations.cpp
void flood_exit(Trial& trial);           // exits.cpp
void mailboxes(Trial& trial);            // mailboxes.cpp
void asks(Trial& trial);                 // asks.cpp
void all_at_once(Trial& trial);          // all_at_once.cpp
void timers(Trial& trial);               // timers.cpp
void payloads(Trial& trial);             // payloads.cpp
void floods(Trial& trial);               // floods.cpp
void priorities(Trial& trial);           // priorities.cpp
void process_groups(Trial& trial);       // process_groups.cpp
void deadlocks(Trial& trial);            // ends.cpp
void exceptions(Trial& trial);           // ends.cpp
void dead_letters(Trial& trial);         // ends.cpp
void destroyed(Trial& trial);            // destroyed.cpp
void groups(Trial& trial);               // groups.cpp
void balance_rounds(Trial& trial);       // balance.cpp
void balance_barrier(Trial& trial);      // balance_barrier.cpp
void balance_rotate(Trial& trial);       // balance.cpp
void balance_first_round(Trial& trial);  // balance.cpp
void balance_periodic(Trial& trial);     // balance.cpp
void balance_epochs(Trial& trial);       // balance_epochs.cpp

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
