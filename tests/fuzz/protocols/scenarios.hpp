// The protocol scenarios. Each runs a program that stresses one part of the runtime, with a
// delivery order that the seed draws, and compares the outcome with an oracle. Each stands in a
// source of its name, or of its family's name.
#pragma once

#include "tests/fuzz/protocols/case.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tess::fuzz {

enum class Pes : std::uint8_t {
  usual,  ///< 1, 2, 3, 4, 7 or 8
  two_to_eight,
  one_to_forty,  ///< trees of PEs are four levels deep on 22 PEs and more
};

struct Scenario {
  std::string_view name;
  std::string_view claim;
  void (*run)(Case&);
  std::uint64_t usual_checks;  ///< of a seed in one process: the mean over many seeds is no less
  On on;                       ///< job: its oracle needs no memory that processes share
  Pes pes = Pes::usual;
  bool is_slow = false;
};

[[nodiscard]] std::span<const Scenario> scenarios();
/// The scenario of this name. Throws Error that lists the names for an unknown one.
[[nodiscard]] const Scenario& scenario(std::string_view name);

/// Each is a function of a case, that is, of a seed.
void create_at_once(Case&), message_first(Case&), create_and_destroy(Case&), broadcasts(Case&),
    rounds(Case&), inner_rounds(Case&), driven_rounds(Case&), created_after_results(Case&),
    created_in_steps(Case&), sections(Case&), sections_end(Case&), scans(Case&), maps(Case&),
    interfaces(Case&), visits_all_pes(Case&), epochs(Case&), idle_reports(Case&),
    epoch_migrations(Case&), exit_under_load(Case&), mailboxes(Case&), timers(Case&), asks(Case&),
    values(Case&), all_at_once(Case&), payloads(Case&), flow_control(Case&), priorities(Case&),
    process_groups(Case&), deadlocks(Case&), exceptions(Case&), undelivered_messages(Case&),
    destroyed(Case&), waits_after_destroy(Case&), ends_at_once(Case&), constructors(Case&),
    groups(Case&), balance_rounds(Case&), balance_barrier(Case&), balance_created_in_epochs(Case&),
    balance_rotate(Case&), balance_first_round(Case&), balance_periodic(Case&),
    balance_epochs(Case&);

}  // namespace tess::fuzz
