// One call for all elements of a collection: the entry method and its arguments, shared by all
// elements of a process, packed when it crosses to another.
#pragma once

#include "runtime/ids.hpp"
#include "runtime/messages/registry.hpp"
#include "runtime/serialize.hpp"

#include <memory>

namespace tess {

class BroadcastCall;
class Element;
class Pe;
struct Action;

struct BroadcastKind : Registered {
  using Unpack = std::shared_ptr<const BroadcastCall> (*)(Reader&);
  BroadcastKind(std::string_view name, Unpack unpack_) : Registered(name), unpack(unpack_) {}
  Unpack unpack;
};

class BroadcastCall {
 public:
  BroadcastCall() = default;
  BroadcastCall(const BroadcastCall&) = delete;
  BroadcastCall& operator=(const BroadcastCall&) = delete;
  virtual ~BroadcastCall() = default;

  [[nodiscard]] virtual const BroadcastKind& kind() const = 0;
  [[nodiscard]] virtual const Action& action() const = 0;
  /// Calls the entry method; the arguments stay for the next element.
  virtual void invoke(Element& element) const = 0;
  virtual void pack(Writer& ar) const = 0;
};

/// A broadcast on its way: its number (0 before the root gave it one) and the epoch that pays for
/// it.
struct NumberedCall {
  std::uint64_t number = 0;
  EpochId epoch{};
  std::shared_ptr<const BroadcastCall> call;

  /// Its collection has ended: nobody is called. Returns whether the whole broadcast is lost.
  std::uint64_t drop(Pe& pe) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(number, epoch);
    if constexpr (Ar::is_reading) {
      call = static_cast<const BroadcastKind&>(Registry::at(ar.template take<std::uint32_t>()))
                 .unpack(ar);
    } else {
      ar(call->kind().id());
      call->pack(ar);
    }
  }
};

}  // namespace tess
