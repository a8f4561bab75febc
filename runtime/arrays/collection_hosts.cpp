#include "runtime/arrays/collection_hosts.hpp"

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/collection_action.hpp"
#include "runtime/wire/messages/entry_attributes.hpp"

namespace tess::detail {
namespace {

void start_arrives(Collection& collection, NumberedCall&& m, Counted counted) {
  m.n_complete = collection.reductions().n_complete();
  collection.broadcasts().on_start(std::move(m), std::move(counted));
}
void call_arrives(Collection& collection, NumberedCall&& m, Counted counted) {
  collection.broadcasts().on_call(std::move(m), std::move(counted));
}
void settled_arrives(Collection& collection, BroadcastSettled&& m) {
  collection.broadcasts().on_settled(m);
}
void drop_arrives(Collection& collection, BroadcastDrop&& m) {
  collection.broadcasts().on_drop(m);
}

template <Track track>
void report_arrives(Collection& collection, ReductionReport&& m) {
  collection.tree(track).on_report(std::move(m));
}
template <Track track>
void begin_arrives(Collection& collection, ReductionBegin&& m) {
  collection.tree(track).on_begin(m);
}

}  // namespace

void start_broadcast(CollectionId collection, SharedCall call) {
  if (collection == CollectionId{}) [[unlikely]]
    refuse_empty_proxy(text("a broadcast of ", plain_name(call->action().name()), " to"));
  Pe& pe = current_pe();
  Writer count{std::span<std::byte>()};
  call->pack(count);  // may throw
  send_to_collection<&start_arrives>(
      pe, collection, root_of(collection, pe.n_pes()),
      NumberedCall{0, pe.context().epoch, std::move(call), 0, count.n_bytes()});
}

std::int64_t ReductionReport::priority() const {
  return expedites ? expedited.value : 0;
}
std::int64_t ReductionBegin::priority() const {
  return expedites ? expedited.value : 0;
}
std::uint64_t ReductionReport::drop(Pe& pe) const {
  settle(pe.completion(), sum.shares);
  return 0;
}

void BroadcastHostOfCollection::send(PeId to, const NumberedCall& call) {
  send_to_collection<&call_arrives>(collection_, to, call);
}
void BroadcastHostOfCollection::send(PeId to, const BroadcastSettled& settled) {
  send_to_collection<&settled_arrives>(collection_, to, settled);
}
void BroadcastHostOfCollection::send(PeId to, const BroadcastDrop& drop) {
  send_to_collection<&drop_arrives>(collection_, to, drop);
}

void BroadcastHostOfCollection::flush() {
  collection_.pe().peers().flush();
}

void BroadcastHostOfCollection::apply(const NumberedCall& call) {
  collection_.apply(call);
  collection_.reductions().applied(call.number, call.n_complete);
}

void ReductionHostOfCollection::send(PeId to, ReductionReport&& report) {
  report.expedites = expedites_;
  if (report.sum.value.held) report.sum.value.held->leave();
  if (track_ == Track::own) {
    send_to_collection<&report_arrives<Track::own>>(collection_, to, std::move(report));
  } else {
    send_to_collection<&report_arrives<Track::second>>(collection_, to, std::move(report));
  }
}
void ReductionHostOfCollection::send(PeId to, const ReductionBegin& begin) {
  ReductionBegin sent = begin;
  sent.expedites = expedites_;
  if (track_ == Track::own) {
    send_to_collection<&begin_arrives<Track::own>>(collection_, to, sent);
  } else {
    send_to_collection<&begin_arrives<Track::second>>(collection_, to, sent);
  }
}

std::uint64_t ReductionHostOfCollection::applied_broadcast() const {
  return collection_.broadcasts().applied();
}

void ReductionHostOfCollection::postpone_new_elements() {
  collection_.postpone_new_elements();
}

void ReductionHostOfCollection::deliver(Partial& result, EpochId epoch) {
  collection_.deliver(result, epoch, {});
}

}  // namespace tess::detail
