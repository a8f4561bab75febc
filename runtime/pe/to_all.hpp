// A message to all PEs that involves no chare. Each PE passes it on along the tree that begins at
// the sender, so that no PE sends more than a few.
#pragma once

#include "runtime/base/spanning_tree.hpp"
#include "runtime/pe/pe_action.hpp"

#include <utility>

namespace tess::detail {

template <class Payload>
struct ToAll {
  PeId root{};
  Payload payload{};
  template <class Ar>
  void serialize(Ar& ar) {
    ar(root, payload);
  }
};

template <auto Handler>
void to_all_arrives(Pe& pe, ToAll<typename PeAction<Handler>::Payload>&& m, Counted counted) {
  const SpanningTree tree(pe.id(), m.root, pe.n_pes());
  for (std::int32_t slot = 0; slot < tree.n_children(); ++slot)
    send_system<&to_all_arrives<Handler>>(pe, tree.child(slot), m);
  Handler(pe, std::move(m.payload), std::move(counted));
}

/// Passes a payload to the handler on all PEs; here at once. Each counts in the current epoch.
template <auto Handler>
void send_to_all(Pe& pe, typename PeAction<Handler>::Payload payload) {
  to_all_arrives<Handler>(pe, {pe.id(), std::move(payload)},
                          Counted::sent(pe.completion(), pe.context().epoch));
}

}  // namespace tess::detail
