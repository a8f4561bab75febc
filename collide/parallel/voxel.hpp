// A voxel is an element of a sparse array: a cell, and the level that it belongs to (Lawlor and
// Kalé 2002, section 3.3). In the paper any sender may create it (section 3.5). Here the home of
// the cell names the PE whose objects create it, and leaves out a voxel that can have no pair. When
// it has heard from all PEs that send to it, it solves a serial problem of its own, without waiting
// for other voxels. Empty space costs nothing: it has no voxels.
#pragma once

#include "runtime/runtime.hpp"

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace tess::collide {

class Part;

class Voxel : public Chare<Voxel, Index4> {
 public:
  Voxel();
  ~Voxel() override;

  /// After retire(), objects may arrive before the ones that make the voxel again.
  static constexpr tess::DeadLetters dead_letters = tess::DeadLetters::wait;

  /// Adds the objects of one of `n_senders` PEs; the last one starts the search.
  void add(Part part, std::uint32_t n_senders);

  /// Ends the voxel if it has been idle since the last call. No collision may be running.
  void retire();

  /// The position for load balancing, in units of the smallest voxels.
  [[nodiscard]] std::array<double, 3> balance_position() const {
    const int up = 3 * index().w;
    return {std::ldexp(index().x, up), std::ldexp(index().y, up), std::ldexp(index().z, up)};
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(waiting_, is_idle_);
  }

 private:
  std::map<std::uint64_t, std::vector<Part>> waiting_;  // by step of the collider
  bool is_idle_ = false;
};

}  // namespace tess::collide
