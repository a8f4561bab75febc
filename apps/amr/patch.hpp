// The cells of a block: the numerics of amr, without messages.
//
// A cell holds its mass as a whole number of quanta, 2^-60 of the mass of u = 1 over the cube. What
// flows through a face is a whole number of quanta as well: what one cell loses the other gains,
// the flow through a face of a coarse cell is the sum of those through the fine faces, children
// share the mass of their parent. So the total mass is exact in any order of summation.
//
// A step is a sweep along each axis (Godunov splitting; the operators commute where cells are
// equal):
//
//     flow = v dt A (u + (1 - c) s / 2),  s = w (u_right - u) + (1 - w) (u - u_left),  c = v dt / h
//
// with u upwind of the face. Order 1: s = 0; order 2: w = 1/2 (Fromm); order 3: w = (2 - c) / 3.
// A sweep needs two layers of neighbours' cells on both sides, and nothing around corners.
//
// Layers are arrays [layer][row][column], layer 0 at the face, columns along the axis after the
// face's, rows along the one after that.
#pragma once

#include "apps/amr/block_index.hpp"
#include "apps/amr/census.hpp"
#include "apps/amr/problem.hpp"

#include <vector>

namespace amr {

using Quanta = std::int64_t;

class Patch {
 public:
  Patch() = default;
  Patch(const Problem& problem, BlockIndex index);

  /// The exact means at a time; the first value of a run.
  void fill(double time);
  [[nodiscard]] Norms compare(double time) const;
  /// The largest difference of two cells that share a face.
  [[nodiscard]] double steepness() const;
  /// n × n values of the layer of cells at a part of its height.
  [[nodiscard]] std::vector<double> slice(double height, std::int32_t n_values) const;

  // What neighbours need of this patch: two layers of values at a face.
  [[nodiscard]] std::vector<double> layers(Face face) const;
  /// For a coarser neighbour: means of eight cells.
  [[nodiscard]] std::vector<double> coarse_layers(Face face) const;
  /// For the finer neighbour at a quarter of the face: values interpolated in one layer of cells.
  [[nodiscard]] std::vector<double> fine_layers(Face face, std::int32_t quadrant) const;

  /// The neighbour's layers, or those of the finer one at this quarter of the face.
  void set_halo(Face face, const std::vector<double>& values);
  void set_halo(Face face, std::int32_t quadrant, const std::vector<double>& values);
  /// The flows through all faces across an axis.
  void compute_flows(std::int32_t axis);
  /// For a coarser neighbour: the flows through a face, of four cells each.
  [[nodiscard]] std::vector<Quanta> coarse_flows(Face face) const;
  /// Replaces the flows at a quarter of a face by those of the finer neighbour.
  void set_flows(Face face, std::int32_t quadrant, const std::vector<Quanta>& flows);
  /// Moves the mass: the end of a sweep.
  void apply_flows(std::int32_t axis);

  /// The masses of a child's cells, and of the cells of the parent that this patch makes up.
  [[nodiscard]] std::vector<Quanta> refined(std::int32_t octant) const;
  [[nodiscard]] std::vector<Quanta> coarsened() const;
  /// Takes all masses, or those of one child's part.
  void take(std::vector<Quanta> masses) { masses_ = std::move(masses); }
  void take(std::int32_t octant, const std::vector<Quanta>& masses);

  [[nodiscard]] std::array<double, 3> low() const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, index_, value_per_quantum_, masses_, halo_, flows_);
  }

 private:
  [[nodiscard]] std::int32_t n() const { return problem_.n_cells; }
  [[nodiscard]] std::size_t at(const std::array<std::int32_t, 3>& cell) const {
    const std::int32_t row = cell[2] * n() + cell[1];
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(n()) +
           static_cast<std::size_t>(cell[0]);
  }
  /// A cell by its place seen from a face: depth below it, column and row.
  [[nodiscard]] std::array<std::int32_t, 3> below(Face face, std::int32_t depth,
                                                  std::int32_t column, std::int32_t row) const;
  /// The distance in masses_ of two cells beside each other along an axis.
  [[nodiscard]] std::size_t stride(std::int32_t axis) const {
    return static_cast<std::size_t>(axis == 0 ? 1 : axis == 1 ? n() : n() * n());
  }
  [[nodiscard]] double value(const std::array<std::int32_t, 3>& cell) const {
    return static_cast<double>(masses_[at(cell)]) * value_per_quantum_;
  }
  /// The value in the part `octant` of a cell, by the slopes within this patch.
  [[nodiscard]] double part_value(const std::array<std::int32_t, 3>& cell,
                                  std::int32_t octant) const;

  Problem problem_;
  BlockIndex index_;
  double value_per_quantum_ = 1;
  std::vector<Quanta> masses_;               // [z][y][x]
  std::array<std::vector<double>, 2> halo_;  // of a sweep: layers below and above
  std::vector<Quanta> flows_;                // of a sweep: [row][column][face along the axis]
};

}  // namespace amr
