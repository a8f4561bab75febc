#include "collide/parallel/voxel.hpp"

#include "collide/serial/pair_search.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <optional>
#include <utility>

namespace tess::collide {
namespace {

/// Sorts the hits of one voxel by (owner, other). Most hits have the same owners as the hit before,
/// so the list is looked up again only if the owners change.
class Sorter {
 public:
  void add(const ObjectId& mine, const ObjectId& theirs) {
    if (pairs_ == nullptr || mine.owner != owner_ || theirs.owner != other_) [[unlikely]]
      select(mine.owner, theirs.owner);
    pairs_->push_back({mine.local, theirs.local});
  }
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
  if (items.empty()) {
    destroy();
    return;
  }
  const VoxelGrid grid(collision.origin, collision.size);
  const Cell here{index().x, index().y, index().z};
  const std::optional<ModelId> only = collision.report.only;
  serial::PairSearch search(collision.rules);
  Sorter sorter;
  search.for_each_pair(items, here, grid, [&](const Item& a, const Item& b) {
    if (!only || a.id.model == *only) sorter.add(a.id, b.id);
    if ((!only && a.id.owner != b.id.owner) || (only && b.id.model == *only))
      sorter.add(b.id, a.id);
  });
  sorter.send(collision.report.call);
}

}  // namespace tess::collide
