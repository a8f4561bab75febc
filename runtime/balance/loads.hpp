// Time and memory of every PE while a strategy moves elements: kept once, for all strategies.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

class Loads {
 public:
  /// Background alone; elements are added one by one.
  explicit Loads(const Snapshot& s)
      : snapshot_(s), work_(s.pes.size(), 0.0), memory_bytes_(s.pes.size(), 0) {}

  void add(std::size_t element, std::size_t pe) {
    work_[pe] += snapshot_.elements.load[element];
    memory_bytes_[pe] += snapshot_.elements.size_bytes[element];
  }
  void remove(std::size_t element, std::size_t pe) {
    work_[pe] -= snapshot_.elements.load[element];
    memory_bytes_[pe] -= snapshot_.elements.size_bytes[element];
  }
  [[nodiscard]] bool fits(std::size_t element, std::size_t pe) const {
    const auto limit = snapshot_.pes.memory_limit_bytes[pe];
    return limit == 0 || memory_bytes_[pe] + snapshot_.elements.size_bytes[element] <= limit;
  }
  /// Seconds that a PE needs, with `more` seconds of work besides.
  [[nodiscard]] double time(std::size_t pe, double more = 0) const {
    return snapshot_.pes.background[pe] + (work_[pe] + more) / snapshot_.pes.speed[pe];
  }

 private:
  const Snapshot& snapshot_;
  std::vector<double> work_;
  std::vector<std::uint64_t> memory_bytes_;
};

}  // namespace tess::balance
