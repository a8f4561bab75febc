// The collections on a PE by id, and the messages that arrived before their collection was known
// here: they wait in the order of their arrival. Included by sources only, since the hash tables
// are costly to compile.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/messages/envelope.hpp"
#include "runtime/scheduler/interfaces/hosted_collection.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

class CollectionTable {
 public:
  /// Null if it is not known here.
  [[nodiscard]] HostedCollection* find(CollectionId id) const {
    const auto at = collections_.find(id);
    return at == collections_.end() ? nullptr : at->second.get();
  }
  [[nodiscard]] std::vector<HostedCollection*> all() const;
  /// Returns the messages that waited for it.
  [[nodiscard]] std::vector<Envelope*> add(std::unique_ptr<HostedCollection> collection);
  [[nodiscard]] std::unique_ptr<HostedCollection> take_out(CollectionId id);

  void keep_early(CollectionId id, Envelope* message) { early_[id].push_back(message); }
  [[nodiscard]] std::vector<Envelope*> take_all_early();
  /// How many messages wait for which collection.
  [[nodiscard]] std::vector<std::pair<CollectionId, std::size_t>> n_early() const;

 private:
  template <class Value>
  using ById = boost::unordered_flat_map<CollectionId, Value, std::hash<CollectionId>>;

  ById<std::unique_ptr<HostedCollection>> collections_;
  ById<std::vector<Envelope*>> early_;
};

}  // namespace tess::detail
