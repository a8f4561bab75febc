// Vectors of numbers, one in each lane. The types are GCC vectors, so that one source serves every
// instruction set and gives the same bits on all of them: the compiler does not fuse a
// multiplication and an addition (-ffp-contract=off), and fma() is fused everywhere. Arithmetic,
// comparisons (a mask has all bits of a lane set, or none), `mask ? a : b`, shuffles and conversions
// are those of the compiler. Intrinsics appear only where the language has no operation, or where
// g++ 12 makes more instructions of it.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace tess::simd {

/// The bytes of the processor's vectors. g++ takes wider ones through memory.
#if defined(__AVX512F__)
inline constexpr std::size_t widest = 64;
#elif defined(__AVX2__)
inline constexpr std::size_t widest = 32;
#else
inline constexpr std::size_t widest = 16;
#endif

template <class Number, std::size_t n>
using Vector [[gnu::vector_size(n * sizeof(Number))]] = Number;

template <class V>
using Lane = std::remove_cvref_t<decltype(std::declval<V&>()[0])>;
template <class V>
concept IsVector =
    !std::is_scalar_v<V> && std::is_arithmetic_v<Lane<V>> && requires(V v) { v < v; };
template <IsVector V>
inline constexpr std::size_t n_lanes = sizeof(V) / sizeof(Lane<V>);
/// Whether a vector has lanes of this type in so many bytes.
template <class V, class Number, std::size_t n_bytes>
inline constexpr bool is = std::same_as<Lane<V>, Number> && sizeof(V) == n_bytes;

template <class V, class Number>
inline V load(const Number* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V, class Number>
inline void store(Number* to, V v) {
  std::memcpy(to, &v, sizeof v);
}
/// Reads the first n lanes only; the others are zero.
template <IsVector V, std::size_t n>
inline V load_first(const Lane<V>* from) {
#ifdef __AVX512VL__
  constexpr unsigned first = (1U << n) - 1;
  if constexpr (is<V, double, 64>)
    return (V)_mm512_maskz_loadu_pd(first, from);
  else if constexpr (is<V, float, 32>)
    return (V)_mm256_maskz_loadu_ps(first, from);
  else
#endif
  {
    V v{};
    for (std::size_t i = 0; i < n; ++i) v[i] = from[i];
    return v;
  }
}

/// The number in all lanes.
template <IsVector V>
inline V all(Lane<V> number) {
  return number - V{};  // a sum would make a zero of -0
}

template <IsVector V>
inline V abs(V v) {
  using M = decltype(v < v);
  return (V)((M)v & (M{} + std::numeric_limits<Lane<M>>::max()));
}
/// The lesser and the greater one; b where a number is NaN.
template <IsVector V>
inline V min(V a, V b) {
  return a < b ? a : b;
}
template <IsVector V>
inline V max(V a, V b) {
  // g++ 12 needs two instructions for the greater of a number and zero.
#ifdef __AVX512F__
  if constexpr (is<V, double, 64>)
    return (V)_mm512_maskz_max_pd(0xFF, (__m512d)a, (__m512d)b);
  else if constexpr (is<V, float, 32>)
    return (V)_mm256_max_ps((__m256)a, (__m256)b);
  else
#endif
    return a > b ? a : b;
}
template <IsVector V>
inline V sqrt(V v) {
#ifdef __AVX512F__
  if constexpr (is<V, double, 64>)
    return (V)_mm512_maskz_sqrt_pd(0xFF, (__m512d)v);  // the plain one warns in g++ 12
  else if constexpr (is<V, float, 32>)
    return (V)_mm256_sqrt_ps((__m256)v);
  else
#endif
  {
    for (std::size_t i = 0; i < n_lanes<V>; ++i) v[i] = std::sqrt(v[i]);
    return v;
  }
}
/// a b + c, rounded once.
template <IsVector V>
inline V fma(V a, V b, V c) {
#ifdef __AVX512F__
  if constexpr (is<V, double, 64>)
    return (V)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
  else
#endif
  {
    for (std::size_t i = 0; i < n_lanes<V>; ++i) c[i] = std::fma(a[i], b[i], c[i]);
    return c;
  }
}

/// v where the mask holds, otherwise zero.
template <class M, IsVector V>
inline V only(M mask, V v) {
  return (V)(mask & (M)v);
}
template <IsVector M>
inline bool any(M mask) {
#ifdef __AVX512F__
  if constexpr (sizeof(M) == 64)
    return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
  else
#endif
#ifdef __AVX2__
      if constexpr (sizeof(M) == 32)
    return _mm256_testz_si256((__m256i)mask, (__m256i)mask) == 0;
  else if constexpr (sizeof(M) == 16)
    return _mm_testz_si128((__m128i)mask, (__m128i)mask) == 0;
  else
#endif
  {
    Lane<M> found = 0;
    for (std::size_t i = 0; i < n_lanes<M>; ++i) found |= mask[i];
    return found != 0;
  }
}

/// One bit per lane, the first lane lowest.
using Bits = std::uint32_t;

template <IsVector M>
inline Bits bits(M mask) {
#ifdef __AVX2__
  if constexpr (sizeof(M) == 32 && sizeof(Lane<M>) == 4)
    return static_cast<Bits>(_mm256_movemask_ps((__m256)mask));
  else if constexpr (sizeof(M) == 32)
    return static_cast<Bits>(_mm256_movemask_pd((__m256d)mask));
  else
#endif
#ifdef __SSE2__
      if constexpr (sizeof(M) == 16 && sizeof(Lane<M>) == 4)
    return static_cast<Bits>(_mm_movemask_ps((__m128)mask));
  else if constexpr (sizeof(M) == 16)
    return static_cast<Bits>(_mm_movemask_pd((__m128d)mask));
  else
#endif
  {
    Bits found = 0;
    for (std::size_t i = 0; i < n_lanes<M>; ++i) found |= mask[i] != 0 ? Bits{1} << i : 0;
    return found;
  }
}

// The lanes of `among` in which something holds. AVX-512 compares into bits, which g++ 12 would
// take through a mask.

/// a <= b, or a < b.
template <bool or_equal, IsVector V>
inline Bits less(Bits among, V a, V b) {
#ifdef __AVX512VL__
  constexpr int how = or_equal ? _CMP_LE_OQ : _CMP_LT_OQ;
  constexpr int how_int = or_equal ? _MM_CMPINT_LE : _MM_CMPINT_LT;
  const auto eight = static_cast<__mmask8>(among);
  if constexpr (is<V, float, 64>)
    return _mm512_mask_cmp_ps_mask(static_cast<__mmask16>(among), (__m512)a, (__m512)b, how);
  else if constexpr (is<V, double, 64>)
    return _mm512_mask_cmp_pd_mask(eight, (__m512d)a, (__m512d)b, how);
  else if constexpr (is<V, std::int32_t, 32>)
    return _mm256_mask_cmp_epi32_mask(eight, (__m256i)a, (__m256i)b, how_int);
  else
#endif
    return among & bits(or_equal ? a <= b : a < b);
}
/// a and b have no bit in common, where lanes have 32.
template <IsVector V>
inline Bits disjoint(Bits among, V a, V b) {
#ifdef __AVX512VL__
  if constexpr (sizeof(V) == 64)
    return _mm512_mask_testn_epi32_mask(static_cast<__mmask16>(among), (__m512i)a, (__m512i)b);
  else if constexpr (sizeof(V) == 32)
    return _mm256_mask_testn_epi32_mask(static_cast<__mmask8>(among), (__m256i)a, (__m256i)b);
  else
#endif
    return among & bits((a & b) == 0);
}
/// a and b differ, where lanes have 32 bits.
template <IsVector V>
inline Bits differ(Bits among, V a, V b) {
#ifdef __AVX512VL__
  if constexpr (sizeof(V) == 64)
    return _mm512_mask_cmpneq_epi32_mask(static_cast<__mmask16>(among), (__m512i)a, (__m512i)b);
  else if constexpr (sizeof(V) == 32)
    return _mm256_mask_cmpneq_epi32_mask(static_cast<__mmask8>(among), (__m256i)a, (__m256i)b);
  else
#endif
    return among & bits(a != b);
}

/// Whether compress() is one instruction.
#ifdef __AVX512VL__
inline constexpr bool has_compress = true;
#else
inline constexpr bool has_compress = false;
#endif

/// Writes the lanes of `which`, without gaps, to memory with room for all lanes, which have 32 bits.
/// Returns their end.
template <IsVector V>
inline Lane<V>* compress(Lane<V>* out, Bits which, V v) {
#ifdef __AVX512VL__
  if constexpr (sizeof(V) == 64) {
    _mm512_storeu_si512(out,
                        _mm512_maskz_compress_epi32(static_cast<__mmask16>(which), (__m512i)v));
    return out + std::popcount(which);
  } else if constexpr (sizeof(V) == 32) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                        _mm256_maskz_compress_epi32(static_cast<__mmask8>(which), (__m256i)v));
    return out + std::popcount(which);
  } else
#endif
  {
    for (; which != 0; which &= which - 1) *out++ = v[std::countr_zero(which)];
    return out;
  }
}

}  // namespace tess::simd
