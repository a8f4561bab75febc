// The name of a callback's target. It is copied with every callback, so its rare long form is
// compiled once.
#pragma once

#include "runtime/core/serialize.hpp"

#include <boost/smart_ptr/intrusive_ptr.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <utility>

namespace tess::detail {

struct LongName;
void intrusive_ptr_add_ref(const LongName* name);
void intrusive_ptr_release(const LongName* name);

/// The bytes that name a target, such as an array and an index. They are few, constant and often
/// copied: short names are stored in place, long ones are shared.
class TargetName {
 public:
  TargetName() = default;
  explicit TargetName(std::span<const std::byte> bytes);
  /// Names made of bitwise values, packed as a tuple of them. They are written directly to their
  /// place, since a copy of bytes that were just written would stall.
  template <Bitwise... Values>
  explicit TargetName(std::in_place_t /*tag*/, const Values&... values)
      : n_((sizeof(Values) + ... + 0)) {
    if constexpr ((sizeof(Values) + ... + 0) <= n_short) {
      std::byte* at = short_.data();
      ((std::memcpy(at, &values, sizeof values), at += sizeof values), ...);
    } else {
      *this = TargetName(to_bytes(std::tuple(values...)));
    }
  }

  friend bool operator==(const TargetName& a, const TargetName& b) {
    if (a.n_ != b.n_) return false;
    if (a.long_) return equal_long(a, b);
    // In pieces as they were written: a load across two that were just written would stall.
    std::size_t at = 0;
    for (; at + 8 <= a.n_; at += 8)
      if (piece<std::uint64_t>(a, at) != piece<std::uint64_t>(b, at)) return false;
    for (; at + 4 <= a.n_; at += 4)
      if (piece<std::uint32_t>(a, at) != piece<std::uint32_t>(b, at)) return false;
    for (; at < a.n_; ++at)
      if (a.short_[at] != b.short_[at]) return false;
    return true;
  }

  [[nodiscard]] std::span<const std::byte> view() const {
    return long_ ? long_view() : std::span(short_).first(n_);
  }

  void serialize(Reader& ar);
  void serialize(Writer& ar);

 private:
  template <class Piece>
  [[nodiscard]] static Piece piece(const TargetName& of, std::size_t at) {
    Piece bytes{};
    std::memcpy(&bytes, of.short_.data() + at, sizeof bytes);
    return bytes;
  }
  [[nodiscard]] std::span<const std::byte> long_view() const;
  static bool equal_long(const TargetName& a, const TargetName& b);

  std::size_t n_ = 0;
  static constexpr std::size_t n_short = 24;
  std::array<std::byte, n_short> short_{};
  boost::intrusive_ptr<const LongName> long_;
};

}  // namespace tess::detail
