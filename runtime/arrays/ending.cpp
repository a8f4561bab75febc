#include "runtime/arrays/ending.hpp"

#include "runtime/arrays/collection_action.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/to_all.hpp"

namespace tess::detail {
namespace {

struct End {
  CollectionId id{};
  /// It has ended by another call: this one waits for the same coroutines.
  std::uint64_t drop(Pe& pe) const {
    pe.collections().await_ending(id, Counted::sent(pe.completion(), pe.context().epoch));
    return 0;
  }
};
struct Knock {
  CollectionId id{};
};
struct Free {
  CollectionId id{};
};

void ending_arrives(Collection& collection, End&& /*m*/, Counted counted) {
  Pe& pe = collection.pe();
  std::unique_ptr<HostedCollection> ending = pe.collections().take_out(collection.id());
  collection.end();
  if (collection.n_local() != 0)
    pe.collections().keep_ending(std::move(ending), std::move(counted));
}

void knocking_arrives(Collection& /*collection*/, Knock&& /*m*/, Counted /*counted*/) {}

/// On each PE: a message to the collection, which may not be known there yet, or may have ended.
template <auto Handler>
void pass_on(Pe& pe, typename HandlerType<decltype(Handler)>::Payload&& m, Counted /*counted*/) {
  send_to_collection<Handler>(pe, m.id, pe.id(), m);
}

void freeing_arrives(Pe& pe, Free&& m) {
  const auto ending = pe.collections().take_ending(m.id);  // frees it at the end of this function
}

}  // namespace

void end_collection(CollectionId id) {
  if (id == CollectionId{}) refuse_empty_proxy("destroy() of");
  Pe& pe = current_pe();
  send_to_all<&pass_on<&ending_arrives>>(pe, {id});
}

void wait_everywhere(CollectionId id) {
  if (id == CollectionId{}) refuse_empty_proxy("co_await of");
  send_to_all<&pass_on<&knocking_arrives>>(current_pe(), {id});
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
