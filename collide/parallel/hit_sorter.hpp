// Sorts the hits of one voxel by (owner, other).
#pragma once

#include "collide/hit.hpp"
#include "collide/hit_receivers.hpp"
#include "collide/parallel/object_list.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/uninitialised.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <utility>
#include <vector>

namespace tess::collide {

/// Most hits have the same sources as the hit before, so pairs are copied in runs of equal sources.
class HitSorter {
 public:
  /// One side of pairs: objects of a list, one per pair.
  struct Side {
    const ObjectList& list;
    const std::uint32_t* objects;
  };

  /// Pairs of objects that are found on a PE, to the owners that `to` names.
  void add(const Side& first, const Side& second, std::size_t n, const HitReceivers& to,
           PeId found_on) {
    const auto sources_of = [&](std::size_t i) {
      return std::pair(first.list.source(first.objects[i]), second.list.source(second.objects[i]));
    };
    const bool one_source = first.list.sources().size() == 1 && second.list.sources().size() == 1;
    for (std::size_t begin = 0, end = n; begin < n; begin = end, end = n) {
      const auto sources = sources_of(begin);
      if (!one_source) {
        end = begin + 1;
        while (end < n && sources_of(end) == sources) ++end;
      }
      const ObjectList::Source &of_a = first.list.sources()[sources.first],
                               &of_b = second.list.sources()[sources.second];
      const auto copy = [&](const Side& mine, std::uint32_t my_source, const Side& theirs,
                            std::uint32_t their_source) {
        const OwnerId owner = mine.list.sources()[my_source].owner;
        LocalPair* out = room(owner, theirs.list.sources()[their_source].owner, end - begin);
        for (std::size_t i = begin; i < end; ++i)
          *out++ = {mine.list.local(mine.objects[i], my_source),
                    theirs.list.local(theirs.objects[i], their_source)};
      };
      const auto [to_a, to_b] = receivers(of_a, of_b, to, found_on);
      if (to_a) copy(first, sources.first, second, sources.second);
      if (to_b) copy(second, sources.second, first, sources.first);
    }
  }
  [[nodiscard]] bool empty() const noexcept { return lists_.empty(); }
  /// A pair counts for each owner that receives it.
  [[nodiscard]] std::size_t size() const noexcept {
    std::size_t n = 0;
    for (const Hits& hits : lists_) n += hits.pairs.size();
    return n;
  }
  void send(const Callback<Hits>& call) {
    for (Hits& hits : lists_) call(std::move(hits));
  }

 private:
  /// Whether the owners of a pair's objects receive it.
  [[nodiscard]] static std::pair<bool, bool> receivers(const ObjectList::Source& a,
                                                       const ObjectList::Source& b,
                                                       const HitReceivers& to, PeId found_on) {
    if (to.only) {
      const bool to_a = a.model == *to.only;
      return {to_a, b.model == *to.only && !(to_a && a.owner == b.owner)};
    }
    if (a.owner == b.owner) return {true, false};
    if (to.receivers == Receivers::both_owners) return {true, true};
    const bool to_b = a.pe != found_on && b.pe == found_on;
    return {!to_b, to_b};
  }

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
