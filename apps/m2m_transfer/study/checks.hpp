// What a study of kinds checks: each row can fail.
#pragma once

#include "apps/m2m_transfer/study/study.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

struct Check {
  std::string what;  ///< "linear, kuhn:8 -> kuhn:9, sin: Linf at most (3/16) h^2 max|D2f|"
  double value = 0, limit = 0;
  bool at_most = true;  ///< otherwise at least

  [[nodiscard]] bool ok() const { return at_most ? value <= limit : value >= limit; }
};

/// Per pair of meshes: the largest error of linear interpolation over the vertices found, against
/// its bound (input/formulas.hpp) plus rounding. Per kind: the order of the L2 error between the
/// two finest meshes. Both for fields with known derivatives only.
[[nodiscard]] std::vector<Check> checks(const std::vector<TransferReport>& reports);

[[nodiscard]] const kit::Rows<Check>& check_rows();
/// A line per check that failed, with figure and bound, and what to do about an order. Empty if none
/// failed.
[[nodiscard]] std::string failures(const std::vector<Check>& checks);

}  // namespace m2m_transfer
