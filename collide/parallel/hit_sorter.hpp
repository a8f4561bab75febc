// Sorts the hits of one voxel by (owner, other).
#pragma once

#include "collide/hit.hpp"
#include "collide/parallel/report.hpp"
#include "runtime/core/hash.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace tess::collide {

/// Most hits have the same owners as the hit before, so the list is looked up again only if the
/// owners change.
class HitSorter {
 public:
  /// To both owners, once if they are the same; with `only` to the owner of this model's object.
  void add(const ObjectId& a, const ObjectId& b, const std::optional<ModelId>& only) {
    if (!only || a.model == *only) add(a, b);
    if (only ? b.model == *only : a.owner != b.owner) add(b, a);
  }
  void send(const Callback<Hits>& call) {
    if (lists_.empty()) return;
    for (Hits& hits : lists_) call(std::move(hits));
  }

 private:
  using Key = std::pair<OwnerId, OwnerId>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return mix(static_cast<std::uint64_t>(key.first) ^
                 mix(static_cast<std::uint64_t>(key.second)));
    }
  };
  void add(const ObjectId& mine, const ObjectId& theirs) {
    if (pairs_ == nullptr || mine.owner != owner_ || theirs.owner != other_) [[unlikely]]
      select(mine.owner, theirs.owner);
    pairs_->push_back({mine.local, theirs.local});
  }
  void select(OwnerId owner, OwnerId other) {
    constexpr std::size_t capacity = 64;
    const auto [at, is_new] = where_.try_emplace({owner, other}, lists_.size());
    if (is_new) lists_.push_back(Hits{owner, other, {}});
    pairs_ = &lists_[at->second].pairs;
    if (is_new) pairs_->reserve(capacity);
    owner_ = owner;
    other_ = other;
  }

  boost::unordered_flat_map<Key, std::size_t, Hash> where_;
  std::vector<Hits> lists_;
  OwnerId owner_{}, other_{};
  std::vector<LocalPair>* pairs_ = nullptr;
};

}  // namespace tess::collide
