// The few vector operations of the search: comparisons of `width` numbers at a time, with one bit
// per number as the result. There is a form for AVX-512, one for AVX2, and a plain one. All of them
// only compare numbers, so they agree bit for bit (a test compares them).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#if defined(__AVX512VL__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace tess::collide::search {

/// One bit per lane.
using Mask = std::uint32_t;

/// Any processor: W numbers in an array.
template <class Real, std::size_t W>
struct PlainWide {
  static constexpr std::size_t width = W;
  using Register = std::array<Real, W>;

  static Register load(const Real* from) noexcept {
    Register out;
    for (std::size_t i = 0; i < W; ++i) out[i] = from[i];
    return out;
  }
  static Register all(Real x) noexcept {
    Register out;
    out.fill(x);
    return out;
  }
  /// The greater and the lesser of two numbers, per lane.
  static Register greater(const Register& a, const Register& b) noexcept {
    Register out;
    for (std::size_t i = 0; i < W; ++i) out[i] = a[i] > b[i] ? a[i] : b[i];
    return out;
  }
  static Register lesser(const Register& a, const Register& b) noexcept {
    Register out;
    for (std::size_t i = 0; i < W; ++i) out[i] = a[i] < b[i] ? a[i] : b[i];
    return out;
  }
  /// The lanes of `among` in which a <= b, or a < b.
  template <bool or_equal>
  static Mask less(Mask among, const Register& a, const Register& b) noexcept {
    Mask out = 0;
    for (std::size_t i = 0; i < W; ++i)
      out |= static_cast<Mask>(or_equal ? a[i] <= b[i] : a[i] < b[i]) << i;
    return out & among;
  }
  /// The lanes of `among` in which no bit of `bits` is set.
  static Mask disjoint(Mask among, const std::uint32_t* from, std::uint32_t bits) noexcept {
    Mask out = 0;
    for (std::size_t i = 0; i < W; ++i) out |= static_cast<Mask>((from[i] & bits) == 0) << i;
    return out & among;
  }
  /// The lanes of `among` that differ from `value`.
  static Mask differ(Mask among, const std::uint32_t* from, std::uint32_t value) noexcept {
    Mask out = 0;
    for (std::size_t i = 0; i < W; ++i) out |= static_cast<Mask>(from[i] != value) << i;
    return out & among;
  }
  /// Writes `value` to all of W places.
  static void fill(std::uint32_t* out, std::uint32_t value) noexcept {
    for (std::size_t i = 0; i < W; ++i) out[i] = value;
  }
  /// Writes the objects of the entries of the lanes in `which` to `out`, which has room for W.
  /// Returns their end.
  static std::uint32_t* compress(std::uint32_t* out, Mask which,
                                 const std::uint32_t* from) noexcept {
    for (; which != 0; which &= which - 1) *out++ = from[std::countr_zero(which)] >> 4;
    return out;
  }
};

#if defined(__AVX512VL__)

struct Wide512Float {
  static constexpr std::size_t width = 16;
  using Register = __m512;
  static Register load(const float* from) noexcept { return _mm512_loadu_ps(from); }
  static Register all(float x) noexcept { return _mm512_set1_ps(x); }
  static Register greater(Register a, Register b) noexcept {
    return _mm512_maskz_max_ps(0xFFFF, a, b);
  }
  static Register lesser(Register a, Register b) noexcept {
    return _mm512_maskz_min_ps(0xFFFF, a, b);
  }
  template <bool or_equal>
  static Mask less(Mask among, Register a, Register b) noexcept {
    return _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(among), a, b,
                                   or_equal ? _CMP_LE_OQ : _CMP_LT_OQ);
  }
  static Mask disjoint(Mask among, const std::uint32_t* from, std::uint32_t bits) noexcept {
    return _mm512_mask_testn_epi32_mask(static_cast<__mmask16>(among), _mm512_loadu_si512(from),
                                        _mm512_set1_epi32(static_cast<int>(bits)));
  }
  static Mask differ(Mask among, const std::uint32_t* from, std::uint32_t value) noexcept {
    return _mm512_mask_cmpneq_epi32_mask(static_cast<__mmask16>(among), _mm512_loadu_si512(from),
                                         _mm512_set1_epi32(static_cast<int>(value)));
  }
  static void fill(std::uint32_t* out, std::uint32_t value) noexcept {
    _mm512_storeu_si512(out, _mm512_set1_epi32(static_cast<int>(value)));
  }
  static std::uint32_t* compress(std::uint32_t* out, Mask which,
                                 const std::uint32_t* from) noexcept {
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(
                                 static_cast<__mmask16>(which),
                                 _mm512_maskz_srli_epi32(0xFFFF, _mm512_loadu_si512(from), 4)));
    return out + std::popcount(which);
  }
};

struct Wide512Double {
  static constexpr std::size_t width = 8;
  using Register = __m512d;
  static Register load(const double* from) noexcept { return _mm512_loadu_pd(from); }
  static Register all(double x) noexcept { return _mm512_set1_pd(x); }
  static Register greater(Register a, Register b) noexcept {
    return _mm512_maskz_max_pd(0xFF, a, b);
  }
  static Register lesser(Register a, Register b) noexcept {
    return _mm512_maskz_min_pd(0xFF, a, b);
  }
  template <bool or_equal>
  static Mask less(Mask among, Register a, Register b) noexcept {
    return _mm512_mask_cmp_pd_mask(static_cast<__mmask8>(among), a, b,
                                   or_equal ? _CMP_LE_OQ : _CMP_LT_OQ);
  }
  static Mask disjoint(Mask among, const std::uint32_t* from, std::uint32_t bits) noexcept {
    return _mm256_mask_testn_epi32_mask(static_cast<__mmask8>(among), ints(from),
                                        _mm256_set1_epi32(static_cast<int>(bits)));
  }
  static Mask differ(Mask among, const std::uint32_t* from, std::uint32_t value) noexcept {
    return _mm256_mask_cmpneq_epi32_mask(static_cast<__mmask8>(among), ints(from),
                                         _mm256_set1_epi32(static_cast<int>(value)));
  }
  static void fill(std::uint32_t* out, std::uint32_t value) noexcept {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_set1_epi32(static_cast<int>(value)));
  }
  static std::uint32_t* compress(std::uint32_t* out, Mask which,
                                 const std::uint32_t* from) noexcept {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(which),
                                                    _mm256_srli_epi32(ints(from), 4)));
    return out + std::popcount(which);
  }

 private:
  static __m256i ints(const std::uint32_t* from) noexcept {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  }
};

template <class Real>
using Wide = std::conditional_t<sizeof(Real) == sizeof(float), Wide512Float, Wide512Double>;

#elif defined(__AVX2__)

struct Wide256Float : PlainWide<float, 8> {
  using Register = __m256;
  static Register load(const float* from) noexcept { return _mm256_loadu_ps(from); }
  static Register all(float x) noexcept { return _mm256_set1_ps(x); }
  static Register greater(Register a, Register b) noexcept { return _mm256_max_ps(a, b); }
  static Register lesser(Register a, Register b) noexcept { return _mm256_min_ps(a, b); }
  template <bool or_equal>
  static Mask less(Mask among, Register a, Register b) noexcept {
    return among & static_cast<Mask>(
                       _mm256_movemask_ps(_mm256_cmp_ps(a, b, or_equal ? _CMP_LE_OQ : _CMP_LT_OQ)));
  }
};
struct Wide256Double : PlainWide<double, 4> {
  using Register = __m256d;
  static Register load(const double* from) noexcept { return _mm256_loadu_pd(from); }
  static Register all(double x) noexcept { return _mm256_set1_pd(x); }
  static Register greater(Register a, Register b) noexcept { return _mm256_max_pd(a, b); }
  static Register lesser(Register a, Register b) noexcept { return _mm256_min_pd(a, b); }
  template <bool or_equal>
  static Mask less(Mask among, Register a, Register b) noexcept {
    return among & static_cast<Mask>(
                       _mm256_movemask_pd(_mm256_cmp_pd(a, b, or_equal ? _CMP_LE_OQ : _CMP_LT_OQ)));
  }
};

template <class Real>
using Wide = std::conditional_t<sizeof(Real) == sizeof(float), Wide256Float, Wide256Double>;

#else

template <class Real>
using Wide = PlainWide<Real, 32 / sizeof(Real)>;

#endif

/// The cells of an object that has one or two on each axis, written without a branch: cell c has
/// bit k set if it is the second one on axis k.
template <std::size_t D>
class Corners {
 public:
  static constexpr std::size_t n = std::size_t{1} << D;

  /// `strides`: what a step along each axis adds to the number of a cell.
  explicit Corners(const std::array<std::uint32_t, D>& strides) noexcept {
    for (std::uint32_t c = 0; c < n; ++c) {
      corner_[c] = c;
      offset_[c] = 0;
      for (std::size_t k = 0; k < D; ++k) offset_[c] += (c >> k & 1U) * strides[k];
    }
  }
  /// Writes cell numbers, and entries that have the corner's bits added, each with room for n;
  /// returns how many. `two`: the axes with two cells.
  std::size_t write(std::uint32_t first_cell, std::uint32_t entry, std::uint32_t two,
                    std::uint32_t* cells, std::uint32_t* entries) const noexcept {
#if defined(__AVX512VL__)
    if constexpr (D <= 3) {
      const auto corner = _mm256_load_si256(reinterpret_cast<const __m256i*>(corner_.data()));
      const auto offset = _mm256_load_si256(reinterpret_cast<const __m256i*>(offset_.data()));
      const __mmask8 used = static_cast<__mmask8>(
          _mm256_testn_epi32_mask(corner, _mm256_set1_epi32(static_cast<int>(~two))) &
          ((1U << n) - 1));
      const auto cell = _mm256_add_epi32(offset, _mm256_set1_epi32(static_cast<int>(first_cell)));
      const auto made = _mm256_or_si256(corner, _mm256_set1_epi32(static_cast<int>(entry)));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(cells),
                          _mm256_maskz_compress_epi32(used, cell));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(entries),
                          _mm256_maskz_compress_epi32(used, made));
      return static_cast<std::size_t>(std::popcount(static_cast<unsigned>(used)));
    }
#endif
    std::size_t at = 0;
    for (std::uint32_t c = 0; c < n; ++c) {
      cells[at] = first_cell + offset_[c];
      entries[at] = entry | c;
      at += (c & ~two) == 0 ? 1 : 0;
    }
    return at;
  }
  /// Room that write() needs behind the last entry.
  static constexpr std::size_t room = n < 8 ? 8 : n;

 private:
  alignas(32) std::array<std::uint32_t, room> corner_{}, offset_{};
};

}  // namespace tess::collide::search
