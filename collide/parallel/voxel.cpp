#include "collide/parallel/voxel.hpp"

#include "collide/serial/pair_search.hpp"
#include "collide/serial/voxel_grid.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

namespace tess {
namespace {

/// Gathers the hits of one voxel by (owner, other).
class Sorter {
 public:
  void add(const ObjectId& mine, const ObjectId& theirs) {
    if (lists_.empty() || mine.owner != last_.first || theirs.owner != last_.second)
      select({mine.owner, theirs.owner});
    lists_[at_].pairs.push_back({mine.local, theirs.local});
  }
  void send(const Callback<Hits>& call) {
    for (Hits& hits : lists_) call(std::move(hits));
  }

 private:
  using Key = std::pair<OwnerId, OwnerId>;
  void select(const Key& key) {
    const auto [at, is_new] = where_.try_emplace(key, lists_.size());
    if (is_new) lists_.push_back(Hits{key.first, key.second, {}});
    at_ = at->second;
    last_ = key;
  }
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return mix(static_cast<std::uint64_t>(key.first) ^
                 mix(static_cast<std::uint64_t>(key.second)));
    }
  };
  boost::unordered_flat_map<Key, std::size_t, Hash> where_;
  std::vector<Hits> lists_;
  std::size_t at_ = 0;
  Key last_{};
};

}  // namespace

void Voxel::add(std::vector<Item> items) {
  if (items_.empty()) {
    items_ = std::move(items);
  } else {
    items_.insert(items_.end(), items.begin(), items.end());
  }
}

void Voxel::start_collision(const Collision& collision) {
  const std::vector<Item> items = std::exchange(items_, {});
  if (items.empty()) return;

  const VoxelGrid grid(collision.origin, collision.size);
  const Cell here{index().x, index().y, index().z};
  Sorter sorter;
  PairSearch search(collision.rules);
  search.for_each_pair(items, here, grid, [&](const Item& a, const Item& b) {
    const auto& only = collision.report.only;
    if (!only || a.id.model == *only) sorter.add(a.id, b.id);
    if ((!only && a.id.owner != b.id.owner) || (only && b.id.model == *only))
      sorter.add(b.id, a.id);
  });
  sorter.send(collision.report.call);
}

}  // namespace tess
