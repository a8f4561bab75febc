#include "runtime/collections/ending.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/collections/collection_action.hpp"
#include "runtime/scheduler/pe_action.hpp"

namespace tess::detail {
namespace {

/// Each PE passes it on along the tree that begins at the sender.
struct End {
  CollectionId id{};
  EpochId epoch{};
  PeId root{};

  /// An end that came another way was here before.
  std::uint64_t drop(Pe& pe) const;
};
struct Free {
  CollectionId id{};
};

void ending_arrives(Collection& collection, End&& m);

void send(Pe& pe, PeId to, const End& end) {
  pe.completion().sent(end.epoch);
  send_to_collection<&ending_arrives>(pe, end.id, to, end);
}

void pass_on(Pe& pe, const End& end) {
  const SpanningTree tree(pe.id(), end.root, pe.n_pes());
  for (std::int32_t slot = 0; slot < tree.n_children(); ++slot) send(pe, tree.child(slot), end);
}

std::uint64_t End::drop(Pe& pe) const {
  pass_on(pe, *this);
  pe.completion().processed(epoch);
  return 0;
}

void ending_arrives(Collection& collection, End&& m) {
  Pe& pe = collection.pe();
  pass_on(pe, m);
  std::unique_ptr<HostedCollection> ending = pe.take_out(collection.id());
  collection.end();
  if (collection.n_local() != 0) {
    pe.keep_ending(std::move(ending), m.epoch);
    return;
  }
  ending.reset();
  pe.completion().processed(m.epoch);
}

void freeing_arrives(Pe& pe, Free&& m) {
  const Pe::Ending ending = pe.take_ending(m.id);
  static_cast<Collection&>(*ending.collection)
      .reductions()
      .end();  // the last coroutines may have contributed
  pe.completion().processed(ending.epoch);
}

}  // namespace

void end_collection(CollectionId id) {
  if (id == CollectionId{}) refuse_empty_proxy("destroy() of");
  Pe& pe = current_pe();
  send(pe, pe.id(), {id, pe.context().epoch, pe.id()});
}

bool in_running_program() {
  const Pe* const pe = current_pe_or_null();
  return pe != nullptr && !pe->stopped() && !pe->dropping();
}

void free_later(Collection& collection) {
  Pe& pe = collection.pe();
  send_system<&freeing_arrives>(pe, pe.id(), Free{collection.id()});
}

}  // namespace tess::detail
