// What the handles of whole collections share: arrays, groups, single chares, process groups and
// read-only data. Programs include the headers of these.
#pragma once

#include "runtime/collections/ending.hpp"
#include "runtime/core/handle.hpp"
#include "runtime/deed.hpp"

#include <compare>

namespace tess::detail {

/// What a handle of a whole collection is, its number. `Self` is the class that derives from it.
template <class Self>
class WholeHandle {
 public:
  /// It refers to no collection: it can only be assigned to.
  WholeHandle() = default;
  explicit WholeHandle(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }

  /// Ends the collection: on every PE its elements are destroyed and its memory is freed. The
  /// current epoch waits until all PEs have freed it; `co_await handle.destroy()` waits for that
  /// alone. Ending a collection again has no effect.
  auto destroy() const {
    return Deed([id = id_] { end_collection(id); });
  }
  /// `co_await handle` continues once the collection is known on every PE; it gives the handle.
  [[nodiscard]] auto operator co_await() const {
    return Known(static_cast<const Self&>(*this), id_);
  }

  [[nodiscard]] std::size_t hash() const { return std::hash<CollectionId>()(id_); }
  friend auto operator<=>(const WholeHandle&, const WholeHandle&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 protected:
  CollectionId id_{};

 private:
  class Known : public EpochBase {
   public:
    Known(const Self& handle, CollectionId id) : handle_(handle), id_(id) {}
    void await_suspend(Task::Handle task) {
      suspend_until_done(task, [](EpochBase& of) { wait_everywhere(static_cast<Known&>(of).id_); });
    }
    [[nodiscard]] Self await_resume() const {
      EpochBase::await_resume();
      return handle_;
    }

   private:
    Self handle_;
    CollectionId id_;
  };
};

}  // namespace tess::detail
