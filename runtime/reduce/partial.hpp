// A partial result of a reduction: some contributions, merged. It has a type, can be merged with
// another of its type and packed, and holds the target for the complete result.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <cstdint>
#include <memory>

namespace tess::detail {

class Pe;
class Partial;

/// Makes a partial result from bytes; one static object for each pair of value type and operation.
struct PartialKind : Registered {
  using Unpack = std::unique_ptr<Partial> (*)(Reader&);
  PartialKind(naming::Name name, Unpack unpack_) : Registered(name), unpack(unpack_) {}
  Unpack unpack;
};

class Partial {
 public:
  Partial() = default;
  Partial(const Partial&) = delete;
  Partial& operator=(const Partial&) = delete;
  virtual ~Partial() = default;

  [[nodiscard]] virtual const PartialKind& kind() const = 0;
  /// Merges another partial result of the same kind; a different kind is misuse.
  virtual void merge(Partial&& other) = 0;
  virtual void pack(Writer& ar) const = 0;
  /// It is about to be sent to another PE.
  virtual void leave() {}
  /// Sends the complete result to the target; runs on this PE.
  virtual void complete(Pe& pe) = 0;
};

/// A partial result in a message; may be absent.
struct PartialBox {
  std::unique_ptr<Partial> held;

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      held.reset();
      if (ar.template take<std::uint8_t>() != 0)
        read(ar, static_cast<const PartialKind&>(Registry::at(ar.template take<std::uint32_t>())));
    } else {
      ar(static_cast<std::uint8_t>(held ? 1 : 0));
      if (!held) return;
      ar(held->kind().id());
      pack_framed(ar, [this](Writer& value) { held->pack(value); });
    }
  }

 private:
  void read(Reader& ar, const PartialKind& kind) {
    held = unpack_framed(ar, kind.name(), kind.unpack);
  }
};

}  // namespace tess::detail
