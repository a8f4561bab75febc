// What a balancer needs of a collection on one PE: it observes elements that come and go, keeps a
// record for each of them, which migrates with the element, and lets those that have called
// at_sync() wait until it resumes them. Without a balancer elements wait all the same, and what a
// later one has to know is counted here.
#pragma once

#include "runtime/arrays/elements/element.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess::detail {

class Pe;
enum class SyncPhase : std::uint8_t;

/// Observes the elements of a collection on one PE.
class ElementWatcher {
 public:
  ElementWatcher() = default;
  ElementWatcher(const ElementWatcher&) = delete;
  ElementWatcher& operator=(const ElementWatcher&) = delete;
  virtual ~ElementWatcher() = default;

  /// The element is listed here from now on: it was created here or arrived from another PE.
  virtual void entered(Element& element) = 0;
  /// The element is no longer listed here.
  virtual void left(Element& element) = 0;
  /// The element is destroyed; called after left().
  virtual void destroyed(Element& element) = 0;
  virtual void at_sync(Element& element) = 0;
  /// The collection ends on this PE. Its elements are still listed; no calls follow.
  virtual void collection_ends() = 0;
};

class BalancedElements {
 public:
  explicit BalancedElements(Pe& pe) : pe_(pe) {}
  BalancedElements(const BalancedElements&) = delete;
  BalancedElements& operator=(const BalancedElements&) = delete;
  ~BalancedElements() = default;

  /// The observer of elements that come and go here; null if there is none.
  [[nodiscard]] ElementWatcher* watcher() const { return watcher_; }
  void watch(ElementWatcher& watcher) { watcher_ = &watcher; }
  void unwatch() { watcher_ = nullptr; }

  // Records.

  /// The record of an element; null unless a balancer or --stats requested it.
  [[nodiscard]] static BalanceRecord* record_of(const Element& element) {
    return element.balance_.get();
  }
  static BalanceRecord& make_record(Element& element);
  /// A migrating element takes its record along, if it has one.
  static void pack_record(const Element& element, Writer& ar);
  static void unpack_record(Element& element, Reader& ar);
  /// The element of this state arrives after the end of its collection: releases the epoch of its
  /// wait at a barrier.
  static void drop_record(Pe& pe, Reader& ar);
  /// True if the element has not migrated yet.
  [[nodiscard]] static bool never_moved(const Element& element) {
    return element.state_.version.epoch <= 1;
  }
  /// True if only the element's constructor has run, here or elsewhere.
  [[nodiscard]] static bool never_ran(const Element& element) {
    return never_moved(element) && !element.has_run_;
  }

  // Waits at the barrier.

  /// The element waits until its balancer resumes it.
  void at_sync(Element& element);
  /// Gives the message that resumes the element the epoch and the broadcast of its wait. The wait is
  /// over once the message is sent.
  [[nodiscard]] Counted continue_wait(const Element& element, Envelope& message,
                                      std::uint32_t& led_by);
  /// The message of resume() has arrived. Returns false if it was sent to an earlier incarnation of
  /// the element; then the wait of this one, if it waits, goes on.
  [[nodiscard]] static bool awake(Element& element);
  /// The element is being destroyed: releases the epoch of its wait. With --stats its load may be
  /// the largest.
  static void ends(Pe& pe, const Element& element);
  /// True if the element waits, or the message that resumes it is under way.
  [[nodiscard]] static bool waits(const Element& element);
  /// Appends a line for each of these elements that waits although there is no balancer.
  void describe_waiting(const std::vector<Element*>& elements,
                        std::vector<std::string>& lines) const;

  // The collection calls these for elements that come and go.

  void listed(Element& element) {
    if (watcher_ != nullptr || element.balance_) [[unlikely]]
      note_listed(element);
  }
  void unlisted(Element& element) {
    if (watcher_ != nullptr || element.balance_) [[unlikely]]
      note_unlisted(element);
  }
  void departs(const Element& element) { n_away_ += known(element) ? 0 : 1; }
  void arrives(const Element& element) { n_away_ -= known(element) ? 0 : 1; }
  void destroyed(Element& element);
  void collection_ends();

  /// Migrations from this PE minus those to it, of elements that no barrier knows. The sum over all
  /// PEs is the number of such elements under way.
  [[nodiscard]] std::int64_t n_away() const { return n_away_; }
  /// The next rounds of the members of the barrier that were destroyed here before there was an
  /// observer.
  [[nodiscard]] std::vector<std::uint32_t> take_unwatched_ends() {
    return std::exchange(unwatched_ends_, {});
  }

 private:
  void note_listed(Element& element);
  void note_unlisted(Element& element);
  /// True if a barrier has seen the element.
  [[nodiscard]] static bool known(const Element& element) {
    return element.balance_ && known(*element.balance_);
  }
  [[nodiscard]] static bool known(const BalanceRecord& record);
  /// The wait of this element at its barrier, if it waits, which it does no longer.
  [[nodiscard]] static Counted take_wait(Pe& pe, BalanceRecord& record, SyncPhase next);

  Pe& pe_;
  ElementWatcher* watcher_ = nullptr;
  std::int64_t n_away_ = 0;
  std::vector<std::uint32_t> unwatched_ends_;
};

}  // namespace tess::detail
