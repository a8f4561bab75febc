#include "apps/kit/json.hpp"
#include "apps/m2m_transfer/stability/rows.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace m2m_transfer::stability {

std::string table(const std::vector<Row>& rows) {
  std::size_t wide = 4;
  for (const Row& row : rows) wide = std::max(wide, row.name.size());
  std::string out =
      fmt::format("{:<{}} {:>7} {:>9} {:>7} {:>5} {:>8} {:>8} {:>9} {:>5}  {}\n", "case", wide, "",
                  "value", "points", "lost", "snapped", "outside", "error", "runs", "same bits");
  std::size_t n_failed = 0;
  for (const Row& row : rows) {
    n_failed += row.ok ? 0U : 1U;
    const std::string value = row.parameter.empty() ? "" : fmt::format("{:.4g}", row.value);
    out += fmt::format("{:<{}} {:>7} {:>9} {:>7} ", row.name, wide, row.parameter, value,
                       row.n_points);
    out += row.note.empty()
               ? fmt::format("{:>5} {:>8} {:>8} {:>9.2e} {:>5}  {}", row.lost, row.snapped,
                             row.outside, row.error, row.n_runs, row.same_bits ? "yes" : "no")
               : "refused: " + row.note;
    out += row.ok ? "\n" : "  FAILED\n";
  }
  return out + fmt::format(
                   "error: largest |value - truth| over the points found; runs: with 1, 6 and 16 "
                   "parts, on this machine and simulated ones\n{} cases, {} failed\n",
                   rows.size(), n_failed);
}

std::string json(const std::vector<Row>& rows) {
  kit::Json whole;
  for (const Row& row : rows)
    whole["rows"].push_back({{"case", row.name},
                             {"parameter", row.parameter},
                             {"value", row.value},
                             {"points", row.n_points},
                             {"lost", row.lost},
                             {"snapped", row.snapped},
                             {"outside", row.outside},
                             {"error", row.error},
                             {"runs", row.n_runs},
                             {"same_bits", row.same_bits},
                             {"refused", row.note},
                             {"ok", row.ok}});
  return kit::json_text(whole);
}

}  // namespace m2m_transfer::stability
