// Reports of a run: what it will use, its table, and its object in the JSON file.
#pragma once

#include "apps/kit/output/json.hpp"
#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"

#include <string>

namespace particles {

[[nodiscard]] constexpr const char* name_of(tess::BalanceWhen when) {
  constexpr const char* names[] = {"at_sync", "periodic", "automatic"};
  return names[static_cast<std::size_t>(when)];
}

/// For --explain: what a run of the scene uses and builds, what for, and what it leaves out.
[[nodiscard]] std::string explanation(const Scene& scene, const RunOptions& options);

/// What is known of a run, as an object of `results`; called while the machine runs.
[[nodiscard]] kit::Json report(const Scene& scene, const RunResult& result,
                               const RunOptions& options);
/// A line per member of the report, and a table of the measures.
[[nodiscard]] std::string table(const kit::Json& report, const RunResult& result);

}  // namespace particles
