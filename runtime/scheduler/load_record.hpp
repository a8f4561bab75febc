// What one element cost since its loads were last collected: the time of its code by entry method,
// and what it sent to whom. Kept while a balancer watches the element, and travels with it.
#pragma once

#include "runtime/core/element_key.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <cstdint>
#include <vector>

namespace tess {

struct Action;

/// Payload that was sent; headers do not count.
struct SentTo {
  std::uint64_t bytes = 0;
  std::uint64_t messages = 0;
};

struct LoadRecord {
  struct Entry {
    const Action* action = nullptr;
    std::uint64_t ticks = 0;
    std::uint64_t calls = 0;
  };

  /// Since when the element is measured.
  enum class Since : std::uint8_t {
    somewhere,  ///< after it had run already: what it costs in a phase is not known
    construction,
    phase,  ///< from the beginning of the phase
  };

  std::uint64_t ticks = 0;     ///< of the PE's meter
  std::vector<Entry> entries;  ///< by entry method: few
  boost::unordered_flat_map<ElementKey, SentTo, ElementKeyHash> sent;
  std::uint64_t* of_pe = nullptr;  ///< where the PE adds up the ticks of all such elements
  Since since = Since::somewhere;

  /// Whether `ticks` are all that the element cost in this phase. Of a newborn that has not run yet
  /// they say nothing.
  [[nodiscard]] bool known() const {
    return since == Since::phase || (since == Since::construction && !entries.empty());
  }

  void spend(const Action* action, std::uint64_t spent) {
    ticks += spent;
    if (of_pe != nullptr) *of_pe += spent;
    for (Entry& entry : entries) {
      if (entry.action != action) continue;
      entry.ticks += spent;
      ++entry.calls;
      return;
    }
    entries.push_back({action, spent, 1});
  }
  /// A phase begins.
  void clear() {
    since = Since::phase;
    ticks = 0;
    entries.clear();
    sent.clear();
  }
};

}  // namespace tess
