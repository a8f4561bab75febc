// Where a result goes: an entry method of one element, of all elements of a collection, or of a
// group's member on a PE. A value that can be stored and sent; it is called once or many times.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/core/serialize.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tess {

/// The bytes that name a target: an array and an index, say. Few, never changed, often copied:
/// short ones are kept in place, long ones are shared.
class TargetName {
 public:
  TargetName() = default;
  explicit TargetName(std::span<const std::byte> bytes) : n_(bytes.size()) {
    if (n_ <= short_.size()) {
      std::copy(bytes.begin(), bytes.end(), short_.begin());
    } else {
      long_ = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
    }
  }
  /// Names made of values that are their bytes; packed as a tuple of them would be. They are
  /// written where they stay: a copy of what was just written would stall.
  template <Bitwise... Values>
  explicit TargetName(std::in_place_t /*tag*/, const Values&... values)
      : n_((sizeof(Values) + ... + 0)) {
    if constexpr ((sizeof(Values) + ... + 0) <= n_short) {
      std::byte* at = short_.data();
      ((std::memcpy(at, &values, sizeof values), at += sizeof values), ...);
    } else {
      long_ = std::make_shared<const std::vector<std::byte>>(to_bytes(std::tuple(values...)));
    }
  }

  [[nodiscard]] std::span<const std::byte> view() const {
    return long_ ? std::span<const std::byte>(*long_) : std::span(short_).first(n_);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      *this = TargetName(ar.template take<std::vector<std::byte>>());
    } else {
      const auto bytes = view();
      ar(std::vector<std::byte>(bytes.begin(), bytes.end()));
    }
  }

 private:
  std::size_t n_ = 0;
  static constexpr std::size_t n_short = 24;
  std::array<std::byte, n_short> short_{};
  std::shared_ptr<const std::vector<std::byte>> long_;
};

template <class T>
class Callback {
 public:
  /// How to call: one static object for each (target kind, entry method).
  struct Kind : Registered {
    using Call = void (*)(const Callback&, T&&);
    Kind(std::string_view name, Call call_) : Registered(name), call(call_) {}
    Call call;
  };

  Callback() = default;
  /// For the proxies: `where` is what the kind's function reads.
  Callback(const Kind& kind, const std::vector<std::byte>& where) : kind_(&kind), where_(where) {}
  template <Bitwise... Values>
  Callback(const Kind& kind, std::in_place_t tag, const Values&... where)
      : kind_(&kind), where_(tag, where...) {}

  [[nodiscard]] explicit operator bool() const { return kind_ != nullptr; }
  [[nodiscard]] std::span<const std::byte> where() const { return where_.view(); }

  /// An empty one is misuse.
  void operator()(T value) const {
    TESS_CHECK(kind_ != nullptr, "an empty Callback<", name_of_type<T>, "> is called");
    kind_->call(*this, std::move(value));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      const auto id = ar.template take<std::uint32_t>();
      kind_ = id == ~0U ? nullptr : &static_cast<const Kind&>(Registry::at(id));
    } else {
      ar(kind_ == nullptr ? ~0U : kind_->id());
    }
    ar(where_);
  }

 private:
  const Kind* kind_ = nullptr;
  TargetName where_;
};

}  // namespace tess
