// A checksum of 64 bits over bytes that come in pieces. Each step is a bijection of the state for a
// given word, and of the word for a given state: damage within one word is always seen, other
// damage but once in 2^64.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tess::dn {

class Checksum {
 public:
  /// Pieces are padded to whole words each.
  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) step(bytes.data() + at, 8);
    if (at < bytes.size()) step(bytes.data() + at, bytes.size() - at);
  }
  [[nodiscard]] std::uint64_t value() const { return state_ ^ state_ >> 29U; }

 private:
  void step(const std::byte* from, std::size_t n) {
    std::uint64_t word = 0;
    std::memcpy(&word, from, n);
    state_ = std::rotl((state_ ^ word) * 0x9e3779b97f4a7c15U, 31);
  }
  std::uint64_t state_ = 0x5445535344464c44U;
};

}  // namespace tess::dn
