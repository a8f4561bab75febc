#include "runtime/pe/hosted_collections.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/report/waiting.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace tess::detail {

struct HostedCollections::Tables {
  template <class Value>
  using ById = boost::unordered_flat_map<CollectionId, Value, std::hash<CollectionId>>;

  ById<std::unique_ptr<HostedCollection>> collections;
  ById<std::vector<Envelope*>> early;
  ById<std::vector<std::uint32_t>> early_joins;
};

HostedCollections::HostedCollections(Pe& pe) : pe_(pe), tables_(std::make_unique<Tables>()) {}
HostedCollections::~HostedCollections() = default;

HostedCollection* HostedCollections::find_slow(CollectionId id) {
  const auto at = tables_->collections.find(id);
  if (at == tables_->collections.end()) return nullptr;
  last_id_ = id;
  last_ = at->second.get();
  return last_;
}

std::vector<HostedCollection*> HostedCollections::all() const {
  std::vector<HostedCollection*> all;
  for (const auto& [id, collection] : tables_->collections) all.push_back(collection.get());
  return all;
}

CollectionId HostedCollections::new_id(LateMessages late) {
  return numbers_.next(pe_.id(), late);
}

void HostedCollections::add(std::unique_ptr<HostedCollection> collection) {
  const CollectionId id = collection->id();
  const bool added = tables_->collections.emplace(id, std::move(collection)).second;
  TESS_CHECK(added, id, " exists already on ", pe_.id());
  last_id_ = none;
  const auto early = tables_->early.find(id);
  if (early == tables_->early.end()) return;
  const std::vector<Envelope*> messages = std::move(early->second);
  tables_->early.erase(early);
  for (Envelope* message : messages) pe_.send_here(message);
}

void HostedCollections::keep_early(CollectionId id, Envelope* message,
                                   std::uint64_t (*drop)(Pe&, Envelope&)) {
  if (ended_.contains(id)) {
    const std::uint64_t n_lost = drop(pe_, *message);
    if (CollectionNumbers::late_messages(id) == LateMessages::counted)
      pe_.statistics().dead_letters += n_lost;
    discard(message);
    return;
  }
  tables_->early[id].push_back(message);
}

void HostedCollections::keep_early_join(CollectionId id, std::uint32_t round) {
  if (!ended_.contains(id)) tables_->early_joins[id].push_back(round);
}

std::vector<std::uint32_t> HostedCollections::take_early_joins(CollectionId id) {
  std::vector<std::uint32_t> rounds = std::move(tables_->early_joins[id]);
  tables_->early_joins.erase(id);
  return rounds;
}

std::unique_ptr<HostedCollection> HostedCollections::take_out(CollectionId id) {
  const auto at = tables_->collections.find(id);
  std::unique_ptr<HostedCollection> collection = std::move(at->second);
  tables_->collections.erase(at);
  last_id_ = none;
  ended_.add(id);
  return collection;
}

void HostedCollections::keep_ending(std::unique_ptr<HostedCollection> collection, Counted end) {
  ending_.push_back({{}, std::move(collection)});
  ending_.back().ends.push_back(std::move(end));
}

auto HostedCollections::find_ending(CollectionId id) -> std::vector<Ending>::iterator {
  return std::find_if(ending_.begin(), ending_.end(),
                      [id](const Ending& one) { return one.collection->id() == id; });
}

void HostedCollections::await_ending(CollectionId id, Counted&& end) {
  if (const auto at = find_ending(id); at != ending_.end()) at->ends.push_back(std::move(end));
}

auto HostedCollections::take_ending(CollectionId id) -> Ending {
  const auto at = find_ending(id);
  Ending taken = std::move(*at);
  ending_.erase(at);
  return taken;
}

void HostedCollections::add_waiting(Waits& waits) const {
  std::vector<std::string> lines;
  for (const HostedCollection* collection : all()) collection->describe_waiting(lines);
  for (std::string& line : lines) waits.add(WaitRank::collective, std::move(line));
  for (const Ending& one : ending_)
    waits.add(WaitRank::collective, text(one.collection->name(), " on ", pe_.id(),
                                         " was destroyed, but coroutines of its elements wait"));
  for (const auto& [id, messages] : tables_->early) {
    const std::size_t n = messages.size();
    waits.add(WaitRank::message,
              text(n, n == 1 ? " message" : " messages", " on ", pe_.id(),
                   n == 1 ? " waits" : " wait", " for the array or group ", id.value,
                   ", which is not known there: is the proxy of an earlier run?"));
  }
}

void HostedCollections::drop_all() {
  for (const auto& [id, messages] : tables_->early)
    for (Envelope* message : messages) discard(message);
  tables_->early.clear();
}

}  // namespace tess::detail
