// The group beside the voxels, one member on each PE (Lawlor and Kalé 2002, section 3.3): clients
// of the PE hand it their objects; it finds the voxels that each touches and sends one message to
// each voxel.
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

  /// Takes objects of a client on this PE. Throws Error that names the object for a box that is
  /// none, and for one that the grid has no cells for: nothing of this list is taken then.
  void submit(std::vector<Item> items);

  /// Sends all that was submitted to the voxels it touches, one message a voxel.
  void deliver();

  /// Objects sent to voxels so far, each counted once for each voxel.
  [[nodiscard]] std::uint64_t n_delivered() const { return n_delivered_; }

 private:
  const VoxelGrid grid_;
  const ArrayProxy<Voxel> voxels_;
  std::vector<std::vector<Item>> lists_;  // as they were submitted
  serial::CellBounds bounds_;             // of their cells
  std::uint64_t n_delivered_ = 0;
};

}  // namespace tess::collide
