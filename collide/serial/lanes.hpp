// The boxes of one voxel, coordinate by coordinate, so that one of them is compared with eight
// others at a time. A scratch space: filled for a voxel, searched, filled again; it never shrinks.
// Probe::overlaps() has an AVX-512 and a plain form; both only compare, so they agree bit for bit.
#pragma once

#include "collide/hit.hpp"
#include "collide/serial/territory.hpp"

#include <limits>
#include <vector>
#ifdef __AVX512VL__
#include <immintrin.h>
#endif

namespace tess {

struct Lanes {
  static constexpr std::size_t width = 8;

  std::array<std::vector<double>, 3> lo, hi;
  std::vector<std::uint32_t> below;  ///< axes_below() of each box
  std::vector<std::uint32_t> model;
  std::vector<std::uint32_t> source;  ///< the caller's number of each box
  std::size_t n = 0;

  /// Room for `count` boxes and, behind them, `width` that overlap nothing.
  void resize(std::size_t count) {
    n = count;
    if (below.size() < n + width) {
      for (auto* v : {&lo[0], &lo[1], &lo[2], &hi[0], &hi[1], &hi[2]}) v->resize(2 * n + width);
      for (auto* v : {&below, &model, &source}) v->resize(2 * n + width);
    }
    for (std::size_t i = n; i < n + width; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        lo[k][i] = std::numeric_limits<double>::infinity();
        hi[k][i] = -std::numeric_limits<double>::infinity();
      }
  }
  void set(
      std::size_t i, const Item& item, const Cell& voxel, const Cell& lower, std::uint32_t number) {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k][i] = item.box.lo[k];
      hi[k][i] = item.box.hi[k];
    }
    below[i] = axes_below(lower, voxel);
    model[i] = static_cast<std::uint32_t>(item.id.model);
    source[i] = number;
  }
  void copy(std::size_t i, const Lanes& from, std::size_t j) {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k][i] = from.lo[k][j];
      hi[k][i] = from.hi[k][j];
    }
    below[i] = from.below[j];
    model[i] = from.model[j];
    source[i] = from.source[j];
  }
};

/// One box, about to be compared with others under fixed rules.
template <Touching touching, WithinModel within>
class Probe {
 public:
  Probe(const Lanes& lanes, std::size_t i) : lanes_(lanes), i_(i) {}

  /// Bit b is set where box j + b overlaps this one, is of a model that counts, and the pair is
  /// this voxel's.
  [[nodiscard]] std::uint32_t overlaps(std::size_t j) const noexcept {
#ifdef __AVX512VL__
    constexpr int le = touching == Touching::counts ? _CMP_LE_OQ : _CMP_LT_OQ;
    __mmask8 hit = 0xFF;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto lo = _mm512_loadu_pd(lanes_.lo[k].data() + j);
      const auto hi = _mm512_loadu_pd(lanes_.hi[k].data() + j);
      hit = _mm512_mask_cmp_pd_mask(hit, lo, _mm512_set1_pd(lanes_.hi[k][i_]), le);
      hit = _mm512_mask_cmp_pd_mask(hit, _mm512_set1_pd(lanes_.lo[k][i_]), hi, le);
    }
    const auto load = [j](const auto& v) {
      return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(v.data() + j));
    };
    const auto all = [](std::uint32_t v) { return _mm256_set1_epi32(static_cast<int>(v)); };
    hit = _mm256_mask_testn_epi32_mask(hit, load(lanes_.below), all(lanes_.below[i_]));
    if constexpr (within == WithinModel::skip)
      hit = _mm256_mask_cmpneq_epi32_mask(hit, load(lanes_.model), all(lanes_.model[i_]));
    return hit;
#else
    return overlaps_plain(j);
#endif
  }

  /// The same without vector instructions; what the tests hold overlaps() against.
  [[nodiscard]] std::uint32_t overlaps_plain(std::size_t j) const noexcept {
    std::uint32_t hits = 0;
    for (std::size_t b = 0; b < Lanes::width; ++b) {
      bool hit = reports(lanes_.below[i_], lanes_.below[j + b]);
      if (within == WithinModel::skip) hit &= lanes_.model[i_] != lanes_.model[j + b];
      for (std::size_t k = 0; k < 3; ++k) {
        const double lo = lanes_.lo[k][j + b], hi = lanes_.hi[k][j + b];
        hit &= touching == Touching::counts ? lo <= lanes_.hi[k][i_] && lanes_.lo[k][i_] <= hi
                                            : lo < lanes_.hi[k][i_] && lanes_.lo[k][i_] < hi;
      }
      hits |= hit ? 1u << b : 0u;
    }
    return hits;
  }

 private:
  const Lanes& lanes_;
  std::size_t i_;
};

}  // namespace tess
