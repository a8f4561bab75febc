// A grid over a region: it maps a coordinate to a cell per axis. Cells at the border reach to
// infinity, so every coordinate has one, and
//
//     x <= y  =>  cell(x) <= cell(y)
//
// holds for every rounding, which is all that entry.hpp needs. The border is no limit of the
// method: a border cell that receives too much is divided again.
//
// The conversion is a clamp and a truncation; bench_collide compares it with the floor and with the
// trick of the paper's appendix A.
#pragma once

#include "collide/box.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/core/simd.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

namespace tess::collide::search {

/// A cell per axis.
template <std::size_t D>
using CellAt = std::array<std::int32_t, D>;

template <class Real, std::size_t D>
class RegionGrid {
 public:
  /// n_cells: at least 1 per axis, at most 2^20. An axis without an extent has one cell.
  RegionGrid(const Box<Real, D>& region, const CellAt<D>& n_cells)
      : lo_(region.lo), n_cells_(n_cells) {
    for (std::size_t k = 0; k < D; ++k) {
      per_length_[k] = static_cast<Real>(n_cells[k]) / (region.hi[k] - region.lo[k]);
      if (!std::isfinite(per_length_[k]) || !(per_length_[k] > 0)) {
        per_length_[k] = 0;
        n_cells_[k] = 1;
      }
      last_[k] = static_cast<Real>(n_cells_[k] - 1);
      for (const std::size_t lane : {k, k + D}) {
        lanes_lo_[lane] = lo_[k];
        lanes_per_length_[lane] = per_length_[k];
        lanes_last_[lane] = last_[k];
      }
    }
    const std::array<std::uint32_t, D> strides = this->strides();
    std::copy(strides.begin(), strides.end(), lanes_strides_);
  }

  [[nodiscard]] std::int32_t cell(Real x, std::size_t k) const noexcept {
    const Real at = (x - lo_[k]) * per_length_[k];
    const Real above = at > 0 ? at : Real{0};  // also for NaN, if x - lo_ overflows
    return static_cast<std::int32_t>(above < last_[k] ? above : last_[k]);
  }
  /// The cells that a box touches.
  [[nodiscard]] Box<std::int32_t, D> cells(const Box<Real, D>& box) const noexcept {
    Box<std::int32_t, D> out;
    for (std::size_t k = 0; k < D; ++k) {
      out.lo[k] = cell(box.lo[k], k);
      out.hi[k] = cell(box.hi[k], k);
    }
    return out;
  }
  /// The cells of a box in a word: the number of the lower corner's cell, then a bit per axis that
  /// has two of them; `large` if an axis has more. Grids have fewer than 2^28 cells.
  static constexpr std::uint32_t large = ~std::uint32_t{0};
  [[nodiscard]] std::uint32_t code(const Box<Real, D>& box) const noexcept {
    using Reals = simd::Vector<Real, 8>;
    if constexpr (sizeof(Reals) <= simd::widest) {
      // With vectors; the same operations.
      using Ints = simd::Vector<std::int32_t, 8>;
      constexpr simd::Bits corner = (1U << D) - 1;
      const Reals at =
          (simd::load_first<Reals, 2 * D>(box.lo.data()) - simd::load<Reals>(lanes_lo_)) *
          simd::load<Reals>(lanes_per_length_);
      const Reals clamped = simd::min(simd::max(at, Reals{}), simd::load<Reals>(lanes_last_));
      const Ints lo = __builtin_convertvector(clamped, Ints);
      const Ints hi = upper_ends(lo, std::make_index_sequence<8>());
      const Ints more = hi - lo, one = simd::all<Ints>(1),
                 parts = lo * simd::load<Ints>(lanes_strides_);
      auto sum = __builtin_shufflevector(parts, parts, 0, 1, 2, 3);  // beyond the corner they are 0
      sum += __builtin_shufflevector(sum, sum, 2, 3, 0, 1);
      sum += __builtin_shufflevector(sum, sum, 1, 0, 3, 2);
      if (simd::less<false>(corner, one, more) != 0) return large;
      return static_cast<std::uint32_t>(sum[0]) << D | simd::less<true>(corner, one, more);
    }
    const Box<std::int32_t, D> range = cells(box);
    std::uint32_t two = 0, longest = 0;
    for (std::size_t k = 0; k < D; ++k) {
      const auto more = static_cast<std::uint32_t>(range.hi[k] - range.lo[k]);
      two |= (more & 1U) << k;
      longest |= more;
    }
    return longest < 2 ? number(range.lo) << D | two : large;
  }

  [[nodiscard]] const CellAt<D>& n_cells() const noexcept { return n_cells_; }
  [[nodiscard]] std::size_t size() const noexcept {
    std::size_t n = 1;
    for (std::size_t k = 0; k < D; ++k) n *= static_cast<std::size_t>(n_cells_[k]);
    return n;
  }
  [[nodiscard]] std::uint32_t number(const CellAt<D>& at) const noexcept {
    std::uint32_t out = 0;
    for (std::size_t k = 0; k < D; ++k)
      out = out * static_cast<std::uint32_t>(n_cells_[k]) + static_cast<std::uint32_t>(at[k]);
    return out;
  }
  /// What a step along each axis adds to the number.
  [[nodiscard]] std::array<std::uint32_t, D> strides() const noexcept {
    std::array<std::uint32_t, D> out;
    std::uint32_t stride = 1;
    for (std::size_t k = D; k-- > 0;) {
      out[k] = stride;
      stride *= static_cast<std::uint32_t>(n_cells_[k]);
    }
    return out;
  }
  /// About the region of a cell: choices depend on it, but no answer.
  [[nodiscard]] Box<Real, D> region(std::uint32_t number) const noexcept {
    Box<Real, D> out;
    for (std::size_t k = D; k-- > 0;) {
      const auto n = static_cast<std::uint32_t>(n_cells_[k]);
      const auto at = static_cast<Real>(number % n);
      number /= n;
      const Real length = per_length_[k] > 0 ? 1 / per_length_[k] : Real{0};
      out.lo[k] = lo_[k] + at * length;
      out.hi[k] = lo_[k] + (at + 1) * length;
    }
    return out;
  }
  /// The longest edge of a cell.
  [[nodiscard]] Real cell_size() const noexcept {
    Real size = 0;
    for (std::size_t k = 0; k < D; ++k)
      if (per_length_[k] > 0) size = std::max(size, 1 / per_length_[k]);
    return size;
  }

 private:
  template <class V, std::size_t... k>
  static V upper_ends(V x, std::index_sequence<k...>) noexcept {
    return __builtin_shufflevector(x, x, ((k + D) % 8)...);
  }
  std::array<Real, D> lo_, per_length_, last_;
  // The same for both corners of a box.
  alignas(64) Real lanes_lo_[8]{}, lanes_per_length_[8]{}, lanes_last_[8]{};
  alignas(32) std::uint32_t lanes_strides_[8]{};
  CellAt<D> n_cells_;
};

}  // namespace tess::collide::search
