// What the owners of objects received from a collider, and what all pairs say that they should.
#pragma once

#include "collide/hit.hpp"
#include "collide/hit_receivers.hpp"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::test {

/// A report: one pair, as an owner received it.
struct Reported {
  std::uint64_t owner = 0, other = 0;
  collide::LocalPair pair;
  friend auto operator<=>(const Reported&, const Reported&) = default;
};
using Reports = std::vector<Reported>;

inline Reported reported(const collide::ObjectId& mine, const collide::ObjectId& theirs) {
  return {static_cast<std::uint64_t>(mine.owner),
          static_cast<std::uint64_t>(theirs.owner),
          {mine.local, theirs.local}};
}
inline void add(Reports& to, const collide::Hits& hits) {
  for (const collide::LocalPair& pair : hits.pairs)
    to.push_back(
        {static_cast<std::uint64_t>(hits.owner), static_cast<std::uint64_t>(hits.other), pair});
}

/// Sorts the reports, and the two objects of a pair with one owner, whose order has no meaning.
inline Reports in_order(Reports list) {
  for (Reported& t : list)
    if (t.owner == t.other && t.pair.theirs < t.pair.mine) std::swap(t.pair.mine, t.pair.theirs);
  std::sort(list.begin(), list.end());
  return list;
}

/// Each of the two owners of a pair receives it, once if they are the same; with `only` those whose
/// object is of this model.
inline Reports all_reports(std::span<const collide::Item> all, collide::PairRules rules,
                           std::optional<collide::ModelId> only) {
  Reports out;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const collide::ObjectId &a = all[i].id, &b = all[j].id;
      if (rules.within_model == collide::WithinModel::skip && a.model == b.model) continue;
      if (!overlap(all[i].box, all[j].box, rules.touching)) continue;
      const bool to_a = !only || a.model == *only, to_b = !only || b.model == *only;
      if (to_a) out.push_back(reported(a, b));
      if (to_b && !(to_a && a.owner == b.owner)) out.push_back(reported(b, a));
    }
  return in_order(std::move(out));
}

}  // namespace tess::test
