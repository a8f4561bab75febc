// Delta debugging (Zeller and Hildebrandt 2002, algorithm ddmin): a smallest part of some decisions
// with which a run still fails. Beyond the paper, decisions that did not come up in a failing run
// are dropped at once.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace tess::test::detail {

/// The number of a decision, the same in every run of a seed (decisions.hpp).
using DecisionId = std::uint32_t;
/// Sorted, without repetition.
using DecisionIds = std::vector<DecisionId>;

/// Runs with no other decisions than these. If it fails, returns those of them that came up.
using FailsWith = std::function<std::optional<DecisionIds>(const DecisionIds&)>;

struct Shrunk {
  DecisionIds kept;
  unsigned n_tries = 0;
  bool is_minimal = false;  ///< without any one of them it does not fail; false: tries ran out
};

/// `all` is a set with which it fails.
[[nodiscard]] Shrunk shrink(DecisionIds all, const FailsWith& fails, unsigned most_tries);

}  // namespace tess::test::detail
