// The children of a PE in a tree, and whose reports it waits for. In a tree of all PEs that is each
// child, for each number. In a tree whose PEs attach it is a child from the number on that it names
// when it attaches, until it detaches.
#pragma once

#include "runtime/base/spanning_tree.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/reduce/reduction_messages.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

class TreeChildren {
 public:
  TreeChildren(const SpanningTree& tree, bool attached) : tree_(tree) {
    for (const PeId pe : tree.children()) children_.push_back(Child{pe, {}, attached});
  }

  /// Messages of a child arrive in any order: the newest one counts. A report says that the child is
  /// attached, too.
  void learn(const ReductionReport& report) {
    Child& one = children_[slot_of(report.child)];
    const bool attached = report.what != ReductionReport::What::detached;
    // Of two messages of one time the detachment is the later.
    if (report.as.time < one.as.time || (report.as.time == one.as.time && attached)) return;
    one.as = report.as;
    one.attached = attached;
  }
  /// The child was still attached, by what is known, when it sent the report.
  [[nodiscard]] bool counts(const ReductionReport& report) const {
    const Child& one = children_[slot_of(report.child)];
    return one.attached && one.as.time == report.as.time;
  }

  [[nodiscard]] bool any_attached() const {
    return std::any_of(children_.begin(), children_.end(),
                       [](const Child& one) { return one.attached; });
  }
  /// The lowest of these numbers: `bound`, and those that attached children report from.
  [[nodiscard]] std::uint32_t first_below(std::uint32_t bound) const {
    for (const Child& one : children_)
      if (one.attached) bound = std::min(bound, one.as.from);
    return bound;
  }

  // The children that have reported a number, as bits. No child reports a number twice: when it
  // attaches again it names a number that it has not reported.

  [[nodiscard]] std::uint32_t bit(PeId child) const { return 1U << slot_of(child); }
  [[nodiscard]] bool have_reported(std::uint32_t number, std::uint32_t reported) const {
    for (std::size_t slot = 0; slot < children_.size(); ++slot) {
      const Child& one = children_[slot];
      if (one.attached && one.as.from <= number && (reported >> slot & 1U) == 0) return false;
    }
    return true;
  }

  [[nodiscard]] auto begin() const { return children_.begin(); }
  [[nodiscard]] auto end() const { return children_.end(); }

 private:
  struct Child {
    PeId pe;
    Attachment as;  // the latest that is known
    bool attached = false;
  };
  [[nodiscard]] std::size_t slot_of(PeId pe) const {
    return static_cast<std::size_t>(tree_.slot_of(pe));
  }

  const SpanningTree tree_;
  std::vector<Child> children_;  // by slot
};

}  // namespace tess::detail
