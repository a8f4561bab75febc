// The target of a result: an entry method of one element, of all elements of a collection, or of a
// group's member on a PE. It is a value that can be stored and sent; it may be called several
// times.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/core/registered_pointer.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/core/target_name.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess {

template <class T>
class Callback {
 public:
  /// Says how the target is called: one static object per pair of target kind and entry method.
  struct Kind : detail::Registered {
    using Call = void (*)(const Callback&, T&&);
    using Describe = std::string (*)(const Callback&);
    Kind(naming::Name name, Call call_, Describe describe_ = nullptr)
        : Registered(name), call(call_), describe(describe_) {}
    Call call;
    Describe describe;  ///< for error texts: "Node::result of [3]"
  };

  Callback() = default;
  /// Proxies call it; the kind's function reads `where`.
  Callback(const Kind& kind, const std::vector<std::byte>& where) : kind_(kind), where_(where) {}
  template <Bitwise... Values>
  Callback(const Kind& kind, std::in_place_t tag, const Values&... where)
      : kind_(kind), where_(tag, where...) {}

  [[nodiscard]] explicit operator bool() const { return !kind_.empty(); }
  [[nodiscard]] std::span<const std::byte> where() const { return where_.view(); }

  /// Calls the target with a value. Calling an empty Callback is misuse.
  void operator()(T value) const {
    TESS_CHECK(!kind_.empty(), "an empty Callback<", name_of_type<T>, "> is called");
    kind_->call(*this, std::move(value));
  }

  /// The target in words: "Node::result of [3]".
  [[nodiscard]] std::string name() const {
    if (kind_.empty()) return "no target";
    return kind_->describe != nullptr ? kind_->describe(*this) : plain_name(kind_->name());
  }

  friend bool operator==(const Callback&, const Callback&) = default;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(kind_, where_);
  }

 private:
  detail::RegisteredPointer<Kind> kind_;
  detail::TargetName where_;
};

/// The value of a result that is only the news that it is there.
struct NoValue {};

/// A target without a value: an entry method that takes none, or a Future<void>.
template <>
class Callback<void> {
 public:
  Callback() = default;
  explicit Callback(Callback<NoValue> target) : target_(std::move(target)) {}

  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(target_); }
  void operator()() const { target_(NoValue{}); }
  [[nodiscard]] std::string name() const { return target_.name(); }
  /// Gives the same target, which takes values that say nothing.
  [[nodiscard]] const Callback<NoValue>& of_no_value() const { return target_; }

  friend bool operator==(const Callback&, const Callback&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(target_);
  }

 private:
  Callback<NoValue> target_;
};

namespace detail {
/// T, or NoValue in place of void.
template <class T>
using ValueOrNone = std::conditional_t<std::is_void_v<T>, NoValue, T>;

/// The target of values of type T, made in place: a copy of bytes that were just written would
/// stall.
template <class T, class... Where>
[[nodiscard]] auto make_target(const typename Callback<T>::Kind& kind, const Where&... where) {
  if constexpr (std::is_same_v<T, NoValue>) {
    return Callback<void>(Callback<T>(kind, where...));
  } else {
    return Callback<T>(kind, where...);
  }
}
}  // namespace detail

}  // namespace tess
