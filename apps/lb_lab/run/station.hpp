// The laboratory's context on each PE: the plan of the run, and a record of the work of the PE.
// Workers use the station of the PE they are on; after the run the records are gathered on PE 0.
#pragma once

#include "apps/lb_lab/workload/workload.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

enum class Sync : std::uint8_t { none, at_period };

/// One run, the same on every PE.
struct Plan {
  Problem problem;
  Sync sync = Sync::none;  ///< at_period: at_sync() after every `period` iterations
  std::int32_t period = 1;
  double steps_a_second = 0;   ///< of walk()
  std::vector<double> speeds;  ///< of each PE; empty: all 1
  std::int32_t n_drawn = 0;    ///< iterations whose intervals are kept for a timeline
};

/// Seconds on the clock of the run.
struct Interval {
  double begin = 0, end = 0;
};

/// The work of one PE.
struct PeRecord {
  std::vector<double> seconds;     ///< CPU (or virtual) time in workers, of each iteration
  std::vector<Interval> busy;      ///< of the iterations that are drawn, in order; gaps are idle
  std::vector<double> waits_from;  ///< of each phase: the last at_sync() on this PE, or −1
  std::vector<double> resumes_at;  ///< of each phase: its first resume, or −1
};

class Station : public tess::Group<Station> {
 public:
  explicit Station(Plan plan);

  [[nodiscard]] const Plan& plan() const { return plan_; }
  [[nodiscard]] double speed() const { return speed_; }

  /// Does a worker's work of an iteration: `seconds` at speed 1. Returns its argument.
  [[nodiscard]] std::uint64_t work(double seconds, std::uint64_t word);
  /// An iteration of a worker begins and ends; nothing else runs between.
  void begins();
  void ends(std::int32_t iteration);
  void waits(std::int32_t phase);
  void resumes(std::int32_t phase);

  /// Real work took `measured_seconds` on this PE. A simulated machine of fixed cost is charged the
  /// nominal ones; a PE that is slower than the fastest works on for the difference.
  void worked(double measured_seconds, double nominal_seconds);
  /// The clock for worked().
  [[nodiscard]] double cpu() const;
  /// Part of the answer, from a chare that ends here.
  void take(std::uint64_t part) { answer_ += part; }

  // Entry methods.
  void give_record(tess::Callback<std::vector<PeRecord>> target);
  void give_answer(tess::Callback<std::uint64_t> target) { contribute(tess::sum, answer_, target); }
  /// For workloads whose iterations end on all PEs at once (stepped.hpp), between two of them: the
  /// first begins, one is over, a round is over. The work between two calls is the iteration's.
  void first_begins();
  void iteration_ends(std::int32_t iteration);
  void round_ends(std::int32_t phase);

 private:
  [[nodiscard]] double clock() const;
  void spend(double time);
  void draw(std::int32_t iteration, const Interval& busy);

  const Plan plan_;
  const double speed_;
  const double slowness_;    // relative to the fastest PE, at least 1
  bool fixed_cost_ = false;  // a simulated machine whose clock does not count the cost of code
  PeRecord record_;
  double began_ = 0, cpu_at_begin_ = 0;
  double busy_at_begin_ = 0;  // tess::busy_time()
  std::uint64_t answer_ = 0;
  std::uint64_t walked_ = 0;
};

}  // namespace lb_lab
