// A registered object (registry.hpp) as a value in messages: it is sent as its number.
#pragma once

#include "runtime/core/registry.hpp"

#include <cstdint>

namespace tess::detail {

/// Of objects of one kind, which derives from Registered; may be empty.
template <class Kind>
class RegisteredPointer {
 public:
  RegisteredPointer() = default;
  explicit RegisteredPointer(const Kind& kind) : kind_(&kind) {}
  [[nodiscard]] bool empty() const { return kind_ == nullptr; }
  const Kind* operator->() const { return kind_; }

  friend bool operator==(const RegisteredPointer&, const RegisteredPointer&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      const auto id = ar.template take<std::uint32_t>();
      kind_ = id == ~0U ? nullptr : &static_cast<const Kind&>(Registry::at(id));
    } else {
      ar(kind_ == nullptr ? ~0U : kind_->id());
    }
  }

 private:
  const Kind* kind_ = nullptr;
};

}  // namespace tess::detail
