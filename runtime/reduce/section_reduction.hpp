// Reductions over the members of a section, seen from one PE. Contributions are numbered by the
// members, as those to an array are. The root counts: number r is complete when as many members
// have contributed to r as had not been destroyed before r, wherever they contributed.
//
// On the way to the root contributions are combined along the tree over all PEs, of which only the
// PEs with members and those between them and the root take part:
//
//     attached   a PE that has a member, or an attached child, attaches to its parent. From the number
//                it names it reports each number once: after its members and its attached children
//                have passed the number.
//     detached   a PE without both detaches, and sends what it holds directly to the root.
//
// What comes too late for a report (the member has arrived since, the child has attached since)
// goes directly to the root. So the result never depends on the tree being current; a PE waits only
// for what is certain to come: a contribution of a member here, or a report or the detachment of a
// child.
#pragma once

#include "runtime/pe/completion/completion.hpp"
#include "runtime/reduce/gathered.hpp"
#include "runtime/reduce/number_counts.hpp"
#include "runtime/reduce/open_sums.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

/// A child's time in the tree: how often it has attached so far, and the first number it reports.
struct Attachment {
  std::uint32_t time = 0;
  std::uint32_t from = 0;
};

/// From a child to its parent; or, with time 0, from any PE to the root.
struct SectionReport {
  PeId child{};
  Attachment as;
  std::uint32_t number = 0;
  Gathered gathered;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(child, as, number, gathered);
  }
};
struct SectionAttach {
  PeId child{};
  Attachment as;
  bool attached = true;  ///< false: it detaches
};

/// What a SectionReduction needs of its PE and its section.
class SectionHost {
 public:
  SectionHost() = default;
  SectionHost(const SectionHost&) = delete;
  SectionHost& operator=(const SectionHost&) = delete;
  virtual ~SectionHost() = default;

  // The part on PE `to` receives these by on_report() and on_attach().
  virtual void send(PeId to, SectionReport&& report) = 0;
  virtual void send(PeId to, const SectionAttach& attach) = 0;
  /// On the root: contributions to a number have arrived.
  virtual void arrived(std::uint32_t number, Gathered&& gathered) = 0;
};

class SectionReduction {
 public:
  SectionReduction(SectionHost& host, Completion& completion, PeId here, PeId root,
                   std::int32_t n_pes);

  /// A member with this next number is on this PE from now on, or no longer; then call advance().
  void enter(std::uint32_t next) { members_at_.add(next); }
  void leave(std::uint32_t next) { members_at_.remove(next); }

  /// A member on this PE contributes to `number`; it was entered with `number` and is now entered
  /// with the next. The epoch waits for the delivery of the result.
  void contribute(std::uint32_t number, EpochId epoch, std::unique_ptr<Partial> value);
  /// The contributions to `number` gathered here, if one of this kind and epoch can be added in
  /// place; otherwise null, then call contribute(). After adding, the caller calls added().
  [[nodiscard]] Partial* open_sum(std::uint32_t number, const PartialKind& kind, EpochId epoch) {
    return gathering_.open(number, kind, epoch);
  }
  void added(std::uint32_t number) {
    gathering_.added(completion_);
    leave(number);
    enter(number + 1);
    if (passed(next_report_)) advance();
  }

  /// Attaches, reports or detaches as far as that is possible now.
  void advance();

  void on_report(SectionReport&& report);
  void on_attach(const SectionAttach& attach);

  /// The section ends: contributions gathered here are dropped.
  void end();
  /// The number of contributions that wait here.
  [[nodiscard]] std::uint64_t n_waiting() const;

 private:
  struct Gathering : Gathered {
    std::vector<std::pair<PeId, std::uint32_t>> reported;  // children, and their times
  };
  struct Child {
    PeId pe;
    Attachment as;  // the latest that is known
    bool attached = false;
  };
  [[nodiscard]] Child* child(PeId pe);
  [[nodiscard]] bool passed(std::uint32_t number) const {
    return members_at_.empty() || members_at_.lowest() > number;
  }
  [[nodiscard]] bool ready(std::uint32_t number) const;
  void learn(const SectionAttach& attach);
  void send_up(std::uint32_t number, Gathered&& gathered);
  void send_to_root(std::uint32_t number, Gathered&& gathered);
  /// Sends all that is gathered for numbers below `end` directly to the root.
  void flush(std::uint32_t end);

  SectionHost& host_;
  Completion& completion_;
  const PeId here_, root_, parent_;
  std::vector<Child> children_;
  NumberCounts members_at_;  // counts of members here by their next number
  bool attached_ = false;
  Attachment as_;
  std::uint32_t next_report_ = 0;  // while attached: all lower numbers are reported
  OpenSums<Gathering> gathering_;
};

/// The root's count of the contributions to a section.
class SectionTotal {
 public:
  /// From now on the section has so many members; no number is complete before.
  void begin(std::uint64_t n_members) {
    members_ = static_cast<std::int64_t>(n_members);
    begun_ = true;
  }
  /// A member was destroyed that would have contributed to `next`.
  void remove_member(std::uint32_t next);
  void arrived(std::uint32_t number, Gathered&& gathered);
  /// The next number if it is complete; then it is taken out of the count.
  [[nodiscard]] bool take(Gathered& whole);
  void end(Completion& completion);

  /// The first incomplete number that has contributions, their number and that of its members.
  struct Incomplete {
    std::uint32_t number = 0;
    std::uint64_t n = 0;
    std::int64_t n_members = 0;
  };
  [[nodiscard]] bool first_incomplete(Incomplete& found) const;
  /// It has begun, and all members have been removed.
  [[nodiscard]] bool empty() const { return begun_ && members_of(next_complete_) == 0; }

 private:
  [[nodiscard]] std::int64_t members_of(std::uint32_t number) const;

  bool begun_ = false;
  std::int64_t members_ = 0;
  std::uint32_t next_complete_ = 0;
  std::map<std::uint32_t, std::int64_t> removed_;  // by their next number
  OpenSums<Gathered> whole_;
};

}  // namespace tess::detail
