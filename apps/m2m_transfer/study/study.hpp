// A study runs several transfers with different meshes, fields and policies. It reports their
// errors against run time and against the edge length of the source, with fitted orders, as a
// table, CSV, JSON and pictures. The meshes on the command line:
//
//     kuhn:8,16,32 TARGET    each source onto the target
//     a.msh,b.msh TARGET     the same
//     kuhn:8,16,32           each N onto N+1, so that both meshes are refined
//     A B                    A -> B and B -> A
#pragma once

#include "apps/kit/chart.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/report.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer {

struct Study {
  std::vector<TransferReport>
      reports;              ///< all with the same fields; sorted by kind, then by policy
  std::int32_t repeat = 1;  ///< transfers per report; the fastest counts
  bool is_checked = false;  ///< checks() hold for it
};

/// The meshes of a ladder: "kuhn:8,16@0.2" and "a.msh,b.msh" have two. Throws Error (bad_argument)
/// if the ladder has a mistake.
[[nodiscard]] std::vector<std::string> expand(const std::string& name);

/// The transfers of a study: every pair of meshes of every kind under every policy. Throws Error if
/// the ladders have different lengths, a policy is unknown, or a file does not exist.
[[nodiscard]] std::vector<Request> plan_study(const Request& request,
                                              const std::vector<std::string>& policies,
                                              const std::vector<std::string>& kinds);

/// The convergence of the error of one field of one kind under one policy.
struct Trend {
  std::string field, kind, policy;
  bool exact = false;  ///< all relative errors are below 1e-12: rounding, not fitted
  std::optional<double> l2_of_edge, linf_of_edge;        ///< orders of convergence
  std::optional<double> l2_of_seconds, linf_of_seconds;  ///< error against run time
};
[[nodiscard]] std::vector<Trend> trends(const Study& study);

[[nodiscard]] std::string table(const Study& study);
/// {"pairs": [{…}], "trends": [{…}]}
[[nodiscard]] std::string json(const Study& study);
/// One line per pair of meshes and field.
[[nodiscard]] std::string csv(const Study& study);

/// Writes study.csv, study.json, error_time.svg and error_edge.svg (with their data as CSV) into
/// the folder. Returns a line that lists them.
[[nodiscard]] std::string write(const Study& study, const std::string& folder);

}  // namespace m2m_transfer
