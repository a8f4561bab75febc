// The distances of a field, and its exact normals.
#pragma once

#include "collide/dn_field/build/inside.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/field.hpp"

#include <optional>

namespace tess::dn {

class Distances {
 public:
  /// Does not refer to `surface` afterwards.
  Distances(const Surface& surface, Sides sides, const Grid& grid);
  Distances(const Distances&) = delete;
  Distances& operator=(const Distances&) = delete;

  /// Fills the layers `first` to `last` − 1 of `field`, whole blocks, up to its thickness; normals
  /// if it has room for them. Any thread, different layers at once.
  void fill(Field& field, int first, int last) const;

  [[nodiscard]] const Bvh& tree() const { return tree_; }

 private:
  void fill_shelf(Field& field, int first) const;  // the layers of a block
  void fill_block(Field& field, int i, int j, int k) const;
  [[nodiscard]] Vec3 normal_at(const PreparedTriangle& triangle, Vec3 p, double cell) const;

  Bvh tree_;
  std::optional<Inside> inside_;  // none for two-sided fields
};

}  // namespace tess::dn
