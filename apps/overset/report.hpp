// What the program prints and writes.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/overset/assembly.hpp"

#include <optional>
#include <string>
#include <vector>

namespace overset {

/// A table; the first orphans are listed.
[[nodiscard]] std::string table(const Request& request, const Problem& problem,
                                const Assembly& assembly);
/// The same, and all listed orphans, as an object of `results`.
[[nodiscard]] kit::Json report(const Problem& problem, const Assembly& assembly);
/// The method in sentences, with the numbers of this run.
[[nodiscard]] std::string explanation(const Problem& problem);

/// Writes background.exo, overset.exo, overset2.exo, … with the nodal variables iblank, quality and the field,
/// and before.svg and after.svg, into the folder.
void write(const Problem& problem, const Assembly& assembly, const std::string& folder);

/// One row of a study: both meshes of the size `n`.
struct StudyRow {
  std::int32_t n = 0;
  double h = 0;        ///< longest edge of a cube of the background
  double seconds = 0;  ///< cut, search and exchange
  double linf = 0, rms = 0;
  std::uint64_t n_fringe = 0, n_orphans = 0;
  std::optional<double> order{};  ///< the power of h with which rms fell since the row before
};
[[nodiscard]] const kit::Rows<StudyRow>& study_report();
/// Error against run time.
[[nodiscard]] kit::Chart chart_of(const std::vector<StudyRow>& rows);

}  // namespace overset
