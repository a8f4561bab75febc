// A scene as the benchmark of pairs uses it, and the list of all.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"
#include "collide/box.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bench {

using tess::collide::Aabb;
using FloatBox = tess::collide::Box<float, 3>;

/// Which pairs of boxes that overlap are counted.
enum class Pairing { all, across_models };

/// A line of the table: a scene and a rule.
struct Case {
  std::string name;
  std::string scene;
  std::string meaning;
  Pairing pairing = Pairing::all;
  tess::collide::Touching touching = tess::collide::Touching::counts;
};
[[nodiscard]] const std::vector<Case>& box_cases();

/// The same with the number of its scene divided, unless it is small already.
[[nodiscard]] Case smaller(const Case& of, std::uint64_t divisor);

/// The input of a method.
struct Problem {
  std::vector<Aabb> boxes;
  std::vector<FloatBox> floats;       ///< the boxes rounded to the nearest floats
  std::vector<std::uint32_t> models;  ///< empty: none
  Pairing pairing = Pairing::all;
  tess::collide::Touching touching = tess::collide::Touching::counts;

  /// The first object of model 1 if there are exactly the models 0 and 1 and pairs across them are
  /// wanted: two sets, as libraries without models want them. Otherwise 0.
  [[nodiscard]] std::size_t second_set() const;
  [[nodiscard]] bool wants(std::uint32_t a, std::uint32_t b) const {
    return pairing == Pairing::all || models[a] != models[b];
  }
};
[[nodiscard]] Problem make_problem(const Case& of);

}  // namespace bench
