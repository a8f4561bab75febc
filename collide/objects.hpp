// What clients pass to a collider.
#pragma once

#include "collide/box.hpp"
#include "collide/capsule.hpp"
#include "collide/hit.hpp"

#include <span>
#include <vector>

namespace tess::collide {

/// Objects of one owner and model, numbered from `first` on, in 32 bits. submit() copies the boxes
/// and capsules: they must live until it returns.
struct Objects {
  OwnerId owner{};
  ModelId model{};
  std::span<const Aabb> boxes;
  LocalId first{};
  /// Bound long thin objects: one per box, or none. Pairs whose capsules are certainly apart are no
  /// hits.
  std::span<const Capsule> capsules{};
};

/// Objects of one owner and model, numbered from 0 on.
struct Submission {
  OwnerId owner{};
  ModelId model{};
  std::vector<Aabb> boxes{};
};

}  // namespace tess::collide
