// The measured loads of an array's elements on one PE. They are reported to the coordinator, and
// then the elements that it names are moved. An element that leaves or ends in between is removed
// from the report. The load of an element is known from its construction on, or from the beginning
// of a phase; if it ran before it was measured, its load is unknown until then.
#pragma once

#include "runtime/balance/rounds/coordinator.hpp"
#include "runtime/balance/rounds/internals.hpp"

namespace tess::balance {

/// What the load of other balanced arrays on a PE is to a round.
enum class Others : std::uint8_t {
  fixed,     ///< background: only this array moves. For rounds that take turns
  balanced,  ///< nothing: their own rounds run beside this one, and would correct the same imbalance
};

class Measured {
 public:
  /// The speed of the PE is relative.
  Measured(Pe& pe, SnapshotIndices indices, double speed)
      : pe_(pe),
        meter_(pe.measuring().start_meter()),
        indices_(indices),
        speed_(speed),
        busy_before_(meter_.busy()) {}

  [[nodiscard]] double speed() const { return speed_; }

  void attach(Collection& array);
  /// Detaches from the array; later reports cover the PE without its elements.
  void detach();

  void entered(Element& element);
  void left(Element& element);

  /// The loads since the last phase began; begins a new phase.
  [[nodiscard]] PeReport report(std::uint64_t round, Others others);
  /// The element at this position of the last report; null if it has left or ended.
  [[nodiscard]] Element* reported(std::size_t position) const { return reported_[position]; }

  /// The sums of this PE in the phase so far.
  [[nodiscard]] PhaseSums sums(Others others) const;
  /// The round that reported is over: what it did on this PE, such as packing elements, or the
  /// strategy on the coordinator, is not background of the phase that begins. For rounds for which
  /// the elements wait.
  void round_ends() { begin_phase(); }
  /// Begins a new phase and discards earlier measurements.
  void clear();
  /// The same where a phase ends without a report: a checkpoint has its loads as those of the last
  /// phase.
  void pass_phase();

  /// The loads that a checkpoint had of the elements here, in seconds at speed 1.
  [[nodiscard]] PastLoad past() const;
  /// Takes them for those of the phase so far: of the last phase before the checkpoint, or of the
  /// one that the checkpoint interrupted. Returns the number of elements whose load it had.
  std::uint64_t recall(bool interrupted);

  struct Moved {
    std::uint64_t n_elements = 0;
    std::uint64_t n_bytes = 0;  ///< packed
  };
  /// Sends elements of the last report to other PEs, without those that have left or ended.
  Moved move(const std::vector<Move>& moves);

 private:
  void add(Element& element, std::uint64_t round, PeReport& report);
  [[nodiscard]] Load load_of(const BalanceRecord& record) const;
  /// Its load is that of the last phase to a checkpoint.
  void keep_as_past(BalanceRecord& record) const;
  [[nodiscard]] double busy_outside(Others others) const;
  void begin_phase();

  Pe& pe_;
  Meter& meter_;
  const SnapshotIndices indices_;
  const double speed_;
  Collection* array_ = nullptr;
  std::vector<Element*> reported_;
  std::uint64_t in_elements_ = 0;  // ticks of the array's elements on this PE
  // When the phase began: the meter's busy ticks, those of these elements, of all balanced arrays.
  std::uint64_t busy_before_;
  std::uint64_t in_elements_before_ = 0;
  std::uint64_t in_balanced_before_ = 0;
};

}  // namespace tess::balance
