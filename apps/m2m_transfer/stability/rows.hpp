// Runs the cases of the stability report on several machines, and judges them.
#pragma once

#include "apps/kit/cases.hpp"
#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/stability/cases.hpp"
#include "m2m/partition_method.hpp"
#include "m2m/policy.hpp"
#include "m2m/status.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer::stability {

/// `met`: the largest |value - truth| over the points found; `note`: why the mesh was refused, and
/// then nothing else is known.
struct Row : kit::Case {
  std::size_t n_points = 0;
  std::size_t lost = 0;  ///< outside, or at a wrong donor, though the source holds the point
  std::size_t snapped = 0, outside = 0;
  std::size_t n_runs = 0;
  bool same_bits = true;  ///< values and statuses in all runs
};

/// The result of one case in one run.
struct Answer {
  std::vector<Status> status;
  std::vector<double> values;
};

/// How every case is run.
struct Ways {
  PartitionMethod partition = PartitionMethod::rcb;
  OutsidePolicy policy = Keep{};
};

/// Runs a case with so many parts per mesh. The target starts with zeros.
TaskOf<Answer> answer_of(const Case& c, std::int32_t n_parts, const Ways& ways);

/// The reason why a mesh of the case is refused; empty if it is valid.
[[nodiscard]] std::string refusal(const Case& c);

/// Judges the first answer, and compares the others with it. `before`: the answer of the case
/// before, for cases with an order; may be null. A point outside whose value is not that of the
/// policy has an infinite error.
[[nodiscard]] Row judge(const Case& c, const std::vector<Answer>& answers, const Answer* before,
                        const OutsidePolicy& policy = Keep{});

/// All cases on `setup` with 1, 6 and 16 parts, and if it has one process, on simulated machines of
/// 6 and 16 PEs. Rows stay empty on processes other than the first.
[[nodiscard]] std::vector<Row> run_cases(Setup& setup, const std::vector<Case>& cases,
                                         const Ways& ways, kit::Progress& progress);

}  // namespace m2m_transfer::stability
