#include "runtime/collections/broadcast_log.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/collections/collection.hpp"
#include "runtime/collections/collection_action.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

// Settled broadcasts are reported to the root in portions, so that a broadcast costs no reply.
constexpr std::uint64_t portion = 16;

void start_arrives(Collection& collection, NumberedCall&& m) {
  collection.broadcasts().on_start(std::move(m));
}
void call_arrives(Collection& collection, NumberedCall&& m) {
  collection.broadcasts().on_call(std::move(m));
}
void settled_arrives(Collection& collection, BroadcastLog::Settled&& m) {
  collection.broadcasts().on_settled(m);
}
void drop_arrives(Collection& collection, BroadcastLog::Drop&& m) {
  collection.broadcasts().on_drop(m);
}

}  // namespace

BroadcastLog::BroadcastLog(Pe& pe, Collection& collection)
    : pe_(pe),
      collection_(collection),
      children_(SpanningTree(pe.id(), collection.root(), pe.n_pes()).children()) {}

void start_broadcast(CollectionId collection, SharedCall call) {
  Pe& pe = current_pe();
  const EpochId epoch = pe.context().epoch;
  pe.completion().sent(epoch);
  send_to_collection<&start_arrives>(pe, collection, root_of(collection, pe.n_pes()),
                                     NumberedCall{0, epoch, std::move(call)});
}

void BroadcastLog::on_start(NumberedCall&& call) {
  call.number = ++last_number_;
  call.n_complete = collection_.reductions().n_complete();
  on_call(std::move(call));
}

void BroadcastLog::on_call(NumberedCall&& call) {
  for (const PeId child : children_) {
    pe_.completion().sent(call.epoch);
    send_to_collection<&call_arrives>(collection_, child, call);
  }
  pe_.flush();  // other processes do not wait for the local elements
  early_.emplace(call.number, std::move(call));
  while (!early_.empty() && early_.begin()->first == applied_ + 1) {
    copies_.push_back(std::move(early_.begin()->second));
    early_.erase(early_.begin());
    ++applied_;
    const NumberedCall current = copies_.back();
    collection_.apply(current);
    collection_.reductions().applied(current.number, current.n_complete);
    settle();
  }
}

void BroadcastLog::arrived(std::uint64_t seen) {
  const auto at = in_flight_.find(seen);
  if (--at->second == 0) in_flight_.erase(at);
  settle();
}

void BroadcastLog::settle() {
  const std::uint64_t now =
      in_flight_.empty() ? applied_ : std::min(applied_, in_flight_.begin()->first);
  while (settled_ < now) {
    ++settled_;
    pe_.completion().processed(copies_[settled_ - first_kept_].epoch);
  }
  if (settled_ - told_ < portion) return;
  told_ = settled_;
  send_to_collection<&settled_arrives>(collection_, collection_.root(),
                                       Settled{pe_.id(), settled_});
}

void BroadcastLog::end() {
  while (settled_ < applied_) {
    ++settled_;
    copies_[settled_ - first_kept_].drop(pe_);
  }
  for (const auto& [number, call] : early_) call.drop(pe_);
  copies_.clear();
  early_.clear();
  in_flight_.clear();
}

std::uint64_t NumberedCall::drop(Pe& pe) const {
  pe.completion().processed(epoch);
  return number == 0 ? 1 : 0;
}

std::vector<NumberedCall> BroadcastLog::missed(std::uint64_t seen) const {
  std::vector<NumberedCall> calls;
  for (std::uint64_t number = seen + 1; number <= applied_; ++number)
    calls.push_back(copies_.at(number - first_kept_));
  return calls;
}

void BroadcastLog::on_settled(const Settled& settled) {
  std::uint64_t& known = settled_by_[settled.from];
  known = std::max(known, settled.number);
  if (settled_by_.size() < static_cast<std::size_t>(pe_.n_pes())) return;
  std::uint64_t all = known;
  for (const auto& [pe, number] : settled_by_) all = std::min(all, number);
  if (all == dropped_) return;
  dropped_ = all;
  for (std::int32_t pe = 0; pe < pe_.n_pes(); ++pe)
    send_to_collection<&drop_arrives>(collection_, PeId{pe}, Drop{all});
}

void BroadcastLog::on_drop(const Drop& drop) {
  while (first_kept_ <= drop.number) {
    copies_.pop_front();
    ++first_kept_;
  }
}

}  // namespace tess::detail
