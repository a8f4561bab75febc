// A voxel: a chare of a sparse three-dimensional array, created by the first objects that touch it,
// on the PE they come from (Lawlor and Kalé 2002, section 3.3). Once all objects are delivered it
// is a serial problem by itself. What does not touch anything costs nothing: empty voxels do not
// exist, and one that a collision finds empty, for its objects have moved on, ends; one whose
// objects are all of one model skips the serial step (section 4.2).
#pragma once

#include "collide/hit.hpp"
#include "collide/parallel/report.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <vector>

namespace tess::collide {

/// What a collision is run with, the same for all voxels.
struct Collision {
  Point origin{};  ///< of the grid
  Point size{};    ///< of a voxel
  PairRules rules;
  Report report;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(origin, size, rules, report);
  }
};

class Voxel : public Chare<Voxel, Index3> {
 public:
  /// Takes objects that touch this voxel.
  void add(std::vector<Item> items);

  /// Finds the pairs that this voxel is responsible for, tells their owners, and lets go of the
  /// objects. A voxel without objects ends.
  void start_collision(const Collision& collision);

  /// For a balancer: in units of voxels.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    return {1.0 * index().x, 1.0 * index().y, 1.0 * index().z};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(items_);
  }

 private:
  std::vector<Item> items_;
};

}  // namespace tess::collide
