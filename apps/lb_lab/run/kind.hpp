// A kind of workload: what its chares are. Of cells with a given cost there are many workloads
// (workloads.cpp); a collision and a swarm of particles do real work, whose cost nobody gave. Each
// kind knows how chares compute the answer, and how one does without them.
#pragma once

#include "apps/lb_lab/run/experiment.hpp"
#include "apps/lb_lab/workload/workload.hpp"

#include <string>

namespace lb_lab {

struct Kind {
  /// The answer, computed without chares and messages.
  std::uint64_t (*serial_answer)(const Problem&) = nullptr;
  /// Seconds at speed 1 of all iterations: exact for cells, nominal for real work.
  double (*total_seconds)(const Problem&) = nullptr;
  /// What the chares work on and send, for --explain.
  std::string (*describe)(const Problem&) = nullptr;
  /// Makes the chares, has them balanced, runs them to their end: fills what the outcome says of
  /// times, answer and rounds. Awaited on PE 0; all arguments outlive it.
  tess::Task (*run)(const Experiment&, tess::GroupProxy<Station>, Outcome&) = nullptr;
};

/// How much real work there is: as many items as the grain asks for at `nominal_seconds` each, but
/// no more than memory and a simulated machine stand. The same for every cut and machine.
[[nodiscard]] std::uint64_t n_items(const Problem& problem, double nominal_seconds);

/// Seconds at speed 1 of one of so many items in an iteration, by the grain: what a simulated
/// machine of fixed cost charges for it.
[[nodiscard]] double item_seconds(const Problem& problem, std::uint64_t n_items);

/// Nominal seconds of all iterations.
[[nodiscard]] double nominal_seconds(const Problem& problem);

}  // namespace lb_lab
