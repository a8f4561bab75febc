// The weights of a transfer as a sparse matrix (CSR), and files of them. coupling_weights.hpp
// collects the matrix of a coupling. Applied to a field it gives the values of the transfer, bit
// for bit where the coupling is linear:
//
//     WeightMatrix weights;
//     co_await collect_weights(coupling, source.n_points(), target.n_points(), &weights);
//     write_weights("a_to_b.nc", weights);
//     // Later, without a search:
//     apply(read_weights("a_to_b.nc"), field_of_a, n_components, field_of_b);
//
// Files are NetCDF in the layout of ESMF's weight files (ESMF Reference Manual, "Regrid
// Interpolation Weights File Format"), which coupled codes read:
//
//     dimensions: n_a (source vertices), n_b (target vertices), n_s (weights)
//     variables:  int row(n_s), int col(n_s): vertices of target and source, from 1 on
//                 double S(n_s): the weights
//                 int src_grid_dims(1), dst_grid_dims(1): n_a and n_b
//
// They are written as NetCDF-3 (CDF-2, or CDF-5 from 2^28 weights on), and only that is read.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/rows/weights/rows.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tess::m2m {

/// target = matrix × source.
struct WeightMatrix {
  Rows<double> rows;           ///< per target vertex, by global id; columns: global ids
  std::int64_t n_columns = 0;  ///< source vertices

  [[nodiscard]] std::int64_t n_rows() const noexcept {
    return static_cast<std::int64_t>(rows.n_rows());
  }
};

/// Throws Error (bad_value) if there are no weights, (bad_file, environment) if the file cannot be
/// written; no partial file remains.
void write_weights(const std::string& path, const WeightMatrix& matrix);

/// The order of rows in the file does not matter; within a row the columns keep it. Throws Error
/// (bad_file) if the file is damaged or has another layout, (bad_value) with the weight that names
/// a vertex out of range or is not finite. Rows take 8 bytes of memory each, also those without
/// weights: more than 2^24 rows, and than 1 000 per byte of the file, are damage.
[[nodiscard]] WeightMatrix read_weights(const std::string& path);
/// Reads any number of rows, and calls check_fits() before anything is allocated.
[[nodiscard]] WeightMatrix read_weights(const std::string& path, const TetMesh& source,
                                        const TetMesh& target);

/// Throws Error (bad_value) with both sizes unless the matrix is of these meshes. `path`: of the
/// file that it comes from.
void check_fits(const WeightMatrix& matrix, const std::string& path, const TetMesh& source,
                const TetMesh& target);

/// Sets out[row] to the sum of weight × values[column]. `values`: n_columns × n_components, `out`:
/// n_rows × n_components, both row-major. A row without weights, a point outside the source, keeps
/// what `out` has. A single weight of 1 copies the value; a row of four is added in pairs, as
/// transfers add it; others from left to right.
void apply(const WeightMatrix& matrix, std::span<const double> values, std::size_t n_components,
           std::span<double> out);

}  // namespace tess::m2m
