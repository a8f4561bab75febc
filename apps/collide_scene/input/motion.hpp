// Where the objects of a scene are at a step. A place is a function of the step and of how the
// scene was made, never of the step before: runs that begin anywhere agree.
//
//     own        as the scene moves by itself (crowd:N)
//     still      not at all
//     drift[:D]  each model in a direction of its own, D times the median size of the objects per
//                step (0.1); each object, in a scene without models
//     turn[:A]   each model of triangles about the axis z through its centre, by A degrees per step
//                (1), every other one in the other direction
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

#include <string>

namespace collide_scene {

class Motion {
 public:
  /// Throws tess::Error for a text that is none of the above, or does not fit the scene. An empty
  /// text means own where the scene moves by itself, otherwise still.
  Motion(const std::string& text, const Scene& scene);

  /// Moves the scene that was given to where it is at a step. Step 0 is as it was given.
  void place(int step, Scene& scene) const;

  [[nodiscard]] bool moves() const noexcept { return kind_ != Kind::still; }
  /// In words, for the report.
  [[nodiscard]] std::string describe() const;

 private:
  enum class Kind : std::uint8_t { own, still, drift, turn };
  [[nodiscard]] std::uint32_t group_of(std::size_t object) const noexcept;

  Kind kind_ = Kind::still;
  double amount_ = 0;                          // of a step: a length, or degrees
  Scene at_first_;                             // empty unless drift or turn
  std::vector<tess::collide::Point> centres_;  // of models, for turn
};

}  // namespace collide_scene
