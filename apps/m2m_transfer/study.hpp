// A study: many transfers that differ in what decides accuracy (meshes, fields, policy), and their
// error against run time and against the edge length of the source, with fitted orders: as a table,
// CSV, JSON and pictures.
//
//     kuhn:8,16,32 TARGET    each source onto the target        a.msh,b.msh TARGET  the same
//     kuhn:8,16,32           each N onto N+1: both refined      A B                 A -> B, B -> A
#pragma once

#include "apps/m2m_transfer/problem.hpp"
#include "apps/m2m_transfer/report.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tess::m2m {

struct Study {
  std::vector<TransferReport> reports;  ///< all with the same fields; policy by policy
  std::int32_t repeat = 1;              ///< transfers each, of which the fastest counts
};

/// The meshes that a name stands for: "kuhn:8,16@0.2" and "a.msh,b.msh" are two each. Throws Error
/// (bad_argument) for a ladder that cannot be.
[[nodiscard]] std::vector<std::string> expand(const std::string& name);

/// The transfers of a study: every pair of meshes for every policy. Throws Error for ladders that
/// do not fit, an unknown policy, or a file that does not exist.
[[nodiscard]] std::vector<Request> plan_study(const Request& request,
                                              const std::vector<std::string>& policies);

struct Sample {
  double x = 0, y = 0;
};
/// The exponent p of y = c x^p that fits best (least squares of the logarithms), over samples that
/// are finite and positive; none if they have fewer than two different x.
[[nodiscard]] std::optional<double> fitted_power(const std::vector<Sample>& samples);

/// How the error of one field under one policy falls.
struct Trend {
  std::string field, policy;
  bool exact = false;  ///< relative errors below 1e-12: rounding alone, nothing to fit
  std::optional<double> l2_of_edge, linf_of_edge;        ///< orders of convergence
  std::optional<double> l2_of_seconds, linf_of_seconds;  ///< error against run time
};
[[nodiscard]] std::vector<Trend> trends(const Study& study);

[[nodiscard]] std::string table(const Study& study);
/// {"pairs": [{…}], "trends": [{…}]}
[[nodiscard]] std::string json(const Study& study);
/// One line a pair and field.
[[nodiscard]] std::string csv(const Study& study);

/// Makes the folder if it is not there. Throws Error (environment) that names it.
void prepare_folder(const std::string& folder);
/// Writes study.csv, study.json, error_time.svg and error_edge.svg (with their data) into the
/// folder; returns a line that says what is there.
[[nodiscard]] std::string write(const Study& study, const std::string& folder);

}  // namespace tess::m2m
