// Sorts the hits of one voxel by (owner, other).
#pragma once

#include "collide/hit.hpp"
#include "collide/parallel/object_list.hpp"
#include "collide/parallel/report.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/uninitialised.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace tess::collide {

/// Most hits have the same sources as the hit before, so pairs are copied in runs of equal sources.
class HitSorter {
 public:
  /// Pairs of objects: to both owners, once if they are the same; with `only` to the owner of this
  /// model's object.
  void add(const ObjectList& objects, const std::uint32_t* first, const std::uint32_t* second,
           std::size_t n, const std::optional<ModelId>& only) {
    const bool one_source = objects.sources().size() == 1;
    for (std::size_t begin = 0, end = n; begin < n; begin = end, end = n) {
      const std::uint32_t a = objects.source(first[begin]), b = objects.source(second[begin]);
      if (!one_source) {
        end = begin + 1;
        while (end < n && objects.source(first[end]) == a && objects.source(second[end]) == b)
          ++end;
      }
      const ObjectList::Source &of_a = objects.sources()[a], &of_b = objects.sources()[b];
      const auto copy = [&](const std::uint32_t* mine, std::uint32_t my_source,
                            const std::uint32_t* theirs, std::uint32_t their_source) {
        const OwnerId owner = objects.sources()[my_source].owner;
        LocalPair* out = room(owner, objects.sources()[their_source].owner, end - begin);
        for (std::size_t i = begin; i < end; ++i)
          *out++ = {objects.local(mine[i], my_source), objects.local(theirs[i], their_source)};
      };
      if (!only || of_a.model == *only) copy(first, a, second, b);
      if (only ? of_b.model == *only : of_a.owner != of_b.owner) copy(second, b, first, a);
    }
  }
  [[nodiscard]] bool empty() const noexcept { return lists_.empty(); }
  void send(const Callback<Hits>& call) {
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
  /// Where `n` more hits of `owner` with `other` go.
  LocalPair* room(OwnerId owner, OwnerId other, std::size_t n) {
    if (lists_.empty() || last_->owner != owner || last_->other != other) select(owner, other);
    std::vector<LocalPair>& pairs = last_->pairs;
    if (pairs.empty()) {
      resize_uninitialised(pairs, n);
      return pairs.data();
    }
    pairs.resize(pairs.size() + n);
    return pairs.data() + pairs.size() - n;
  }
  void select(OwnerId owner, OwnerId other) {
    const auto [at, is_new] = where_.try_emplace({owner, other}, lists_.size());
    if (is_new) lists_.push_back(Hits{owner, other, {}});
    last_ = &lists_[at->second];
  }

  boost::unordered_flat_map<Key, std::size_t, Hash> where_;
  std::vector<Hits> lists_;
  Hits* last_ = nullptr;
};

}  // namespace tess::collide
