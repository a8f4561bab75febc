#include "runtime/balance/rounds/barrier.hpp"

#include "runtime/reduction.hpp"

namespace tess::balance {
namespace {

SyncState& sync_of(Element& element) {
  return BalancedElements::record_of(element)->sync;
}

}  // namespace

Barrier::Barrier(Pe& pe, Collection& group, PeId coordinator, Callback<std::uint64_t> reached)
    : reached_(std::move(reached)),
      host_(group, Track::second),
      tree_(host_, pe.completion(), pe.id(), coordinator, pe.n_pes(),
            {group.name() + ": balance round",
             [this](std::uint32_t round) { return missing_before(round); }}) {
  group.set_second_tree(tree_);
  tree_.enter(0);
}

void Barrier::attach(Collection& array) {
  array_ = &array;
  for (const std::uint32_t next : array.balanced().take_unwatched_ends()) tree_.remove_member(next);
  for (Element* element : array.elements()) {
    if (element == nullptr) continue;
    SyncState& sync = BalancedElements::make_record(*element).sync;
    if (sync.entry == SyncEntry::none) join(sync, 0);
    tree_.enter(sync.next);
  }
  for (Element* element : array.elements()) {
    if (element == nullptr) continue;
    const SyncState& sync = sync_of(*element);
    if (sync.phase == SyncPhase::waits && sync.next == 0) at_sync(*element);
  }
}

void Barrier::begin() {
  tree_.leave(0);
  tree_.advance();
}

void Barrier::detach() {
  for (const auto& [ticket, element] : newcomers_) Collection::release(*element);
  newcomers_.clear();
  array_ = nullptr;
}

void Barrier::join(SyncState& sync, std::uint32_t round) {
  sync.entry = SyncEntry::member;
  sync.next = round;
  tree_.add_member(round);
}

Barrier::Entrant Barrier::entered(Element& element) {
  SyncState& sync = sync_of(element);
  const bool first_here = sync.entry == SyncEntry::none;
  const bool created = first_here && BalancedElements::never_moved(element);
  if (created && n_resumed_ != tree_.joins_at()) return Entrant::newcomer;
  if (first_here) join(sync, created ? n_resumed_ : 0);
  tree_.enter(sync.next);
  if (sync.phase == SyncPhase::waits) {
    if (sync.next == 0) {
      at_sync(element);  // it began to wait on a PE where balancing had not started
    } else if (sync.next <= n_resumed_) {
      array_->resume(element);
    }
  }
  return first_here && !created ? Entrant::late : Entrant::usual;
}

std::uint32_t Barrier::hold(Element& element) {
  Collection::hold(element);
  sync_of(element).entry = SyncEntry::held;
  newcomers_.emplace(n_tickets_, &element);
  return n_tickets_++;
}

void Barrier::joins(std::uint32_t ticket, std::uint32_t round) {
  const auto at = newcomers_.find(ticket);
  if (at == newcomers_.end()) return;  // the array has ended here
  Element& element = *at->second;
  newcomers_.erase(at);
  SyncState& sync = sync_of(element);
  sync.entry = SyncEntry::member;
  sync.next = round;
  tree_.enter(round);
  if (sync.phase == SyncPhase::waits) contribute(sync);
  Collection::release(element);
  array_->settle(element);
}

void Barrier::left(Element& element) {
  tree_.leave(sync_of(element).next);
  tree_.advance();
}

void Barrier::destroyed(Element& element) {
  const SyncState& sync = sync_of(element);
  if (sync.entry == SyncEntry::none)
    return;  // balancing has not started here, nor where it came from
  tree_.remove_member(sync.next);
  tree_.advance();
}

void Barrier::at_sync(Element& element) {
  SyncState& sync = sync_of(element);
  if (sync.entry == SyncEntry::member) contribute(sync);  // else joins() does
}

void Barrier::contribute(SyncState& sync) {
  // The wait itself belongs to the element's epoch. Messages of a round belong to no epoch:
  // otherwise every PE would report each of them to that epoch's coordinator.
  tree_.contribute(sync.next++, EpochId{},
                   std::make_unique<MergedPartial<std::uint64_t, Sum>>(Sum{}, 1, reached_));
}

void Barrier::resume(std::uint32_t round) {
  n_resumed_ = std::max(n_resumed_, round + 1);
  if (array_ == nullptr) return;
  for (Element* element : array_->elements()) {
    if (element == nullptr) continue;
    const SyncState& sync = sync_of(*element);
    const bool waits = sync.entry == SyncEntry::member && sync.phase == SyncPhase::waits;
    if (waits && sync.next <= n_resumed_) array_->resume(*element);
  }
}

std::string Barrier::missing_before(std::uint32_t round) const {
  FirstFew missing;
  if (array_ == nullptr) return {};
  for (const Element* element : array_->elements()) {
    if (element == nullptr) continue;
    const SyncState& sync = BalancedElements::record_of(*element)->sync;
    if (sync.entry != SyncEntry::member || sync.next >= round) continue;
    missing.add([element] { return element_text(*element); });
  }
  return missing.text();
}

}  // namespace tess::balance
