// The measured loads of an array's elements on one PE: reported to the coordinator, and then the
// elements it names are moved. An element that leaves or ends between the two is struck off. The
// load of an element is known from its birth on, or from the beginning of a phase: what ran before
// it was measured makes it unknown until then.
#pragma once

#include "runtime/balance/rounds/coordinator.hpp"
#include "runtime/collections/collection.hpp"

namespace tess::balance {

class Measured {
 public:
  explicit Measured(Pe& pe) : pe_(pe), meter_(pe.start_meter()), busy_before_(meter_.busy()) {}

  void attach(Collection& array);
  /// Lets go of the array and its elements; what is reported from now on is the PE without them.
  void detach();

  void entered(Element& element);
  void left(Element& element);

  /// The loads since the last phase began; a new phase begins.
  [[nodiscard]] PeReport report(std::uint64_t round);
  /// Whom the last report listed; null where it has left or ended.
  [[nodiscard]] Element* reported(std::size_t position) const { return reported_[position]; }
  [[nodiscard]] std::size_t n_reported() const { return reported_.size(); }

  /// This PE in the phase so far, at a speed.
  [[nodiscard]] PhaseSums sums(double speed) const;
  /// A new phase begins: what was measured is forgotten.
  void clear();

  /// Elements of the last report leave for other PEs; returns their packed size.
  std::uint64_t move(const std::vector<Move>& moves);

 private:
  void add(Element& element, std::uint64_t round, PeReport& report);
  [[nodiscard]] double busy_outside() const;
  void begin_phase();

  Pe& pe_;
  Meter& meter_;
  Collection* array_ = nullptr;
  std::vector<Element*> reported_;
  std::uint64_t busy_before_;      // of the meter, when the phase began
  std::uint64_t in_elements_ = 0;  // ticks of the array's elements on this PE since then
};

}  // namespace tess::balance
