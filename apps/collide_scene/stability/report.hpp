// The stability report as a table.
#pragma once

namespace collide_scene {

/// Runs the report and prints it. False if a row failed.
[[nodiscard]] bool print_stability();

}  // namespace collide_scene
