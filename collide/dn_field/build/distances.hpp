// The distances of a field, and its exact normals.
#pragma once

#include "collide/dn_field/build/inside.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/field.hpp"

#include <optional>

namespace tess::dn {

class Distances {
 public:
  /// Does not refer to `surface` afterwards.
  Distances(const Surface& surface, Sides sides, const Grid& grid);
  Distances(const Distances&) = delete;
  Distances& operator=(const Distances&) = delete;

  /// Fills the layers `first` to `last` − 1 of `field`, up to its thickness; normals if it has room
  /// for them. Any thread, different layers at once.
  void fill(Field& field, int first, int last) const;

  [[nodiscard]] const Bvh& tree() const { return tree_; }

 private:
  struct Shelf;  // up to four layers
  void fill_shelf(const Shelf& shelf) const;
  void fill_block(int i, int j, const Shelf& shelf) const;

  Bvh tree_;
  std::optional<Inside> inside_;  // none for two-sided fields
};

}  // namespace tess::dn
