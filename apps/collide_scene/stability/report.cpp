#include "apps/collide_scene/stability/report.hpp"

#include "apps/collide_scene/stability/cases.hpp"
#include "runtime/run.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace collide_scene {

bool print_stability() {
  kit::Progress progress(stderr);
  const std::vector<StabilityRow> rows = stability_report(&progress);
  progress.clear();
  std::size_t width = 4;
  for (const StabilityRow& row : rows) width = std::max(width, row.name.size());
  std::string out =
      fmt::format("{:<{}} {:>8} {:>9} {:>8} {:>8} {:>6} {:>8} {:>6} {:>9} {:>9}\n", "case", width,
                  "", "value", "objects", "pairs", "lost", "doubled", "added", "ms", "brute ms");
  std::size_t n_failed = 0;
  for (const StabilityRow& row : rows) {
    n_failed += static_cast<std::size_t>(!row.ok);
    out += fmt::format(
        "{:<{}} {:>8} {:>9} {:>8} {:>8} {:>6} {:>8} {:>6} {:>9.3f} {:>9.3f}{}{}\n", row.name, width,
        row.parameter, row.parameter.empty() ? "" : fmt::format("{:.4g}", row.value), row.n_objects,
        row.n_pairs, row.lost, row.doubled, row.added, row.seconds * 1e3, row.brute_seconds * 1e3,
        row.ok ? "" : "  FAILED", row.note.empty() ? "" : ": " + row.note);
  }
  out += "ms: CPU time\n";
  out += fmt::format("{} cases, {} failed\n", rows.size(), n_failed);
  tess::print_text(out);
  return n_failed == 0;
}

}  // namespace collide_scene
