// A scene as the benchmark of pairs uses it, and the list of all.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"
#include "collide/box.hpp"
#include "collide/triangle.hpp"

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
  bool exact = false;  ///< pairs of triangles that intersect, not of their boxes
};
[[nodiscard]] const std::vector<Case>& box_cases();

/// The same with the number of its scene divided, unless it is small already.
[[nodiscard]] Case smaller(const Case& of, std::uint64_t divisor);

/// The input of a method.
struct Problem {
  std::vector<Aabb> boxes;
  std::vector<FloatBox> floats;       ///< the boxes rounded to the nearest floats
  std::vector<std::uint32_t> models;  ///< empty: none
  /// If pairs of triangles are wanted: the boxes are those of the triangles.
  std::vector<tess::collide::Triangle> triangles;
  std::vector<tess::collide::TriangleOf<float>> float_triangles;  ///< rounded
  Pairing pairing = Pairing::all;
  tess::collide::Touching touching = tess::collide::Touching::counts;

  /// The first object of model 1 if there are exactly the models 0 and 1 and pairs across them are
  /// wanted: two sets, as libraries without models want them. Otherwise 0.
  [[nodiscard]] std::size_t second_set() const;
  /// What is left to decide about a pair of boxes that overlap.
  [[nodiscard]] bool wants(std::uint32_t a, std::uint32_t b) const {
    return (pairing == Pairing::all || models[a] != models[b]) &&
           (triangles.empty() || intersect(triangles[a], triangles[b], touching));
  }
};
/// `seed`: of scenes with random places.
[[nodiscard]] Problem make_problem(const Case& of, std::uint64_t seed = 1);

/// The problem of the rounded objects, as doubles.
[[nodiscard]] Problem widened(const Problem& problem);

}  // namespace bench
