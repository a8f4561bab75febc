// The inputs of one point's tasks, kept by step until the task of that step runs, since neighbours
// may be ahead. An output contains what Task Bench sends: the step and the point of its task. The
// consumer compares every input with its dependence. No messages here.
//
//     slots    step 7   (6, 3) (6, 4)  -      one place per dependence of the step's set
//              step 8     -    (7, 4)  -
#pragma once

#include "apps/task_bench/graph.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace task_bench {

/// The output of a task, repeated to fill -output bytes.
struct Output {
  std::int64_t step = 0;
  std::int64_t point = 0;
  friend bool operator==(const Output&, const Output&) = default;
};

class Inputs {
 public:
  Inputs() = default;
  Inputs(const Graph& graph, std::int32_t point);

  /// Takes an output of step output.step for the task of the next one. False where that task does
  /// not depend on it, has it already, or has run.
  [[nodiscard]] bool put(const Output& output) {
    const std::int64_t step = output.step + 1;
    if (step < first_ || step >= n_steps_) [[unlikely]]
      return false;
    if (step - first_ >= static_cast<std::int64_t>(counts_.size())) [[unlikely]]
      grow(step);
    const Set& set = sets_[set_of(step)];
    const std::size_t place = place_of(set, output.point);
    if (place >= set.from.size()) [[unlikely]]
      return false;
    Output& slot = slot_of(step)[place];
    if (slot.point >= 0) [[unlikely]]
      return false;
    slot = output;
    ++counts_[index_of(step)];
    return true;
  }

  /// Whether all inputs of the next step are there.
  [[nodiscard]] bool complete() const { return counts_[index_of(first_)] == n_needed_; }
  /// Whether the next step's task needs nothing of other points.
  [[nodiscard]] bool needs_no_other() const { return n_needed_ <= (needs_itself_ ? 1 : 0); }
  [[nodiscard]] std::int64_t step() const { return first_; }
  /// Whether not every point has a task at every step.
  [[nodiscard]] bool varies() const { return varies_; }
  /// Whether the point's own last output is one of its inputs.
  [[nodiscard]] bool needs_itself() const { return needs_itself_; }
  [[nodiscard]] std::int32_t n_needed() const { return n_needed_; }

  /// Of complete inputs: whether each is the output that its dependence names.
  [[nodiscard]] bool right() const {
    const Set& set = sets_[set_of(first_)];
    const Output* const slot = slot_of(first_);
    for (std::size_t place = 0; place < set.from.size(); ++place) {
      if (slot[place].point < 0) continue;  // a point without a task at the step before
      if (slot[place].step != first_ - 1 || slot[place].point != set.from[place]) return false;
    }
    return true;
  }

  /// Advances to the next step and forgets the inputs of this one.
  void advance() {
    const Set& set = sets_[set_of(first_)];
    Output* const slot = slot_of(first_);
    for (std::size_t place = 0; place < set.from.size(); ++place) slot[place].point = -1;
    counts_[index_of(first_)] = 0;
    ++first_;
    set_ = set_ + 1 == n_sets_ ? 0 : set_ + 1;
    if (first_ < n_steps_) count_needed();
  }
  /// Starts at step 0 again, after the last.
  void rewind();

  /// The points that need the output of the next step's task, this point too if it does; those
  /// without a task then are among them.
  [[nodiscard]] const std::vector<std::int32_t>& consumers() const {
    return sets_[set_of(first_ + 1)].to;
  }
  /// What is wrong with an output that put() refused.
  [[nodiscard]] std::string complaint(const Output& output) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(graph_, point_, n_steps_, n_sets_, varies_, sets_, n_places_, first_, set_, n_needed_,
       needs_itself_, slots_, counts_);
  }

 private:
  struct Set {
    std::vector<std::int32_t> from, to;
    bool in_a_row = false;  // `from` has no gaps
    bool itself = false;    // `from` has the point itself
  };

  /// Of a step from the next one on.
  [[nodiscard]] std::size_t set_of(std::int64_t step) const {
    if (n_sets_ == 1) return 0;
    std::int64_t set = set_ + (step - first_);
    while (set >= n_sets_) set -= n_sets_;  // hardly ever more than once
    return static_cast<std::size_t>(set);
  }
  [[nodiscard]] static std::size_t place_of(const Set& set, std::int64_t point) {
    if (set.in_a_row) return static_cast<std::size_t>(point - set.from.front());
    std::size_t place = 0;
    while (place < set.from.size() && set.from[place] != point) ++place;
    return place;
  }
  [[nodiscard]] std::size_t index_of(std::int64_t step) const {
    return static_cast<std::size_t>(step) & (counts_.size() - 1);
  }
  [[nodiscard]] Output* slot_of(std::int64_t step) {
    return slots_.data() + index_of(step) * n_places_;
  }
  [[nodiscard]] const Output* slot_of(std::int64_t step) const {
    return slots_.data() + index_of(step) * n_places_;
  }
  void grow(std::int64_t step);
  void count_needed() {
    if (!varies_ && first_ != 0) {
      const Set& set = sets_[set_of(first_)];
      n_needed_ = static_cast<std::int32_t>(set.from.size());
      needs_itself_ = set.itself;
    } else {
      count_active();
    }
  }
  void count_active();

  Graph graph_;
  std::int32_t point_ = 0;
  std::int64_t n_steps_ = 0;
  std::int32_t n_sets_ = 1;
  bool varies_ = false;  // the points that have a task are not the same at every step
  std::vector<Set> sets_;
  std::size_t n_places_ = 0;  // of a slot: those of the largest set

  std::int64_t first_ = 0;            // the next step to run
  std::int32_t set_ = 0;              // its dependence set
  std::int32_t n_needed_ = 0;         // inputs of it
  bool needs_itself_ = false;         // the point's own last output is one of them
  std::vector<Output> slots_;         // n_places_ per step, a ring of a power of two of them
  std::vector<std::int32_t> counts_;  // inputs that a slot has; as many as slots
};

}  // namespace task_bench
