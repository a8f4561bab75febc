// A piece of a wall's mesh: some rows of points of the unit square z = 0, cut into n² squares of two
// triangles each. It holds the first row of the next piece, too, for the triangles between.
#pragma once

#include "m2m/mesh_view.hpp"

#include <cstdint>
#include <vector>

namespace fsi {

using tess::m2m::Point;

class Strip {
 public:
  Strip() = default;
  Strip(std::int32_t n, std::int32_t n_pieces, std::int32_t piece);

  [[nodiscard]] tess::m2m::MeshView view() const {
    return {.points = points_,
            .tets = triangles_,
            .point_ids = point_ids_,
            .tet_ids = triangle_ids_,
            .n_owned = static_cast<std::int64_t>(n_owned_),
            .dimension = 2};
  }
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] std::size_t n_owned() const { return n_owned_; }
  [[nodiscard]] std::size_t n_points() const { return points_.size(); }
  /// Points of a row.
  [[nodiscard]] std::size_t side() const { return static_cast<std::size_t>(n_) + 1; }
  [[nodiscard]] bool is_first() const { return is_first_; }
  [[nodiscard]] bool is_last() const { return points_.size() == n_owned_; }
  /// The point is on an edge of the square, which does not move.
  [[nodiscard]] bool is_held(std::size_t point) const;
  /// The share of a point in the area of the square.
  [[nodiscard]] double area(std::size_t point) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_, first_row_, n_owned_, is_first_, points_, triangles_, point_ids_, triangle_ids_);
  }

 private:
  /// The row and the column are the first or the last.
  [[nodiscard]] int n_edges_at(std::size_t point) const;

  std::int32_t n_ = 0, first_row_ = 0;
  std::size_t n_owned_ = 0;
  bool is_first_ = true;
  std::vector<Point> points_;
  std::vector<tess::m2m::Tet> triangles_;
  std::vector<tess::m2m::GlobalId> point_ids_, triangle_ids_;
};

}  // namespace fsi
