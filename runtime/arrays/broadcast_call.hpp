// One call for all elements of a collection: the entry method and its arguments. The elements of a
// process share it; it is packed when it is sent to another process.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/wire/messages/envelope.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <boost/smart_ptr/intrusive_ptr.hpp>
#include <boost/smart_ptr/intrusive_ref_counter.hpp>

namespace tess::detail {

class BroadcastCall;
/// Shared by the PEs of a process. The count is inside the object: this takes one block of memory
/// per call, and the thread sanitizer sees the count (that of std::shared_ptr is changed in a
/// library).
using SharedCall = boost::intrusive_ptr<const BroadcastCall>;
class TessElement;
using Element = TessElement;
class Pe;

/// Also the action of the call in reports: no message has it.
struct BroadcastKind : Action {
  using Unpack = SharedCall (*)(Reader&);
  BroadcastKind(naming::Name name, Unpack unpack_)
      : Action(name, nullptr, nullptr, nullptr, nullptr, Traffic::user), unpack_call(unpack_) {}
  Unpack unpack_call;
};

class BroadcastCall
    : public boost::intrusive_ref_counter<BroadcastCall, boost::thread_safe_counter> {
 public:
  BroadcastCall() = default;
  BroadcastCall(const BroadcastCall&) = delete;
  BroadcastCall& operator=(const BroadcastCall&) = delete;
  virtual ~BroadcastCall() = default;

  [[nodiscard]] virtual const BroadcastKind& kind() const = 0;
  [[nodiscard]] const Action& action() const { return kind(); }
  [[nodiscard]] virtual std::int64_t priority() const = 0;
  /// Calls the entry method; the arguments are kept for the next element.
  virtual void invoke(Element& element) const = 0;
  virtual void pack(Writer& ar) const = 0;
};

/// A broadcast under way: its number (0 until the root assigns it), its epoch, and the number of
/// the collection's reductions that were complete when it got its number.
struct NumberedCall {
  std::uint64_t number = 0;
  EpochId epoch{};
  SharedCall call;
  std::uint32_t n_complete = 0;
  std::uint64_t n_bytes = 0;  ///< of its arguments when packed

  [[nodiscard]] std::int64_t priority() const { return call->priority(); }
  [[nodiscard]] const Action& carried() const { return call->action(); }
  /// The collection has ended, so no element is called. Returns the number of lost broadcasts.
  [[nodiscard]] std::uint64_t drop(Pe& /*pe*/) const { return number == 0 ? 1 : 0; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(number, epoch, n_complete, n_bytes);
    if constexpr (Ar::is_reading) {
      read(ar, static_cast<const BroadcastKind&>(Registry::at(ar.template take<std::uint32_t>())));
    } else {
      ar(call->kind().id());
      pack_framed(ar, [this](Writer& arguments) { call->pack(arguments); });
    }
  }

 private:
  void read(Reader& ar, const BroadcastKind& kind) {
    call = unpack_framed(ar, kind.name(), kind.unpack_call);
  }
};

}  // namespace tess::detail
