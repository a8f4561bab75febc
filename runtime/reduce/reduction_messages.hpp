// What the PEs of a ReductionTree send to each other. Contributions go up as reports; from PEs that
// wait, questions go down.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/reduce/gathered.hpp"

#include <cstdint>
#include <string>

namespace tess::detail {

class Pe;

/// The causes of contributions: the last broadcast that any of the contributors had received, and
/// the first that led to one of the contributions (0: none is known).
struct Cause {
  std::uint64_t met = 0;
  std::uint32_t led_by = 0;
  /// Merges another. Returns true if an earlier broadcast led to it than was known.
  bool merge(const Cause& more);
};

/// An element that contributes for the first time, and the last broadcast before its creation.
struct Newcomer {
  std::uint32_t created_after = 0;  // 0: there is none
  std::string element;
  // Its insertion was not awaited, and no known broadcast led it here: another contributor knows
  // one, or rounds may overlap.
  bool unawaited = false;
};

/// Contributions to a number, with what is reported beside them.
struct Reported : Gathered {
  std::int64_t change = 0;  // of the membership
  Cause cause;
  Newcomer newcomer;   // of these contributors the one that was created after the last broadcast
  bool named = false;  // one of them names the number
  void note(Newcomer&& other);
  /// Returns true if an earlier broadcast led to it than was known.
  bool merge(Reported&& more);
  template <class Ar>
  void serialize(Ar& ar) {
    Gathered::serialize(ar);
    ar(change, cause, newcomer, named);
  }
};

/// A child's time in a tree whose PEs attach: how often it has attached so far, and the first number
/// that it reports. In a tree of all PEs it is the same all the time.
struct Attachment {
  std::uint32_t time = 0;
  std::uint32_t from = 0;
};

/// From a PE to its parent; or, if it is late, to the root.
struct ReductionReport {
  enum class What : std::uint8_t {
    sum,         ///< of the PE and those below it
    late,        ///< a contribution, or a change of membership
    attached,    ///< the PE reports from now on
    detached,    ///< it reports no longer
    late_joins,  ///< the answer of a subtree to a count of late joins
  };
  What what = What::sum;
  PeId child{};  // the PE
  Attachment as;
  std::uint32_t number = 0;
  Reported sum;
  // In a late report: the element that leaves the membership of `number` joins there; 0: none.
  std::uint32_t joins = 0;
  bool expedites = false;
  std::uint64_t n_joins = 0;  // the number of late joins
  template <class Ar>
  void serialize(Ar& ar) {
    ar(what, child, as, number, expedites, joins, n_joins, sum);
  }
  [[nodiscard]] std::int64_t priority() const;
  std::uint64_t drop(Pe& pe) const;  // the collection has ended
};
/// A ready PE asks the PEs below it for their reports, or for their late joins.
struct ReductionBegin {
  std::uint32_t number = 0;
  Cause cause;
  bool expedites = false;
  bool counts = false;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(number, cause, expedites, counts);
  }
  [[nodiscard]] std::int64_t priority() const;
};

}  // namespace tess::detail
