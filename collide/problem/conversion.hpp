// Converts the six coordinates of a box to six cell indices: floor((x - origin) * per_voxel). This
// is the inner loop of gridding, in three forms: plain, four lanes and eight lanes. All forms do
// the same IEEE operations, so they agree bit for bit (a test compares them). convert() is the
// widest form that the instruction set allows. A NaN, or a coordinate without a 32-bit index, is
// not wrapped: the functions return false.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#if defined(__AVX2__) || defined(__AVX512VL__)
#include <immintrin.h>
#endif

namespace tess::collide::search::conversion {

/// The grid for the lanes x y z x y z; the last two lanes are unused.
struct Constants {
  alignas(64) double origin[8];
  alignas(64) double per_voxel[8];
};

inline constexpr double least_index = -2147483648.0, largest_index = 2147483647.0;

/// `box`: lo x y z, hi x y z. Writes six indices. Also returns false if lo > hi on an axis.
[[nodiscard]] inline bool convert_plain(const Constants& grid, const double* box,
                                        std::int32_t* cells) noexcept {
  bool good = true;
  for (std::size_t k = 0; k < 6; ++k) {
    const double cell = std::floor((box[k] - grid.origin[k]) * grid.per_voxel[k]);
    const bool fits = cell >= least_index && cell <= largest_index;
    cells[k] = fits ? static_cast<std::int32_t>(cell) : 0;
    good = good && fits && (k >= 3 || box[k] <= box[k + 3]);
  }
  return good;
}

#ifdef __AVX2__
[[nodiscard]] inline bool convert_avx2(const Constants& grid, const double* box,
                                       std::int32_t* cells) noexcept {
  const __m256i three = _mm256_setr_epi64x(-1, -1, -1, 0);
  int good = 7;
  __m256d corner[2];
  for (std::size_t k = 0; k < 2; ++k) {
    corner[k] = _mm256_maskload_pd(box + 3 * k, three);
    const __m256d cell = _mm256_floor_pd(_mm256_mul_pd(
        _mm256_sub_pd(corner[k], _mm256_load_pd(grid.origin)), _mm256_load_pd(grid.per_voxel)));
    const __m256d fits =
        _mm256_and_pd(_mm256_cmp_pd(cell, _mm256_set1_pd(least_index), _CMP_GE_OQ),
                      _mm256_cmp_pd(cell, _mm256_set1_pd(largest_index), _CMP_LE_OQ));
    good &= _mm256_movemask_pd(fits);
    const __m128i indices = _mm256_cvttpd_epi32(_mm256_and_pd(cell, fits));  // 0 if it does not fit
    _mm_maskstore_epi32(cells + 3 * k, _mm_setr_epi32(-1, -1, -1, 0), indices);
  }
  good &= _mm256_movemask_pd(_mm256_cmp_pd(corner[0], corner[1], _CMP_LE_OQ));
  return good == 7;
}
#endif

#if defined(__AVX512VL__) && defined(__AVX512DQ__)
[[nodiscard]] inline bool convert_avx512(const Constants& grid, const double* box,
                                         std::int32_t* cells) noexcept {
  const __m512d x = _mm512_maskz_loadu_pd(0x3F, box);
  const __m512d cell = _mm512_maskz_roundscale_pd(
      0x3F,
      _mm512_mul_pd(_mm512_sub_pd(x, _mm512_load_pd(grid.origin)), _mm512_load_pd(grid.per_voxel)),
      _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  __mmask8 fits = _mm512_mask_cmp_pd_mask(0x3F, cell, _mm512_set1_pd(least_index), _CMP_GE_OQ);
  fits = _mm512_mask_cmp_pd_mask(fits, cell, _mm512_set1_pd(largest_index), _CMP_LE_OQ);
  const __m512d hi = _mm512_castsi512_pd(
      _mm512_maskz_alignr_epi64(0x07, _mm512_castpd_si512(x), _mm512_castpd_si512(x), 3));
  const __mmask8 ordered = _mm512_mask_cmp_pd_mask(0x07, x, hi, _CMP_LE_OQ);
  // The six loads that follow cannot be forwarded from a masked store, so store a whole register.
  alignas(32) std::int32_t whole[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(whole), _mm512_maskz_cvttpd_epi32(fits, cell));
  std::memcpy(cells, whole, 6 * sizeof(std::int32_t));
  return fits == 0x3F && ordered == 0x07;
}
#endif

[[nodiscard]] inline bool convert(const Constants& grid, const double* box,
                                  std::int32_t* cells) noexcept {
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
  return convert_avx512(grid, box, cells);
#elif defined(__AVX2__)
  return convert_avx2(grid, box, cells);
#else
  return convert_plain(grid, box, cells);
#endif
}

}  // namespace tess::collide::search::conversion
