// The reductions over the elements of a collection, or over the members of a section, seen from one
// PE. Contributions are numbered; number r is complete when as many elements have contributed to r
// as are members of r, on whichever PEs they contributed. They are combined along a tree of the PEs.
// What comes too late for the report of a PE (the element has arrived since) goes directly to the
// root, so a result does not depend on where elements are. MembersOf says which PEs report:
//
// Over a collection all PEs report. A PE reports r to its parent once every local element has
// contributed to r and every child has reported r. The report carries the merged contributions,
// their count, and the change of membership since r − 1: elements that join at r, and elements
// destroyed before r. A late destruction goes directly to the root, too. The root completes r once
// it has all reports and the count equals the membership:
//
//     contributions that arrived ≤ contributions made ≤ members ≤ members reported
//
// (an element that joins is never reported late). A PE without elements reports as soon as it
// learns of r: from a child, or from a parent that is ready and still waits.
//
// Over a section only the PEs with members, and those between them and the root, report. The root
// knows the members without being told, and counts.
//
//     attached   A PE that has a member, or an attached child, attaches to its parent. From the number
//                it names it reports each number once: after its members and its attached children
//                have passed the number.
//     detached   A PE without both detaches, and sends what it holds directly to the root, as does a
//                PE whose child has attached too late for the number.
//
// So a PE waits only for what is certain to come: a contribution of a member here, or a report or
// the detachment of a child. The rest is about collections.
//
// Where an element joins: an element that is created on a PE after broadcast b was applied there
// receives b + 1, b + 2, …, and joins at the first number that this PE has not reported and that no
// broadcast up to b led to. (A broadcast leads to the contributions of its entry method, and of the
// coroutines, timers and messages among the array's elements that follow from it. A message of
// another collection does not carry it.) The element is neither ahead nor behind:
//
//     ahead    Reports and Begins carry the last broadcast that any contributor had received, and a
//              PE reports once it has applied that one. So an element that is created after its PE
//              has reported r has received, or was created after, all that led to r. The result of
//              r is delivered after all PEs have reported r: once it is known, no element that is
//              created as a consequence, on any PE, receives those broadcasts or joins at r.
//     behind   A new element delays the number it joins at until it contributes. Once its PE learns
//              of a contribution to r that a broadcast up to b led to, the element joins after r. So
//              r is complete without it, and the broadcast that was started when r was known finds
//              it at the number that this broadcast leads to.
//
// If that broadcast is started before r is known, the element may contribute to r before its PE
// learns what led to r. So first contributions carry the broadcast after which their element was
// created, and the root refuses a number to which that broadcast, or an earlier one, led.
//
// Rounds that are named may overlap. An element that is inserted with the name of its first round is
// a member from the call of insert() on, on the calling PE, wherever and whenever it is created. If
// that PE has reported the number, the join is late: it is sent to the root. Before the root
// completes named numbers, it counts the late joins on all PEs. All contributions have been made
// then, so each join that led to one of them is counted, and the root has received it if the count
// is what it had received before it asked.
#pragma once

#include "runtime/reduce/led_to.hpp"
#include "runtime/reduce/number_counts.hpp"
#include "runtime/reduce/open_sums.hpp"
#include "runtime/reduce/reduction_messages.hpp"
#include "runtime/reduce/tree_children.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace tess::detail {

/// What a ReductionTree needs of its PE and its collection.
class ReductionHost {
 public:
  ReductionHost() = default;
  ReductionHost(const ReductionHost&) = delete;
  ReductionHost& operator=(const ReductionHost&) = delete;
  virtual ~ReductionHost() = default;

  // The tree of PE `to` receives these by on_report() and on_begin().
  virtual void send(PeId to, ReductionReport&& report) = 0;
  virtual void send(PeId to, const ReductionBegin& begin) = 0;
  /// The number of the last broadcast that was applied on this PE.
  [[nodiscard]] virtual std::uint64_t applied_broadcast() const = 0;
  /// Calls postpone() for the elements here that have not contributed since their construction.
  virtual void postpone_new_elements() = 0;
  /// At the root: sends a complete result to its target, in this epoch.
  virtual void deliver(Partial& result, EpochId epoch) = 0;
};

/// The words of a tree in reports: "Block: reduction", and the members that have not contributed to
/// all numbers below one.
struct TreeWords {
  std::string name;
  std::function<std::string(std::uint32_t)> missing_before;
};

/// Numbers have 32 bits, and some elements are ahead.
inline constexpr std::uint32_t most_rounds = ~std::uint32_t{0} - (1U << 20U);

/// Whose contributions a tree combines, and so which PEs report.
enum class MembersOf : std::uint8_t { collection, section };

class ReductionTree {
 public:
  /// The part of PE `here` of `n_pes`; `root` completes the reductions.
  ReductionTree(ReductionHost& host, Completion& completion, PeId here, PeId root,
                std::int32_t n_pes, TreeWords words, MembersOf of = MembersOf::collection);
  ReductionTree(const ReductionTree&) = delete;
  ReductionTree& operator=(const ReductionTree&) = delete;
  ~ReductionTree();

  /// The number at which an element joins that is created here now, unless it is postponed.
  [[nodiscard]] std::uint32_t joins_at() const { return next_report_; }

  void add_member(std::uint32_t at) { changes_[at] += 1; }
  /// An element is inserted from this PE that is a member from this number on.
  void join(std::uint32_t number, std::string element);
  /// At the root: an element elsewhere joins at the open number, which is returned, and is entered
  /// on its PE with it.
  [[nodiscard]] std::uint32_t admit();
  /// For an element on this PE that was created after this broadcast and is a member from `next`
  /// on: the number at which it joins by present knowledge.
  [[nodiscard]] std::uint32_t postpone(std::uint32_t next, std::uint32_t created_after);
  /// An element was destroyed that would have contributed to `next`.
  void remove_member(std::uint32_t next);
  /// At the root of a section: it has so many members from now on, and no number is complete before.
  void begin(std::uint64_t n_members);
  /// At the root of a section: a member was destroyed elsewhere that would have contributed to
  /// `next`.
  void member_destroyed(std::uint32_t next);
  /// At the root of a section: it has begun, and all members have been destroyed.
  [[nodiscard]] bool is_empty() const;

  /// An element with this next number is on this PE from now on, or no longer.
  void enter(std::uint32_t next) { elements_at_.add(next); }
  void leave(std::uint32_t next) { elements_at_.remove(next); }

  /// An element on this PE contributes to `number`; it was entered with `number` and is now entered
  /// with the next. The epoch waits for the delivery of the result.
  void contribute(std::uint32_t number, EpochId epoch, std::unique_ptr<Partial> value,
                  const Cause& cause = {}, Newcomer newcomer = {});
  /// Does the same for an element that has been entered with its next number. `named` says that the
  /// element names this one.
  void gather(std::uint32_t number, EpochId epoch, std::unique_ptr<Partial> value,
              const Cause& cause, Newcomer newcomer, bool named);
  /// Misuse: the insertion of an element was not awaited, and its first value may be meant for
  /// another number.
  [[noreturn]] void refuse_unawaited(const std::string& element, std::int64_t number) const;

  /// The contributions to `number` gathered here, if one of this kind and epoch can be added in
  /// place; otherwise null, then call contribute(). After adding, the caller calls added().
  [[nodiscard]] Partial* open_sum(std::uint32_t number, const PartialKind& kind, EpochId epoch) {
    return gathering_.open(number, kind, epoch);
  }
  /// A contribution was added to open_sum(). That of a section's member has no cause.
  void added(std::uint32_t number, const Cause& cause);
  void added(std::uint32_t number) {
    gathering_.added(completion_);
    go_on(number);
  }

  /// Attaches, reports or detaches if that is possible now; called after elements came or left.
  void advance();

  /// The collection ends: contributions gathered here are dropped.
  void end();

  /// This PE has applied a broadcast, at whose start `n_complete` reductions were complete.
  void applied(std::uint64_t broadcast, std::uint32_t n_complete) {
    led_to_.forget_below(n_complete);
    if (broadcast == awaited_broadcast_) [[unlikely]]
      advance();
  }
  /// At the root: the number of complete reductions.
  [[nodiscard]] std::uint32_t n_complete() const { return next_complete_; }

  void on_report(ReductionReport&& report);
  void on_begin(const ReductionBegin& begin);

  void describe_waiting(std::vector<std::string>& lines) const;

 private:
  struct Gathering : Reported {
    std::uint32_t reported = 0;  // the children that have, as bits of TreeChildren
    bool known = false;          // an element contributed, or a PE reported or asked
    bool asked = false;          // the children were asked to begin
  };

  [[nodiscard]] bool ready(std::uint32_t number) const {
    return elements_at_.empty() || elements_at_.lowest() > number;
  }
  /// An element has contributed to `number`.
  void go_on(std::uint32_t number) {
    leave(number);
    enter(number + 1);
    if (ready(next_report_)) advance();
  }
  void report(std::uint32_t number, Gathering&& gathered);
  void report_late(std::uint32_t number, Reported&& sum, std::uint32_t joins = 0);
  /// Attaches or detaches if the members here and the children below have changed. Returns true if
  /// this PE is attached.
  bool attach();
  /// Sends what is gathered for numbers below `end` directly to the root.
  void flush(std::uint32_t end);
  void on_sum(ReductionReport&& report);
  void on_late(ReductionReport&& report);
  /// Misuse: members were added to a number that is complete.
  void require_open(std::uint32_t number) const;
  void complete_if_whole();
  /// True if all members of a number that is not complete have contributed. `members`: of the number
  /// before; then of this one.
  [[nodiscard]] bool is_whole(std::uint32_t number, std::int64_t& members) const;
  /// At the root: begins to count the late joins, unless a count is under way or would fail.
  void start_count();
  void count_joins();
  void joins_counted();
  void check_newcomer(const Reported& sum) const;

  void ask_children(std::uint32_t number, const Cause& cause);
  /// Records that a broadcast led to a contribution to `number`. Returns false if that was known.
  bool learn(std::uint32_t number, std::uint32_t led_by);
  /// Merges the cause of a contribution to `number`.
  void take(std::uint32_t number, Gathering& into, const Cause& cause);
  /// Merges that of a contribution elsewhere, of which this PE learns by a message that is no report
  /// of a child: a new element below may wait for this knowledge, so the children are asked.
  void take(std::uint32_t number, const Cause& cause);
  /// An earlier broadcast led to `number` than was known.
  void led_earlier(std::uint32_t number, const Gathering& gathering);

  ReductionHost& host_;
  Completion& completion_;
  const TreeWords words_;
  const PeId here_, root_, parent_;
  const bool of_section_;
  TreeChildren children_;
  bool attached_ = false;
  Attachment as_;
  std::uint32_t next_report_ = 0;  // this PE has reported all lower numbers that it had to report
  OpenSums<Gathering> gathering_;
  std::map<std::uint32_t, std::int64_t> changes_;
  LedTo led_to_;
  std::uint64_t awaited_broadcast_ = 0;  // reports wait until this broadcast is applied
  NumberCounts elements_at_;             // counts of local elements by their next number
  std::uint64_t n_late_joins_ = 0;       // sent from this PE
  std::uint64_t n_joins_below_ = 0;      // in the subtree, as far as it has been counted
  std::size_t n_uncounted_ = 0;          // children that have not answered

  // At the root: numbers in the order of completion.
  struct Whole : Reported {
    bool all_reported = false;
  };
  OpenSums<Whole> whole_;
  std::uint32_t next_complete_ = 0;
  std::int64_t members_ = 0;           // of the last complete number
  bool begun_ = false;                 // the members of the section are known
  std::uint64_t n_joined_ = 0;         // late joins received
  std::uint64_t n_joined_before_ = 0;  // the same at the start of the count
  std::uint32_t counted_end_ = 0;    // numbers below were whole at the start; 0: none is under way
  std::uint32_t confirmed_end_ = 0;  // named numbers below may be completed
};

}  // namespace tess::detail
