// Where a result goes: an entry method of one element, of all elements of a collection, or of a
// group's member on a PE. A value that can be stored and sent; it is called once or many times.
#pragma once

#include "runtime/messages/registry.hpp"
#include "runtime/serialize.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace tess {

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
  Callback(const Kind& kind, std::vector<std::byte> where)
      : kind_(&kind), where_(std::move(where)) {}

  [[nodiscard]] explicit operator bool() const { return kind_ != nullptr; }
  [[nodiscard]] const std::vector<std::byte>& where() const { return where_; }

  void operator()(T value) const { kind_->call(*this, std::move(value)); }

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
  std::vector<std::byte> where_;
};

}  // namespace tess
