#include "runtime/balance/rounds/barrier.hpp"

#include "runtime/reduction.hpp"

namespace tess::balance {
namespace {

SyncState& sync_of(Element& element) {
  return Collection::record_of(element)->sync;
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
  for (Element* element : array.elements()) {
    if (element == nullptr) continue;
    SyncState& sync = Collection::make_record(*element).sync;
    if (!sync.known) join_first(sync);
    if (sync.member) tree_.enter(sync.next);
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

void Barrier::join_first(SyncState& sync) {
  sync.known = true;
  sync.member = true;
  sync.next = 0;
  tree_.add_member(0);
}

bool Barrier::entered(Element& element) {
  SyncState& sync = sync_of(element);
  const bool late = !sync.known && !Collection::never_moved(element);
  if (late) join_first(sync);
  sync.known = true;
  if (sync.member) tree_.enter(sync.next);
  if (sync.phase == SyncPhase::waits) {
    if (sync.next == 0) {
      at_sync(element);  // it began to wait on a PE where balancing had not started
    } else if (sync.waits_for < n_resumed_) {
      wake(element);
    }
  }
  return late;
}

void Barrier::left(Element& element) {
  const SyncState& sync = sync_of(element);
  if (!sync.member) return;
  tree_.leave(sync.next);
  tree_.advance();
}

void Barrier::destroyed(Element& element) {
  const SyncState& sync = sync_of(element);
  if (!sync.member) return;
  tree_.remove_member(sync.next);
  tree_.advance();
}

void Barrier::at_sync(Element& element) {
  SyncState& sync = sync_of(element);
  if (sync.member) {
    contribute(sync);
    return;
  }
  sync.member = true;
  sync.next = tree_.joins_at();
  tree_.enter(sync.next);
  tree_.add_member(sync.next);
  if (sync.next > n_resumed_) {
    sync.waits_for = sync.next - 1;
  } else {
    contribute(sync);
  }
}

void Barrier::contribute(SyncState& sync) {
  sync.waits_for = sync.next;
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
    if (sync.phase == SyncPhase::waits && sync.waits_for <= round) wake(*element);
  }
}

void Barrier::wake(Element& element) {
  sync_of(element).phase = SyncPhase::resumes;
  array_->resume(element);
}

std::string Barrier::missing_before(std::uint32_t round) const {
  std::string out;
  std::size_t n = 0;
  if (array_ == nullptr) return out;
  for (const Element* element : array_->elements()) {
    if (element == nullptr) continue;
    const SyncState& sync = Collection::record_of(*element)->sync;
    if (!sync.member || sync.next >= round) continue;
    if (++n <= 5) out += (n > 1 ? ", " : "") + element_text(*element);
  }
  if (n > 5) out += text(" and ", n - 5, " more");
  return out;
}

}  // namespace tess::balance
