// The end of a scope as the end of an array, a group, or another handle with destroy():
//
// Sample: tests/samples/scoped.cpp
//
//     const tess::Scoped blocks(tess::create<Block>(tess::range(8)));
//     blocks[{3}].send<&Block::add>(4);
//     const int sum = co_await blocks.reduce<&Block::sum>();
//
// destroy() at the end of the scope drops what is still under way to the array. So await the result
// of the work, or an epoch around it, before.
//
// One place owns the array; all others have its handle, which does not keep the array alive. A
// Scoped is a handle too: it can be given to whatever takes one.
#pragma once

#include "runtime/arrays/ending.hpp"

#include <concepts>
#include <type_traits>
#include <utility>

namespace tess {

/// A handle to something that lives on all PEs: ArrayProxy, GroupProxy, collide::Collider,
/// m2m::DistributedMesh.
template <class H>
concept DestroyableHandle = std::default_initializable<H> && std::copyable<H> &&
                            requires(const H& handle) { handle.destroy(); };

/// A handle that calls destroy() of what it refers to when its scope ends, on the PE where it does.
/// It can be moved, and neither copied nor sent: a message takes a copy of the handle, which owns
/// nothing. A member of a chare or of a group lives as long as the element; such a chare cannot
/// migrate. A Scoped that still exists when the run ends has no effect.
template <class Handle>
class [[nodiscard]] Scoped : public Handle {
  static_assert(DestroyableHandle<Handle>, "only a handle with destroy() can be scoped");

 public:
  /// Owns nothing.
  Scoped() = default;
  /// Owns what the handle refers to.
  explicit Scoped(Handle handle) : Handle(std::move(handle)), owns_(true) {}
  /// Afterwards `other` refers to the same thing, and owns nothing.
  Scoped(Scoped&& other) noexcept
      : Handle(other.handle()), owns_(std::exchange(other.owns_, false)) {}
  /// Destroys what was owned before.
  Scoped& operator=(Scoped&& other) noexcept {
    Scoped taken(std::move(other));
    std::swap(static_cast<Handle&>(*this), static_cast<Handle&>(taken));
    std::swap(owns_, taken.owns_);
    return *this;
  }
  Scoped(const Scoped&) = delete;
  Scoped& operator=(const Scoped&) = delete;
  ~Scoped() { destroy(); }

  /// Destroys what is owned before the end of the scope, in the current epoch.
  void destroy() noexcept {
    if (std::exchange(owns_, false) && detail::in_running_program()) Handle::destroy();
  }
  /// Gives up ownership.
  Handle release() {
    owns_ = false;
    return handle();
  }
  [[nodiscard]] const Handle& handle() const { return *this; }
  [[nodiscard]] bool owns() const { return owns_; }

  template <class Ar>
  void serialize(Ar& /*ar*/) {
    static_assert(
        !std::is_class_v<Ar>,
        "a Scoped cannot be sent, since the copy would own the same thing; send handle()");
  }

 private:
  bool owns_ = false;
};

}  // namespace tess
