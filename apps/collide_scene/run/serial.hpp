// One collision of a scene in one thread, by the serial face of the library (collide/pairs.hpp).
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

struct SerialCollision {
  Answer answer;
  GridReport grid;
  double seconds = 0;      ///< wall clock
  double cpu_seconds = 0;  ///< of this thread: fair on a machine that others use, too
};

/// Collides the objects where they are. `step` enters the hash. If `pairs` is not null, the pairs
/// are appended to it. Throws tess::Error as the library does.
[[nodiscard]] SerialCollision collide_once(const Scene& scene, const Rules& rules, int step,
                                           std::vector<ScenePair>* pairs = nullptr);

}  // namespace collide_scene
