// The cost of one element since its loads were last collected: the time of its code by entry
// method, and the bytes that it sent to each other element. The record exists while a balancer
// watches the element, and migrates with it.
#pragma once

#include "runtime/core/element_key.hpp"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

struct Action;

/// Payload bytes that were sent; headers do not count.
struct SentTo {
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
};

/// What one element sent, by receiver. The hash table is in the source: it is costly to compile.
class SentTable {
 public:
  SentTable();
  SentTable(const SentTable&) = delete;
  SentTable& operator=(const SentTable&) = delete;
  ~SentTable();

  void add(const ElementKey& to, const SentTo& more);
  void clear();
  /// All receivers, in no order.
  [[nodiscard]] std::vector<std::pair<ElementKey, SentTo>> entries() const;

 private:
  struct Table;
  std::unique_ptr<Table> table_;  // null until something was sent
};

struct LoadRecord {
  struct MethodCost {
    const Action* action = nullptr;
    std::uint64_t ticks = 0;
    std::uint64_t calls = 0;
  };

  /// The start of the measurement.
  enum class Since : std::uint8_t {
    somewhere,  ///< after the element had run: its cost in a phase is not known
    construction,
    phase,  ///< since the beginning of the phase
  };

  std::uint64_t in_run = 0;         ///< ticks since the run, or its measurement, began
  std::uint64_t ticks = 0;          ///< ticks of the PE's meter in this phase, at `speed`
  std::vector<MethodCost> entries;  ///< by entry method
  SentTable sent;
  /// The PE's sum of the ticks of all such elements; null: no balancer watches, and only `in_run`
  /// counts.
  std::uint64_t* of_pe = nullptr;
  double speed = 1;  ///< relative speed of the PE that measures
  Since since = Since::somewhere;

  /// True if `ticks` is the whole cost of the element in this phase. A new element that has not run
  /// yet has no known cost.
  [[nodiscard]] bool known() const {
    return since == Since::phase || (since == Since::construction && !entries.empty());
  }

  void spend(const Action* action, std::uint64_t spent) {
    in_run += spent;
    if (of_pe == nullptr) return;
    ticks += spent;
    *of_pe += spent;
    for (MethodCost& entry : entries) {
      if (entry.action != action) continue;
      entry.ticks += spent;
      ++entry.calls;
      return;
    }
    entries.push_back({action, spent, 1});
  }
  /// What was measured so far, as if a PE of this speed had measured it.
  void continue_at(double new_speed);
  /// Begins a phase.
  void clear() {
    since = Since::phase;
    ticks = 0;
    entries.clear();
    sent.clear();
  }
};

}  // namespace tess::detail
