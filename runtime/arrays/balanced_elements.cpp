#include "runtime/arrays/balanced_elements.hpp"

#include "runtime/arrays/elements/balance_record.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/pe.hpp"

namespace tess::detail {

BalanceRecord& BalancedElements::make_record(Element& element) {
  if (!element.balance_) element.balance_.reset(new BalanceRecord);
  return *element.balance_;
}

void BalancedElements::pack_record(const Element& element, Writer& ar) {
  ar(element.balance_ != nullptr);
  if (element.balance_) element.balance_->pack(ar, current_pe().measuring().start_meter());
}

void BalancedElements::unpack_record(Element& element, Reader& ar) {
  if (ar.take<bool>()) make_record(element).unpack(ar, current_pe().measuring().start_meter());
}

void BalancedElements::drop_record(Pe& pe, Reader& ar) {
  (void)ar.take<ElementState>();
  if (!ar.take<bool>()) return;
  BalanceRecord record;
  record.unpack(ar, pe.measuring().start_meter());
  (void)take_wait(pe, record, SyncPhase::runs);
}

void BalancedElements::at_sync(Element& element) {
  SyncState& sync = make_record(element).sync;
  TESS_CHECK(sync.phase == SyncPhase::runs, element_text(element),
             " calls at_sync() again before it was resumed");
  sync.phase = SyncPhase::waits;
  sync.epoch = Counted::departs(pe_.completion(), pe_.context().epoch);  // it may migrate meanwhile
  sync.led_by = pe_.context().led_by;
  if (watcher_ != nullptr) watcher_->at_sync(element);
}

Counted BalancedElements::take_wait(Pe& pe, BalanceRecord& record, SyncPhase next) {
  if (record.sync.phase != SyncPhase::waits) return {};
  record.sync.phase = next;
  return {pe.completion(), record.sync.epoch};
}

Counted BalancedElements::continue_wait(const Element& element, Envelope& message,
                                        std::uint32_t& led_by) {
  message.epoch = element.balance_->sync.epoch;
  led_by = element.balance_->sync.led_by;
  return take_wait(pe_, *element.balance_, SyncPhase::resumes);
}

bool BalancedElements::awake(Element& element) {
  if (!element.balance_ || element.balance_->sync.phase != SyncPhase::resumes) return false;
  element.balance_->sync.phase = SyncPhase::runs;
  return true;
}

void BalancedElements::ends(Pe& pe, const Element& element) {
  if (!element.balance_) return;
  (void)take_wait(pe, *element.balance_, SyncPhase::runs);
  if (pe.measuring().measures_elements())
    pe.measuring().ended(element.balance_->load.in_run, [&] { return element_text(element); });
}

bool BalancedElements::waits(const Element& element) {
  return element.balance_ && element.balance_->sync.phase != SyncPhase::runs;
}

void BalancedElements::describe_waiting(const std::vector<Element*>& elements,
                                        std::vector<std::string>& lines) const {
  if (watcher_ != nullptr) return;
  for (const Element* element : elements)
    if (element != nullptr && element->balance_ &&
        element->balance_->sync.phase == SyncPhase::waits)
      lines.push_back(element_text(*element) +
                      " waits at at_sync(), but its array has no balancer: start_balancing(array)");
}

void BalancedElements::note_listed(Element& element) {
  if (watcher_ != nullptr) {
    watcher_->entered(element);
  } else {
    element.balance_->load.since = LoadRecord::Since::somewhere;  // this PE does not measure yet
  }
}

void BalancedElements::note_unlisted(Element& element) {
  if (watcher_ != nullptr) watcher_->left(element);
  if (element.balance_)  // it may go on to another PE of this process
    pe_.measuring().forget(element.balance_->load);
}

void BalancedElements::destroyed(Element& element) {
  if (watcher_ != nullptr) {
    watcher_->destroyed(element);
  } else if (known(element)) {  // a later observer has to know
    unwatched_ends_.push_back(element.balance_->sync.next);
  }
}

void BalancedElements::collection_ends() {
  if (watcher_ != nullptr) watcher_->collection_ends();
  watcher_ = nullptr;
}

bool BalancedElements::known(const BalanceRecord& record) {
  return record.sync.entry != SyncEntry::none;
}

}  // namespace tess::detail
