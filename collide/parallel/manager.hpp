// A group with one member per PE (Lawlor and Kalé 2002, section 3.3). Clients on the PE pass their
// objects to it. It finds the voxels that each object touches, and sends one message per voxel.
#pragma once

#include "collide/hit.hpp"
#include "collide/parallel/voxel.hpp"
#include "collide/serial/cell_numbers.hpp"
#include "collide/serial/voxel_grid.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace tess::collide {

class Manager : public Group<Manager> {
 public:
  Manager(const Point& origin, const Point& size, ArrayProxy<Voxel> voxels)
      : grid_(origin, size), voxels_(voxels) {}

  /// Accepts objects of a client on this PE. Throws Error with the object if a box is not valid or
  /// exceeds the range of cell indices; then no object of the list is accepted.
  void submit(std::vector<Item> items);

  /// Sends the submitted objects to the voxels that they touch, one message per voxel.
  void deliver();

  /// Number of (object, voxel) pairs sent so far.
  [[nodiscard]] std::uint64_t n_delivered() const { return n_delivered_; }

 private:
  const VoxelGrid grid_;
  const ArrayProxy<Voxel> voxels_;
  std::vector<std::vector<Item>> lists_;  // one per call of submit()
  serial::CellBounds bounds_;             // of the cells of all lists
  std::uint64_t n_delivered_ = 0;
};

}  // namespace tess::collide
