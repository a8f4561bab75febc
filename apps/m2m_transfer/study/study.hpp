// A study runs several transfers with different meshes, fields and policies. It reports their
// errors against run time and against the edge length of the source, with fitted orders. The meshes
// on the command line:
//
//     kuhn:8,16,32 TARGET    each source onto the target
//     a.msh,b.msh TARGET     the same
//     kuhn:8,16,32           each N onto N+1, so that both meshes are refined
//     A B                    A -> B and B -> A
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/output/folder.hpp"
#include "apps/m2m_transfer/output/rows.hpp"
#include "apps/m2m_transfer/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer {

/// The meshes of a ladder: "kuhn:8,16@0.2" and "a.msh,b.msh" have two. Throws Error (bad_argument)
/// if the ladder has a mistake.
[[nodiscard]] std::vector<std::string> expand(const std::string& name);

/// The transfers of a study: every pair of meshes of every kind under every policy. Throws Error if
/// the ladders have different lengths, a policy is unknown, or a file does not exist.
[[nodiscard]] std::vector<Request> plan_study(const Request& request,
                                              const std::vector<std::string>& policies,
                                              const std::vector<std::string>& kinds);

/// What a study has to say of one field of one kind under one policy.
struct Trend {
  std::string field, kind, policy;
  bool exact = false;  ///< all relative errors are below 1e-12: rounding, not fitted
  std::optional<double> l2_of_edge{}, linf_of_edge{};        ///< orders of convergence
  std::optional<double> l2_of_seconds{}, linf_of_seconds{};  ///< error against run time

  /// True if it is about this row.
  [[nodiscard]] bool has(const FieldRow& row) const;
};
/// By kind, policy and field, in the order of the reports.
[[nodiscard]] std::vector<Trend> trends(const std::vector<TransferReport>& reports);
[[nodiscard]] const kit::Rows<Trend>& trend_rows();

/// The errors against run time and against the edge length.
[[nodiscard]] std::vector<Picture> pictures_of(const std::vector<TransferReport>& reports);

/// What a study of kinds checks; it can fail.
struct Check {
  std::string what;  ///< "linear, kuhn:8 -> kuhn:9, sin: Linf at most (3/16) h^2 max|D2f|"
  double value = 0, limit = 0;
  bool at_most = true;  ///< otherwise at least

  [[nodiscard]] bool ok() const { return at_most ? value <= limit : value >= limit; }
};

/// Per pair of meshes: the largest error of linear interpolation over the vertices found, against
/// its bound (linear_bound()) plus rounding. Per kind: the order of the L2 error between the
/// two finest meshes. Both for fields with known derivatives only.
[[nodiscard]] std::vector<Check> checks(const std::vector<TransferReport>& reports);

[[nodiscard]] const kit::Rows<Check>& check_rows();
/// A line per check that failed, with figure and bound, and what to do about an order. Empty if
/// none failed.
[[nodiscard]] std::string failures(const std::vector<Check>& checks);

}  // namespace m2m_transfer
