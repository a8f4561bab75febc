#include "apps/particles/stability/report.hpp"

#include "apps/particles/stability/cases.hpp"
#include "runtime/run.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace particles {

bool print_stability(bool speaks) {
  const std::vector<tess::dn::StabilityRow> rows = tess::dn::stability_report();
  std::size_t name_width = 4, parameter_width = 9;
  for (const auto& row : rows) {
    name_width = std::max(name_width, row.name.size());
    parameter_width = std::max(parameter_width, row.parameter.size());
  }
  std::string out = fmt::format("{:<{}}  {:<{}} {:>11} {:>11} {:>11}\n", "case", name_width,
                                "parameter", parameter_width, "value", "met", "tolerance");
  std::size_t n_failed = 0;
  for (const auto& row : rows) {
    n_failed += static_cast<std::size_t>(!row.ok);
    out += fmt::format("{:<{}}  {:<{}} {:>11.4g} {:>11.3e} {:>11.3e}{}\n", row.name, name_width,
                       row.parameter, parameter_width, row.value, row.met, row.tolerance,
                       row.ok ? "" : "  FAILED");
  }
  out += fmt::format("{} cases, {} failed\n", rows.size(), n_failed);
  if (speaks) tess::print(out);
  return n_failed == 0;
}

}  // namespace particles
