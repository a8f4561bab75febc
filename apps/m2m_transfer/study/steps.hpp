// The study of steps: the time of a step with donors that were searched once, against a new search
// in every step.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/output/folder.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

struct StepsRow {
  std::string source, target;
  std::int32_t steps = 0;
  double kept = 0;   ///< seconds per step: one search, then the applications
  double again = 0;  ///< seconds per step with a search in each
  std::uint64_t hash = 0, hash_again = 0;

  /// The donors kept give the same bits.
  [[nodiscard]] bool ok() const { return hash == hash_again; }
};

/// Adds a row for 1, 2, 5, 10, 20, 50 and 100 steps. `repeat`: measurements; the fastest counts.
Task measure_steps(Problem& problem, std::int32_t repeat, kit::Progress& progress,
                   std::vector<StepsRow>& rows);

[[nodiscard]] const kit::Rows<StepsRow>& steps_rows();
[[nodiscard]] Picture picture_of(const std::vector<StepsRow>& rows);

}  // namespace m2m_transfer
