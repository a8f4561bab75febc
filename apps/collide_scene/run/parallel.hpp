// Collisions of a scene on chares, by the parallel face of the library (collide/collider.hpp). PE 0
// has the scene and moves it; each client, one per PE, gets a piece of it, submits its boxes, and
// receives their pairs. Exact tests are made by the clients.
//
//     PE 0                    client a (pairs of a, b: a < b)        client b
//     take(piece) ──────────► submit ► collider ► receive(hits)
//                                                  triangles of a ──► test: counts the pair
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/client.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
#include "runtime/runtime.hpp"

namespace collide_scene {

/// The collider and its clients, on PE 0. Begin, steps, end.
class ParallelCollisions {
 public:
  /// The scene must outlive this; its objects may move between steps. `costs` are those of a
  /// simulated machine.
  ParallelCollisions(const Scene& scene, const Rules& rules,
                     const tess::collide::SimulatedCosts& costs = {});

  tess::Task begin();
  /// Hands out the objects where they are now, then collides them; only the second is timed, and
  /// `repeat` times: the fastest counts. Appends the pairs to `pairs`, if it is not null.
  tess::Task step(int step, int repeat, StepResult& result, std::vector<ScenePair>* pairs);
  /// Fills in what is known of the grid and the memory, and frees the collider.
  tess::Task end(RunResult& result);
  /// Known after begin().
  [[nodiscard]] const tess::collide::Collider& collider() const { return collider_; }

 private:
  const Scene& scene_;
  const Rules rules_;
  const tess::collide::SimulatedCosts costs_;
  tess::collide::Collider collider_;
  tess::ArrayProxy<Client> clients_;
  tess::collide::CollisionStatistics last_;
};

}  // namespace collide_scene
