#include "apps/bench/collide/conversion.hpp"

#include "collide/problem/conversion.hpp"
#include "collide/problem/region_grid.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace bench {
namespace {

constexpr double kLeast = -2147483648.0, kLargest = 2147483647.0;

using Boxes = std::span<const tess::collide::Aabb>;

/// The coordinates of boxes, which have no padding, one after the other.
struct Coordinates {
  const double* x;
  std::size_t n;
};
Coordinates coordinates(Boxes boxes) {
  static_assert(sizeof(tess::collide::Aabb) == 6 * sizeof(double));
  return {boxes.front().lo.data(), 6 * boxes.size()};
}

/// Keeps the compiler from using vectors for a loop that this stands in.
inline void scalar(double& x) {
#if defined(__x86_64__)
  asm volatile("" : "+x"(x));
#else
  asm volatile("" : "+m"(x));
#endif
}

double (*volatile floor_of_libm)(double) = std::floor;

bool by_libm(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const double per_voxel = 1 / axis.size;
  double (*const call)(double) = floor_of_libm;
  bool good = true;
  for (std::size_t i = 0; i < n; ++i) {
    const double cell = call((x[i] - axis.origin) * per_voxel);
    const bool fits = cell >= kLeast && cell <= kLargest;
    index[i] = fits ? static_cast<std::int32_t>(cell) : 0;
    good = good && fits;
  }
  return good;
}

bool by_floor(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const double per_voxel = 1 / axis.size;
  bool good = true;
  for (std::size_t i = 0; i < n; ++i) {
    double at = (x[i] - axis.origin) * per_voxel;
    scalar(at);
    const double cell = std::floor(at);
    const bool fits = cell >= kLeast && cell <= kLargest;
    index[i] = fits ? static_cast<std::int32_t>(cell) : 0;
    good = good && fits;
  }
  return good;
}

/// As the processor does it; in C++ the value is undefined out of range.
std::int32_t cast(double x) {
#if defined(__x86_64__)
  return _mm_cvttsd_si32(_mm_set_sd(x));
#else
  return static_cast<std::int32_t>(std::clamp(x, kLeast, kLargest));
#endif
}

bool by_cast(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const double per_voxel = 1 / axis.size;
  for (std::size_t i = 0; i < n; ++i) {
    double at = (x[i] - axis.origin) * per_voxel;
    scalar(at);
    index[i] = cast(at);
  }
  return true;
}

/// Adds a constant so that the index stands in the low bits of the sum: 23 bits of a float.
bool by_paper(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const double convert = (1.5 * 0x1p23 - 0.5) * axis.size - axis.origin;
  const auto zero = std::bit_cast<std::int32_t>(static_cast<float>(1.5 * 0x1p23 * axis.size));
  for (std::size_t i = 0; i < n; ++i) {
    double at = x[i] + convert;
    scalar(at);
    index[i] = std::bit_cast<std::int32_t>(static_cast<float>(at)) - zero;
  }
  return true;
}

/// What the compiler makes of a plain loop, with the checks.
bool by_loop(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const double per_voxel = 1 / axis.size;
  int good = 1;
  for (std::size_t i = 0; i < n; ++i) {
    const double cell = std::floor((x[i] - axis.origin) * per_voxel);
    const int fits = (cell >= kLeast ? 1 : 0) & (cell <= kLargest ? 1 : 0);
    index[i] = static_cast<std::int32_t>(fits != 0 ? cell : 0.0);
    good &= fits;
  }
  return good != 0;
}

#ifdef __AVX2__
bool by_avx2(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const __m256d origin = _mm256_set1_pd(axis.origin), per_voxel = _mm256_set1_pd(1 / axis.size);
  __m256d good = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
  for (std::size_t i = 0; i < n; i += 4) {
    const __m256d cell =
        _mm256_floor_pd(_mm256_mul_pd(_mm256_sub_pd(_mm256_loadu_pd(x + i), origin), per_voxel));
    const __m256d fits = _mm256_and_pd(_mm256_cmp_pd(cell, _mm256_set1_pd(kLeast), _CMP_GE_OQ),
                                       _mm256_cmp_pd(cell, _mm256_set1_pd(kLargest), _CMP_LE_OQ));
    good = _mm256_and_pd(good, fits);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(index + i),
                     _mm256_cvttpd_epi32(_mm256_and_pd(cell, fits)));
  }
  return _mm256_movemask_pd(good) == 0xF;
}
#endif

#ifdef __AVX512VL__
bool by_avx512(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  const auto [x, n] = coordinates(boxes);
  const __m512d origin = _mm512_set1_pd(axis.origin), per_voxel = _mm512_set1_pd(1 / axis.size);
  __mmask8 good = 0xFF;
  for (std::size_t i = 0; i < n; i += 8) {
    const __m512d cell = _mm512_maskz_roundscale_pd(
        0xFF, _mm512_mul_pd(_mm512_sub_pd(_mm512_loadu_pd(x + i), origin), per_voxel),
        _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
    __mmask8 fits = _mm512_cmp_pd_mask(cell, _mm512_set1_pd(kLeast), _CMP_GE_OQ);
    fits = _mm512_mask_cmp_pd_mask(fits, cell, _mm512_set1_pd(kLargest), _CMP_LE_OQ);
    good &= fits;
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(index + i),
                        _mm512_maskz_cvttpd_epi32(fits, cell));
  }
  return good == 0xFF;
}
#endif

/// The chares' conversion: six coordinates of a box.
bool by_chares(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  tess::collide::search::conversion::Constants grid{};
  for (std::size_t k = 0; k < 8; ++k) {
    grid.origin[k] = axis.origin;
    grid.per_voxel[k] = 1 / axis.size;
  }
  bool good = true;
  for (std::size_t b = 0; b < boxes.size(); ++b)
    good =
        tess::collide::search::conversion::convert(grid, boxes[b].lo.data(), index + 6 * b) && good;
  return good;
}

/// The serial face's: a grid of 2^20 cells around the origin, whose border cells reach to infinity.
constexpr std::int32_t kHalf = 1 << 19;
bool by_pairs(const VoxelAxis& axis, Boxes boxes, std::int32_t* index) {
  using namespace tess::collide;
  const double lo = axis.origin - kHalf * axis.size, hi = axis.origin + kHalf * axis.size;
  const search::RegionGrid<double, 3> grid({{lo, lo, lo}, {hi, hi, hi}},
                                           {2 * kHalf, 2 * kHalf, 2 * kHalf});
  for (const Aabb& box : boxes) {
    const Box<std::int32_t, 3> cells = grid.cells(box);
    for (std::size_t k = 0; k < 3; ++k) {
      index[k] = cells.lo[k] - kHalf;
      index[k + 3] = cells.hi[k] - kHalf;
    }
    index += 6;
  }
  return true;
}

constexpr Conversion all[] = {
    {"libm", "floor, a call of the C library", OutOfRange::refuses, by_libm},
    {"floor", "floor, one instruction", OutOfRange::refuses, by_floor},
    {"cast", "a cast, which truncates", OutOfRange::wraps, by_cast},
    {"paper", "the constant of the paper's appendix A", OutOfRange::wraps, by_paper},
    {"loop", "floor in a loop, as the compiler translates it", OutOfRange::refuses, by_loop},
#ifdef __AVX2__
    {"avx2", "floor, four lanes", OutOfRange::refuses, by_avx2},
#endif
#ifdef __AVX512VL__
    {"avx512", "floor, eight lanes", OutOfRange::refuses, by_avx512},
#endif
    {"chares", "of the collider on chares: floor, six coordinates of a box, order checked",
     OutOfRange::refuses, by_chares},
    {"pairs", "of collide/pairs.hpp: clamp and truncation, six coordinates of a box",
     OutOfRange::clamps, by_pairs},
};

constexpr VoxelAxis kAxis{0, 0.25};
constexpr std::int32_t kNoIndex = std::numeric_limits<std::int32_t>::max() - 1;

/// The index of one coordinate, in all places of a call; kNoIndex if it is refused.
std::int32_t index_of(const Conversion& conversion, double x) {
  std::array<tess::collide::Aabb, 4> same;
  same.fill({{x, x, x}, {x, x, x}});
  std::array<std::int32_t, 24> index{};
  if (!conversion.run(kAxis, same, index.data())) return kNoIndex;
  for (const std::int32_t other : index)
    if (other != index[0]) return kNoIndex;
  return index[0];
}

}  // namespace

std::span<const Conversion> conversions() {
  return all;
}

ConversionErrors errors_on_faces(const Conversion& conversion) {
  ConversionErrors errors;
  for (std::int32_t k = -1000; k < 1000; ++k) {
    ++errors.n;
    if (index_of(conversion, kAxis.origin + k * kAxis.size) != k) ++errors.n_wrong;
  }
  return errors;
}

ConversionErrors errors_of_negatives(const Conversion& conversion) {
  ConversionErrors errors;
  tess::Random random(1);
  for (std::int32_t k = -1000; k < 0; ++k) {
    ++errors.n;
    const double x = kAxis.origin + (k + 0.01 + 0.98 * random.unit()) * kAxis.size;
    if (index_of(conversion, x) != k) ++errors.n_wrong;
  }
  return errors;
}

ConversionErrors errors_out_of_range(const Conversion& conversion) {
  ConversionErrors errors;
  for (double beyond = 0x1p31; beyond < 1e30; beyond *= 1.7)
    for (const double sign : {-1.0, 1.0}) {
      ++errors.n;
      const std::int32_t index = index_of(conversion, sign * (beyond + 1) * kAxis.size);
      const bool right = conversion.out_of_range == OutOfRange::clamps
                             ? index == (sign < 0 ? -kHalf : kHalf - 1)
                             : index == kNoIndex;
      if (!right) ++errors.n_wrong;
    }
  return errors;
}

}  // namespace bench
