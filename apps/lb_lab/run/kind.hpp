// A kind of workload, by its chares. Many workloads have cells of given cost (workloads.cpp); a
// collision and a swarm of particles do real work, whose cost is not given. Each kind computes the
// answer in two ways: by chares, and serially.
#pragma once

#include "apps/lb_lab/run/experiment.hpp"
#include "apps/lb_lab/workload/workload.hpp"

#include <cstdint>
#include <string>

namespace lb_lab {

/// What the speeds of PEs mean.
enum class Speeds : std::uint8_t {
  given,     ///< work of given seconds takes a PE these seconds over its speed
  relative,  ///< the fastest PE works as fast as it can, and slower ones take longer
};

struct Kind {
  Speeds speeds = Speeds::given;
  /// The answer, computed without chares and messages.
  std::uint64_t (*serial_answer)(const Problem&) = nullptr;
  /// Seconds at speed 1 of all iterations: exact for cells, nominal for real work.
  double (*total_seconds)(const Problem&) = nullptr;
  /// The work and the messages of the chares, for --explain.
  std::string (*describe)(const Problem&) = nullptr;
  /// Makes the chares, balances them, runs them to their end, and fills times, answer and rounds of
  /// the outcome. Awaited on PE 0; all arguments outlive it.
  tess::Task (*run)(const Experiment&, tess::GroupProxy<Station>, Outcome&) = nullptr;
};

/// The amount of real work: as many items as the grain makes at `nominal_seconds` each, limited by
/// memory and by the time of a simulated machine. The same for every cut and machine.
[[nodiscard]] std::uint64_t n_items(const Problem& problem, double nominal_seconds);

/// Seconds at speed 1 of one of so many items in an iteration, by the grain. A simulated machine of
/// fixed cost charges them.
[[nodiscard]] double item_seconds(const Problem& problem, std::uint64_t n_items);

/// Nominal seconds of all iterations.
[[nodiscard]] double nominal_seconds(const Problem& problem);

}  // namespace lb_lab
