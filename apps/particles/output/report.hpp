// What a run of a scene has to show: a table for people, JSON for programs.
#pragma once

#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"
#include "apps/particles/study/study.hpp"

#include <optional>
#include <string>

namespace particles {

/// The run beside the machine it ran on.
struct Report {
  std::string machine;
  std::int32_t pes = 0, processes = 0;
  RunOptions run{};
  std::optional<std::uint64_t> bytes_compressed{};  ///< of all fields
  std::vector<StudyRow> study{};
};

[[nodiscard]] std::string table(const Scene& scene, const RunResult& result, const Report& report);
[[nodiscard]] std::string json(const Scene& scene, const RunResult& result, const Report& report);

}  // namespace particles
