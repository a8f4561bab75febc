// The boxes of one voxel as arrays of coordinates, so that a box can be compared with eight others
// at a time. Lanes is scratch memory: it is filled per voxel and never shrinks. A Probe is the box
// that is compared. overlaps() has an AVX-512 form and a plain form; both only compare numbers, so
// they agree bit for bit.
#pragma once

#include "collide/hit.hpp"
#include "collide/serial/territory.hpp"

#include <bit>
#include <limits>
#include <memory>
#ifdef __AVX512VL__
#include <immintrin.h>
#endif

namespace tess::collide::serial {

class Lanes {
 public:
  static constexpr std::size_t width = 8;

  /// Makes room for `n` boxes, followed by `width` boxes that overlap nothing. Drops earlier
  /// contents.
  void resize(std::size_t n) {
    n_ = n;
    if (n + width > stride_) {
      stride_ = 2 * n + width;
      coordinates_ = std::make_unique_for_overwrite<double[]>(6 * stride_);
      numbers_ = std::make_unique_for_overwrite<std::uint32_t[]>(3 * stride_);
      for (std::size_t k = 0; k < 3; ++k) {
        lo[k] = coordinates_.get() + k * stride_;
        hi[k] = coordinates_.get() + (k + 3) * stride_;
      }
      below = numbers_.get();
      model = below + stride_;
      source = model + stride_;
    }
    for (std::size_t i = n; i < n + width; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        lo[k][i] = std::numeric_limits<double>::infinity();
        hi[k][i] = -std::numeric_limits<double>::infinity();
      }
      below[i] = model[i] = source[i] = 0;
    }
  }
  void set(std::size_t i, const Item& item, std::uint32_t axes, std::uint32_t number) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k][i] = item.box.lo[k];
      hi[k][i] = item.box.hi[k];
    }
    below[i] = axes;
    model[i] = static_cast<std::uint32_t>(item.id.model);
    source[i] = number;
  }
  /// For each set bit b, writes the number of box j + b to `out`, which has room for eight. Returns
  /// the end of the numbers written.
  std::uint32_t* copy_sources(std::size_t j, std::uint32_t bits,
                              std::uint32_t* out) const noexcept {
#ifdef __AVX512VL__
    const auto all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(source + j));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), all));
    return out + std::popcount(bits);
#else
    for (; bits != 0; bits &= bits - 1)
      *out++ = source[j + static_cast<std::size_t>(std::countr_zero(bits))];
    return out;
#endif
  }
  [[nodiscard]] std::size_t size() const noexcept { return n_; }

  std::array<double*, 3> lo{}, hi{};
  std::uint32_t* below = nullptr;   ///< per box: axes_below()
  std::uint32_t* model = nullptr;   ///< per box
  std::uint32_t* source = nullptr;  ///< per box: the index that the caller gave

 private:
  std::unique_ptr<double[]> coordinates_;
  std::unique_ptr<std::uint32_t[]> numbers_;
  std::size_t n_ = 0;
  std::size_t stride_ = 0;
};

/// A box that is compared with others under fixed rules.
template <Touching touching, WithinModel within>
class Probe {
 public:
  /// `below`: axes_below() of the item in this voxel.
  Probe(const Item& item, std::uint32_t below) noexcept
      : box_(item.box), below_(below), model_(static_cast<std::uint32_t>(item.id.model)) {}
  Probe(const Lanes& lanes, std::size_t i) noexcept
      : box_{{lanes.lo[0][i], lanes.lo[1][i], lanes.lo[2][i]},
             {lanes.hi[0][i], lanes.hi[1][i], lanes.hi[2][i]}},
        below_(lanes.below[i]),
        model_(lanes.model[i]) {}

  [[nodiscard]] const Aabb& box() const noexcept { return box_; }

  /// Bit b is set if box j + b overlaps this box, the models count, and the voxel is responsible
  /// for the pair.
  [[nodiscard]] std::uint32_t overlaps(const Lanes& lanes, std::size_t j) const noexcept {
#ifdef __AVX512VL__
    constexpr int le = touching == Touching::counts ? _CMP_LE_OQ : _CMP_LT_OQ;
    __mmask8 hit = 0xFF;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto lo = _mm512_loadu_pd(lanes.lo[k] + j);
      const auto hi = _mm512_loadu_pd(lanes.hi[k] + j);
      hit = _mm512_mask_cmp_pd_mask(hit, lo, _mm512_set1_pd(box_.hi[k]), le);
      hit = _mm512_mask_cmp_pd_mask(hit, _mm512_set1_pd(box_.lo[k]), hi, le);
    }
    const auto load = [j](const std::uint32_t* v) {
      return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(v + j));
    };
    const auto all = [](std::uint32_t v) { return _mm256_set1_epi32(static_cast<int>(v)); };
    hit = _mm256_mask_testn_epi32_mask(hit, load(lanes.below), all(below_));
    if constexpr (within == WithinModel::skip)
      hit = _mm256_mask_cmpneq_epi32_mask(hit, load(lanes.model), all(model_));
    return hit;
#else
    return overlaps_plain(lanes, j);
#endif
  }

  /// The same without vector instructions; a test compares it with overlaps().
  [[nodiscard]] std::uint32_t overlaps_plain(const Lanes& lanes, std::size_t j) const noexcept {
    std::uint32_t hits = 0;
    for (std::size_t b = 0; b < Lanes::width; ++b) {
      bool hit = reports(below_, lanes.below[j + b]);
      if (within == WithinModel::skip) hit &= model_ != lanes.model[j + b];
      for (std::size_t k = 0; k < 3; ++k) {
        const double lo = lanes.lo[k][j + b], hi = lanes.hi[k][j + b];
        hit &= touching == Touching::counts ? lo <= box_.hi[k] && box_.lo[k] <= hi
                                            : lo < box_.hi[k] && box_.lo[k] < hi;
      }
      hits |= hit ? 1u << b : 0u;
    }
    return hits;
  }

 private:
  Aabb box_;
  std::uint32_t below_;
  std::uint32_t model_;
};

}  // namespace tess::collide::serial
