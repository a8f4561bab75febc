#include "collide/parallel/kept_pairs.hpp"

#include "collide/pairs.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace tess::collide {
namespace {

/// A PE with so many objects keeps at most so many pairs.
std::size_t most_kept(std::size_t n_objects) {
  return 32 * n_objects + (std::size_t{1} << 16);
}

}  // namespace

bool are_far_too_many(const Summary& larger, const PairRules& rules, std::int32_t n_pes) {
  constexpr double factor = 8;  // what a sample is certain of, and what is not too long
  if (larger.sample.empty()) return false;
  const double n = static_cast<double>(larger.n);
  const double scale = n / static_cast<double>(larger.sample.size());
  double n_pairs = 0;
  PairOptions options{.touching = rules.touching, .within_model = rules.within_model};
  if (rules.within_model == WithinModel::skip) options.models = larger.sample_models;
  for_each_pair(std::span<const Aabb>(larger.sample), options,
                [&n_pairs](std::uint32_t /*a*/, std::uint32_t /*b*/) { ++n_pairs; });
  const double most = static_cast<double>(most_kept(0)) * n_pes +
                      static_cast<double>(most_kept(larger.n) - most_kept(0));
  return n_pairs * scale * scale > factor * most;
}

Aabb larger_box(const Aabb& box, double slack) noexcept {
  constexpr double most = std::numeric_limits<double>::max();
  Aabb out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.lo[k] = std::max(box.lo[k] - slack, -most);
    out.hi[k] = std::min(box.hi[k] + slack, most);
  }
  return out;
}

ObjectList larger_objects(const ObjectList& objects, double slack, PeId pe) {
  ObjectList out;
  out.reserve(objects.size());
  std::vector<Aabb> boxes;
  for (std::uint32_t begin = 0, end = 0; begin < objects.size(); begin = end) {
    const ModelId model = objects.model(begin);
    boxes.clear();
    for (; end < objects.size() && objects.model(end) == model; ++end)
      boxes.push_back(larger_box(objects.boxes()[end], slack));
    out.append({owner_of(pe), model, boxes, static_cast<LocalId>(begin)}, pe);
  }
  return out;
}

void KeptPairs::add(Hits&& found, std::size_t n_objects) {
  if (too_many_) return;
  n_pairs_ += found.pairs.size();
  if (n_pairs_ > most_kept(n_objects)) {
    too_many_ = true;
    with_.clear();
    return;
  }
  with_[index_of(found.other).x].lists.push_back(std::move(found.pairs));
}

void KeptPairs::ask_for_others(
    const std::function<void(std::int32_t, std::span<const std::uint32_t>)>& ask) {
  for (auto& [pe, with] : with_) {
    if (pe == pe_.value) continue;
    // Where each of their objects is among those that are asked for: in order, all that occur.
    std::vector<std::uint32_t> place, positions;
    for (const std::vector<LocalPair>& pairs : with.lists)
      for (const LocalPair& pair : pairs) {
        const auto theirs = static_cast<std::uint32_t>(pair.theirs);
        if (theirs >= place.size()) place.resize(theirs + std::size_t{1}, 0);
        place[theirs] = 1;
      }
    for (std::uint32_t i = 0; i < place.size(); ++i) {
      if (place[i] == 0) continue;
      place[i] = static_cast<std::uint32_t>(positions.size());
      positions.push_back(i);
    }
    for (std::vector<LocalPair>& pairs : with.lists)
      for (LocalPair& pair : pairs)
        pair.theirs = static_cast<LocalId>(place[static_cast<std::uint32_t>(pair.theirs)]);
    ask(pe, positions);
  }
}

void KeptPairs::set_objects(ObjectList objects, double slack) {
  objects_ = std::move(objects);
  objects_.change_boxes([slack](const Aabb& box) { return larger_box(box, slack); });
}

bool KeptPairs::hold_for(const ObjectList& now) const {
  if (!now.has_objects_of(objects_)) return false;
  const Aabb* const larger = objects_.boxes().data();
  const Aabb* const boxes = now.boxes().data();
  bool inside = true;
  for (std::uint32_t i = 0; i < now.size() && inside; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      inside &= (larger[i].lo[k] <= boxes[i].lo[k]) & (boxes[i].hi[k] <= larger[i].hi[k]);
  return inside;
}

bool KeptPairs::test(Progress& progress, const ObjectList& now, const Boxes& of_others,
                     Touching touching, const HitReceivers& to) const {
  // Their hits fit into the cache until their owners receive them.
  constexpr std::size_t most = 1 << 13;
  constexpr std::size_t ahead = 16;  // pairs whose boxes are being loaded
  const auto at = with_.lower_bound(progress.pe);
  if (at == with_.end()) return false;
  const auto& [pe, with] = *at;
  const bool is_own = pe == pe_.value;
  const ObjectList& other = is_own ? now : with.copies;
  const Aabb* const a = now.boxes().data();
  const Aabb* const b = is_own ? a : of_others.at(pe).data();
  HitSorter hits;
  std::array<std::uint32_t, 256> mine, theirs;
  std::size_t n = 0, n_here = 0;
  const auto sort = [&] {
    hits.add({now, mine.data()}, {other, theirs.data()}, n, to, pe_);
    n = 0;
  };
  if (progress.pe != pe) progress = {pe, 0, progress.n_tested};
  for (; progress.n_lists < with.lists.size() && n_here < most; ++progress.n_lists) {
    const std::vector<LocalPair>& pairs = with.lists[progress.n_lists];
    n_here += pairs.size();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const LocalPair& later = pairs[std::min(i + ahead, pairs.size() - 1)];
      __builtin_prefetch(&a[static_cast<std::uint32_t>(later.mine)]);
      __builtin_prefetch(&b[static_cast<std::uint32_t>(later.theirs)]);
      mine[n] = static_cast<std::uint32_t>(pairs[i].mine);
      theirs[n] = static_cast<std::uint32_t>(pairs[i].theirs);
      n += overlap(a[mine[n]], b[theirs[n]], touching) ? 1U : 0U;
      if (n == mine.size()) sort();
    }
  }
  if (n != 0) sort();
  hits.send(to.call);
  progress.n_tested += n_here;
  if (progress.n_lists == with.lists.size()) progress = {pe + 1, 0, progress.n_tested};
  return true;
}

}  // namespace tess::collide
