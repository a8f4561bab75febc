// Compares lists of pairs.
#pragma once

#include "apps/collide_fuzz/trial.hpp"
#include "collide/pairs.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>
#include <vector>

namespace collide_fuzz {

using PairList = std::vector<tess::collide::Pair>;

/// Notes in the outcome whether `found` is `expected`, in any order; only the first failure is
/// kept.
inline void compare(PairList found, PairList expected, std::string_view what, Outcome& outcome) {
  std::ranges::sort(found);
  std::ranges::sort(expected);
  ++outcome.n_compared;
  outcome.n_pairs += expected.size();
  if (found == expected || !outcome.failure.empty()) return;
  PairList lost, added;
  std::ranges::set_difference(expected, found, std::back_inserter(lost));
  std::ranges::set_difference(found, expected, std::back_inserter(added));
  outcome.failure = fmt::format("{}: {} of {} pairs lost, {} added or doubled", what, lost.size(),
                                expected.size(), added.size());
  for (const auto* list : {&lost, &added})
    if (!list->empty())
      outcome.failure += fmt::format("; {} ({}, {})", list == &lost ? "lost" : "added",
                                     list->front().first, list->front().second);
}

}  // namespace collide_fuzz
