// The collections on a PE by id, and the messages that arrived before their collection was known
// here: they wait in the order of their arrival. Included by sources only, since the hash tables
// are costly to compile.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/interfaces/hosted_collection.hpp"
#include "runtime/wire/messages/envelope.hpp"

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
  /// Rounds at which elements join that were inserted from this PE before the collection was known
  /// here; taken when it is.
  void keep_early_join(CollectionId id, std::uint32_t round) { early_joins_[id].push_back(round); }
  [[nodiscard]] std::vector<std::uint32_t> take_early_joins(CollectionId id) {
    std::vector<std::uint32_t> rounds = std::move(early_joins_[id]);
    early_joins_.erase(id);
    return rounds;
  }
  [[nodiscard]] std::vector<Envelope*> take_all_early();
  /// How many messages wait for which collection.
  [[nodiscard]] std::vector<std::pair<CollectionId, std::size_t>> n_early() const;

 private:
  template <class Value>
  using ById = boost::unordered_flat_map<CollectionId, Value, std::hash<CollectionId>>;

  ById<std::unique_ptr<HostedCollection>> collections_;
  ById<std::vector<Envelope*>> early_;
  ById<std::vector<std::uint32_t>> early_joins_;
};

}  // namespace tess::detail
