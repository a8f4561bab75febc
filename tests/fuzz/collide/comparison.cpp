#include "tests/fuzz/collide/comparison.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace collide_fuzz {

void Comparison::pairs(PairList found, PairList expected, std::string_view what) {
  std::ranges::sort(found);
  std::ranges::sort(expected);
  ++n_compared;
  n_pairs += expected.size();
  if (found == expected || !failure.empty()) return;
  PairList lost, added;
  std::ranges::set_difference(expected, found, std::back_inserter(lost));
  std::ranges::set_difference(found, expected, std::back_inserter(added));
  failure = fmt::format("{}: {} of {} pairs lost, {} added or doubled", what, lost.size(),
                        expected.size(), added.size());
  for (const auto* list : {&lost, &added})
    if (!list->empty())
      failure += fmt::format("; {} ({}, {})", list == &lost ? "lost" : "added", list->front().first,
                             list->front().second);
}

void Comparison::answer(bool agrees, std::string_view what) {
  ++n_compared;
  if (!agrees && failure.empty())
    failure = fmt::format("{}: another answer than brute force", what);
}

}  // namespace collide_fuzz
