#include "apps/m2m_transfer/study/checks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

/// The least order that is no failure, a quarter below the order of the kind for smooth fields.
double least_order(const std::string& kind) {
  if (kind == "second-order") return 2.75;
  if (kind == "linear" || kind == "limited" || kind == "conservative") return 1.75;
  return 0.75;
}

bool is_smooth(const std::string& field) {
  return field == "gaussian" || field == "sin";
}

/// The two reports of a kind and policy with the shortest edges, the finest first.
std::vector<const TransferReport*> finest_two(const Study& study, const TransferReport& like) {
  std::vector<const TransferReport*> out;
  for (const TransferReport& r : study.reports)
    if (r.kind == like.kind && r.policy == like.policy && r.tally.counts[3] == 0) out.push_back(&r);
  std::ranges::sort(out, {}, [](const TransferReport* r) { return r->source_edge; });
  if (out.size() > 2) out.resize(2);
  return out;
}

}  // namespace

std::vector<Check> checks(const Study& study) {
  std::vector<Check> out;
  for (const TransferReport& r : study.reports)
    for (const FieldError& field : r.fields) {
      if (!field.bound || field.found.n_vertices == 0) continue;
      // Values up to about ten, and coordinates in the formula, round.
      const double rounding = 1e-12 + 1e-9 * *field.bound;
      out.push_back({fmt::format("{}, {} -> {}, {}: Linf at most (3/16) h^2 max|D2f|", r.kind,
                                 r.source, r.target, field.name),
                     field.found.linf, *field.bound + rounding});
    }
  for (const Trend& trend : trends(study)) {
    if (trend.exact || !is_smooth(trend.field)) continue;
    TransferReport like;
    like.kind = trend.kind;
    like.policy = trend.policy;
    const auto two = finest_two(study, like);
    if (two.size() < 2 || two[0]->source_edge > 0.9 * two[1]->source_edge) continue;
    const auto l2 = [&](const TransferReport& r) {
      return std::ranges::find(r.fields, trend.field, &FieldError::name)->norms.l2;
    };
    const double order =
        std::log(l2(*two[1]) / l2(*two[0])) / std::log(two[1]->source_edge / two[0]->source_edge);
    out.push_back({fmt::format("{}, {} to {}, {}: order of L2 at least", trend.kind, two[1]->source,
                               two[0]->source, trend.field),
                   order, least_order(trend.kind), false});
  }
  return out;
}

bool all_ok(const std::vector<Check>& checks) {
  return std::ranges::all_of(checks, &Check::ok);
}

std::string table(const std::vector<Check>& checks) {
  std::size_t wide = 6;
  for (const Check& check : checks) wide = std::max(wide, check.what.size());
  std::string out = "checks\n";
  for (const Check& check : checks)
    out += fmt::format("  {:<{}} {:>11.4e}: {:>11.4e}  {}\n", check.what, wide, check.limit,
                       check.value, check.ok() ? "ok" : "FAILED");
  return out;
}

std::string failures(const std::vector<Check>& checks) {
  std::string out;
  bool an_order = false;
  for (const Check& check : checks) {
    if (check.ok()) continue;
    out += fmt::format("FAILED: {}: claimed {:.4e}, measured {:.4e}\n", check.what, check.limit,
                       check.value);
    an_order = an_order || !check.at_most;
  }
  if (an_order)
    out +=
        "an order is claimed of meshes that resolve the field; give a ladder of finer ones, such "
        "as "
        "kuhn:16,32\n";
  return out;
}

}  // namespace m2m_transfer
