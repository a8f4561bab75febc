// What the program prints and writes.
#pragma once

#include "apps/overset/assembly.hpp"

#include <string>
#include <vector>

namespace overset {

/// A table; the first orphans are listed.
[[nodiscard]] std::string table(const Request& request, const Problem& problem,
                                const Assembly& assembly);
/// The same, and all listed orphans, as JSON.
[[nodiscard]] std::string json(const Request& request, const Problem& problem,
                               const Assembly& assembly);
/// The method in sentences, with the numbers of this run.
[[nodiscard]] std::string explanation(const Problem& problem);

/// Writes background.exo and overset.exo with the nodal variables iblank, quality and the field,
/// and before.svg and after.svg, into the folder. Returns a line that lists them.
[[nodiscard]] std::string write(const Problem& problem, const Assembly& assembly,
                                const std::string& folder);

/// One row of a study: both meshes of the size `n`.
struct StudyRow {
  std::int32_t n = 0;
  double h = 0;        ///< longest edge of a cube of the background
  double seconds = 0;  ///< cut, search and exchange
  double linf = 0, rms = 0;
  std::uint64_t n_fringe = 0, n_orphans = 0;
};
/// Error against run time with the fitted order in h. With a folder also study.svg (and study.csv).
[[nodiscard]] std::string study_table(const std::vector<StudyRow>& rows, const std::string& folder);

}  // namespace overset
