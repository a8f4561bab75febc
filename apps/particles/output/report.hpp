// Reports of a run: what it will use, its table, and its JSON file.
#pragma once

#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"
#include "apps/particles/study/study.hpp"

#include <string>

namespace particles {

[[nodiscard]] constexpr const char* name_of(tess::BalanceWhen when) {
  constexpr const char* names[] = {"at_sync", "periodic", "automatic"};
  return names[static_cast<std::size_t>(when)];
}

/// The run beside the machine it ran on.
struct Report {
  std::string machine;
  std::int32_t pes = 0, processes = 0;
  RunOptions run{};
  std::vector<StudyRow> study{};
};

/// For --explain: what a run of the scene uses and builds, what for, and what it leaves out.
[[nodiscard]] std::string explanation(const Scene& scene, const Options& options);

[[nodiscard]] std::string table(const Scene& scene, const RunResult& result, const Report& report);
[[nodiscard]] std::string json(const Scene& scene, const RunResult& result, const Report& report);

}  // namespace particles
