// Time and memory of every PE while a strategy decides. Memory starts with the present placement
// and follows each decided move: an undecided element still occupies its present PE. So an element
// can always stay, and the moves, made in the order of decision, never break a limit that held
// before. Work starts empty, or with the present placement (present()). An element whose load is
// unknown has memory, but no work: put() and move() of it throw Error.
#pragma once

#include "runtime/balance/memory.hpp"

namespace tess::balance {

class Loads {
 public:
  /// Memory of the present placement; work is only the background.
  explicit Loads(const Snapshot& s) : snapshot_(s), work_(s.pes.size(), 0.0), memory_(s) {}
  /// Memory and work of the present placement.
  [[nodiscard]] static Loads present(const Snapshot& s) {
    Loads loads(s);
    for (std::size_t i = 0; i < s.elements.size(); ++i) loads.put(i, slot(s.elements.pe[i]));
    return loads;
  }

  void put(std::size_t element, std::size_t pe) {
    work_[pe] += snapshot_.elements.load[element].seconds();
  }
  void move_memory(std::size_t element, std::size_t from, std::size_t to) {
    memory_.move(element, from, to);
  }
  /// Moves work and memory.
  void move(std::size_t element, std::size_t from, std::size_t to) {
    work_[from] -= snapshot_.elements.load[element].seconds();
    put(element, to);
    move_memory(element, from, to);
  }
  /// True if an element that occupies `from` may go to `to`; it may always stay.
  [[nodiscard]] bool fits(std::size_t element, std::size_t from, std::size_t to) const {
    const auto limit = snapshot_.pes.memory_limit_bytes[to];
    return from == to || limit == 0 || memory_.bytes_with(element, to) <= limit;
  }
  /// The seconds that a PE needs, with `more` seconds of work added.
  [[nodiscard]] double time(std::size_t pe, double more = 0) const {
    return snapshot_.pes.background[pe] + (work_[pe] + more) / snapshot_.pes.speed[pe];
  }

 private:
  const Snapshot& snapshot_;
  std::vector<double> work_;
  Memory memory_;
};

}  // namespace tess::balance
