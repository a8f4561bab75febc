// Reports of a run: the table, its JSON, and what the scene uses and leaves out.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/kit/output/json.hpp"

#include <optional>
#include <string>

namespace collide_scene {

/// The run beside the scene and the machine.
struct Report {
  const Options& options;
  std::string scene;  ///< its description
  std::size_t n_objects = 0;
  std::size_t n_triangles = 0;
  std::uint32_t n_models = 0;
  std::string motion;
  std::string machine;
  bool on_chares = false;
  std::int32_t n_pes = 1, n_processes = 1;
  RunResult result{};
  /// Part of the pairs of boxes of the last step that are no pairs of objects. Absent if it was not
  /// measured: the exact tests of more pairs than that would take longer than the run.
  std::optional<double> false_positive_rate{};
};

/// For --explain, before the run.
[[nodiscard]] std::string explanation(const Report& report);
[[nodiscard]] std::string table(const Report& report);
/// One object, with the list "steps"; a number that is not known is null.
[[nodiscard]] kit::Json json(const Report& report);

}  // namespace collide_scene
