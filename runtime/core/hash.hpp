// The project's only hash and its only generator of pseudo-random numbers. Both give the same
// values on every machine, because homes of indices and seeded schedules are computed from them.
#pragma once

#include <cstdint>
#include <cstring>

namespace tess {

/// A bijective mix of 64 bits (the finaliser of MurmurHash3 with Stafford's constants, variant 13).
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t x) noexcept {
  x ^= x >> 30U;
  x *= 0xbf58476d1ce4e5b9U;
  x ^= x >> 27U;
  x *= 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// A number in [0, 1) from the upper bits of a hash.
[[nodiscard]] constexpr double unit(std::uint64_t hash) noexcept {
  return static_cast<double>(hash >> 11U) * 0x1p-53;
}

/// A hash of raw bytes, eight at a time.
[[nodiscard]] inline std::uint64_t hash_bytes(const void* data, std::size_t n_bytes) noexcept {
  const auto* at = static_cast<const unsigned char*>(data);
  std::uint64_t hash = 0x9e3779b97f4a7c15U ^ n_bytes;
  for (; n_bytes >= 8; n_bytes -= 8, at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, 8);
    hash = (hash ^ word) * 0x9fb21c651e98df25U;
    hash ^= hash >> 32U;
  }
  std::uint64_t tail = 0;
  if (n_bytes != 0) std::memcpy(&tail, at, n_bytes);
  return mix(hash ^ tail);
}

/// A small generator (SplitMix64): its state is one word, and any seed is good.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}
  std::uint64_t operator()() noexcept { return mix(state_ += 0x9e3779b97f4a7c15U); }
  /// A number of 0 … n − 1; n must not be 0. The bias is below n / 2^64.
  std::uint64_t below(std::uint64_t n) noexcept { return (*this)() % n; }
  /// A number in [0, 1).
  double unit() noexcept { return tess::unit((*this)()); }
  bool chance(double probability) noexcept { return unit() < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace tess
