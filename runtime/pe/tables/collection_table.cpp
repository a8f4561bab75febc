#include "runtime/pe/tables/collection_table.hpp"

namespace tess::detail {

std::vector<HostedCollection*> CollectionTable::all() const {
  std::vector<HostedCollection*> all;
  for (const auto& [id, collection] : collections_) all.push_back(collection.get());
  return all;
}

std::vector<Envelope*> CollectionTable::add(std::unique_ptr<HostedCollection> collection) {
  const CollectionId id = collection->id();
  collections_.emplace(id, std::move(collection));
  const auto early = early_.find(id);
  if (early == early_.end()) return {};
  std::vector<Envelope*> messages = std::move(early->second);
  early_.erase(early);
  return messages;
}

std::unique_ptr<HostedCollection> CollectionTable::take_out(CollectionId id) {
  const auto at = collections_.find(id);
  std::unique_ptr<HostedCollection> collection = std::move(at->second);
  collections_.erase(at);
  return collection;
}

std::vector<Envelope*> CollectionTable::take_all_early() {
  std::vector<Envelope*> all;
  for (const auto& [id, messages] : early_) all.insert(all.end(), messages.begin(), messages.end());
  early_.clear();
  return all;
}

std::vector<std::pair<CollectionId, std::size_t>> CollectionTable::n_early() const {
  std::vector<std::pair<CollectionId, std::size_t>> all;
  for (const auto& [id, messages] : early_) all.emplace_back(id, messages.size());
  return all;
}

}  // namespace tess::detail
