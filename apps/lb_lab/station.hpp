// What the laboratory has on each PE: the plan of the run, and a record of what the PE did. Workers
// find the one of the PE they are on; after the run all are gathered on PE 0.
#pragma once

#include "apps/lb_lab/workload.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

enum class Sync : std::uint8_t { none, at_period };

/// One run, as every PE needs to know it.
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

/// What one PE did.
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

  /// Does a worker's work of an iteration: `seconds` at speed 1. Returns the word that it is given.
  [[nodiscard]] std::uint64_t work(double seconds, std::uint64_t word);
  /// An iteration of a worker begins and ends; nothing else runs between.
  void begins();
  void ends(std::int32_t iteration);
  void waits(std::int32_t phase);
  void resumes(std::int32_t phase);

  // Entry method.
  void tell(tess::Callback<std::vector<PeRecord>> target);

 private:
  [[nodiscard]] double clock() const;
  [[nodiscard]] double cpu() const;

  const Plan plan_;
  const double speed_;
  PeRecord record_;
  double began_ = 0, cpu_at_begin_ = 0;
};

}  // namespace lb_lab
