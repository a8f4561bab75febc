// Several particles in one vector, one in each lane (runtime/core/simd.hpp): what the loops over
// particles add to it is gather, points and vectors, and turns. Private to dn_field.
#pragma once

#include "collide/dn_field/particles.hpp"
#include "runtime/core/simd.hpp"

namespace tess::dn::lanes {

using simd::abs, simd::any, simd::bits, simd::fma, simd::load, simd::max, simd::min, simd::only,
    simd::sqrt, simd::store;

#ifdef __AVX512F__
inline constexpr int width = 8;
#else
inline constexpr int width = 4;  // g++ takes wider vectors through memory
#endif

using D = simd::Vector<double, width>;
using F = simd::Vector<float, width>;
using I = simd::Vector<std::int32_t, width>;  // also the mask of F
using L = simd::Vector<std::int64_t, width>;  // also the mask of D

/// Calls make.operator()<V>() for the one of `Values` that equals `value`: picks a loop that is
/// compiled for it.
template <auto First, auto... Rest>
auto with(decltype(First) value, const auto& make) {
  if constexpr (sizeof...(Rest) > 0)
    if (value != First) return with<Rest...>(value, make);
  return make.template operator()<First>();
}

inline D to_double(F v) {
#ifdef __AVX512F__
  return (D)_mm512_maskz_cvtps_pd(0xFF, (__m256)v);  // g++ 12 converts in halves
#else
  return __builtin_convertvector(v, D);
#endif
}
inline F to_float(D v) {
  return __builtin_convertvector(v, F);
}
inline L widen(I mask) {
#ifdef __AVX512F__
  return (L)_mm512_maskz_cvtepi32_epi64(0xFF, (__m256i)mask);
#else
  return __builtin_convertvector(mask, L);
#endif
}

inline D all(double v) {
  return simd::all<D>(v);
}
inline F all(float v) {
  return simd::all<F>(v);
}

/// Keeps the mask as a value. Otherwise g++ 12 moves a conjunction of comparisons to its use and
/// computes it there lane by lane.
inline L settled(L mask) {
#ifdef __AVX512F__
  asm("" : "+v"(mask));
#endif
  return mask;
}

inline F floor(F v) {
  const F cut = __builtin_convertvector(__builtin_convertvector(v, I), F);
  return cut > v ? cut - 1.0F : cut;
}

inline I gather(const std::uint32_t* table, I at) {
#ifdef __AVX512F__
  return (I)_mm256_i32gather_epi32(reinterpret_cast<const int*>(table), (__m256i)at, 4);
#elif defined(__AVX2__)
  return (I)_mm_i32gather_epi32(reinterpret_cast<const int*>(table), (__m128i)at, 4);
#else
  I v;
  for (int i = 0; i < width; ++i) v[i] = load<std::int32_t>(table + at[i]);
  return v;
#endif
}
/// Reads only the lanes of the mask.
inline I gather(const std::uint32_t* table, I at, I mask) {
#ifdef __AVX512F__
  const int* from = reinterpret_cast<const int*>(table);
  return (I)_mm256_mask_i32gather_epi32((__m256i)I{}, from, (__m256i)at, (__m256i)mask, 4);
#elif defined(__AVX2__)
  const int* from = reinterpret_cast<const int*>(table);
  return (I)_mm_mask_i32gather_epi32((__m128i)I{}, from, (__m128i)at, (__m128i)mask, 4);
#else
  I v{};
  for (int i = 0; i < width; ++i)
    if (mask[i] != 0) v[i] = load<std::int32_t>(table + at[i]);
  return v;
#endif
}
inline F gather(const float* table, I at, auto... mask) {
  return (F)gather(reinterpret_cast<const std::uint32_t*>(table), at, mask...);
}
/// table[at] and table[at + 1].
template <class V>
struct Two {
  V first, second;
};
#ifdef __AVX2__
using Half = simd::Vector<std::int64_t, 4>;
inline Half gather_four(const std::uint32_t* table, __m128i at) {
  const __m256i zero = _mm256_setzero_si256(), every = _mm256_cmpeq_epi64(zero, zero);
  return (Half)_mm256_mask_i32gather_epi64(zero, reinterpret_cast<const long long*>(table), at,
                                           every, 4);
}
#endif
inline Two<I> gather_two(const std::uint32_t* table, I at) {
#ifdef __AVX512F__
  const Half low = gather_four(table, _mm256_castsi256_si128((__m256i)at)),
             high = gather_four(table, _mm256_extracti128_si256((__m256i)at, 1));
  const L both = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
#elif defined(__AVX2__)
  const L both = gather_four(table, (__m128i)at);
#else
  L both;
  for (int i = 0; i < width; ++i) both[i] = load<std::int64_t>(table + at[i]);
#endif
  return {__builtin_convertvector(both, I), __builtin_convertvector(both >> 32, I)};
}
inline Two<F> gather_two(const float* table, I at) {
  const auto [first, second] = gather_two(reinterpret_cast<const std::uint32_t*>(table), at);
  return {(F)first, (F)second};
}
/// A point or vector in each lane.
template <class V>
struct Three {
  V x, y, z;

  friend Three operator+(Three a, Three b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Three operator-(Three a, Three b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Three operator*(V s, Three a) { return {s * a.x, s * a.y, s * a.z}; }
};
using D3 = Three<D>;
using F3 = Three<F>;

inline Vec3 lane(const D3& v, int i) {
  return {v.x[i], v.y[i], v.z[i]};
}
inline Vec3 lane(const F3& v, int i) {
  return {static_cast<double>(v.x[i]), static_cast<double>(v.y[i]), static_cast<double>(v.z[i])};
}

inline F dot(F3 a, F3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline D dot(D3 a, D3 b) {
  return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));
}
inline D3 cross(D3 a, D3 b) {
  return {fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)), fma(a.x, b.y, -(a.y * b.x))};
}
/// s a + b
inline D3 fma(D s, D3 a, D3 b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
template <class M, class V>
inline Three<V> only(M mask, Three<V> v) {
  return {only(mask, v.x), only(mask, v.y), only(mask, v.z)};
}
template <class M, class V>
inline Three<V> select(M mask, Three<V> a, Three<V> b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
inline D3 to_double(F3 v) {
  return {to_double(v.x), to_double(v.y), to_double(v.z)};
}
inline F3 to_float(D3 v) {
  return {to_float(v.x), to_float(v.y), to_float(v.z)};
}
inline D3 all(Vec3 v) {
  return {all(v.x), all(v.y), all(v.z)};
}
inline D3 operator+(D3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline D3 operator-(D3 a, Vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline D3 load3(const double* x, const double* y, const double* z) {
  return {load<D>(x), load<D>(y), load<D>(z)};
}

// Particles p, p + 1, … of a span, one in each lane.
inline D3 places(const ParticleSpan& particles, std::size_t p) {
  return load3(particles.x + p, particles.y + p, particles.z + p);
}
inline D3 velocities(const ParticleSpan& particles, std::size_t p) {
  return load3(particles.vx + p, particles.vy + p, particles.vz + p);
}
inline void set_places(const ParticleSpan& particles, std::size_t p, D3 x) {
  store(particles.x + p, x.x), store(particles.y + p, x.y), store(particles.z + p, x.z);
}
inline void set_velocities(const ParticleSpan& particles, std::size_t p, D3 v) {
  store(particles.vx + p, v.x), store(particles.vy + p, v.y), store(particles.vz + p, v.z);
}

/// One Newton step takes a normal that is unit to float precision to double precision.
inline D3 refined(D3 n, D square) {
  return (1.5 - 0.5 * square) * n;
}
inline D3 refined(D3 n) {
  return refined(n, dot(n, n));
}

inline constexpr double pi = 3.14159265358979323846;

struct Turn {
  D cosine, sine;
};
/// For |angle| <= pi/2: from tan(angle/2) = p/q, a continued fraction of six terms with error
/// 3e-11. The squares of sine and cosine add up to 1 to rounding, so turns keep lengths.
inline Turn turn(D angle) {
  const D x = 0.5 * angle, xx = x * x;
  const D p = x * (10395.0 + xx * (-1260.0 + xx * 21.0));
  const D q = 10395.0 + xx * (-4725.0 + xx * (210.0 - xx));
  const D pp = p * p, qq = q * q, scale = 1.0 / (qq + pp);
  return {(qq - pp) * scale, 2.0 * p * q * scale};
}

}  // namespace tess::dn::lanes
