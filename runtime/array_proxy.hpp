// The proxy of a whole array: a small value that can be stored, sent, and used on every PE. It
// gives the proxies of elements, broadcasts to all of them, and ends the array. Programs include
// runtime/array.hpp.
#pragma once

#include "runtime/arrays/ending.hpp"
#include "runtime/core/handle.hpp"
#include "runtime/element_proxy.hpp"
#include "runtime/epoch.hpp"

#include <concepts>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

/// The body of an epoch that ends once the collection is known on every PE.
struct WaitEverywhere {
  CollectionId id;
  void operator()() const { wait_everywhere(id); }
};

/// What a handle of a whole collection is, its number. `Self` is the class that derives from it.
template <class Self>
class WholeHandle {
 public:
  /// It refers to no collection: it can only be assigned to.
  WholeHandle() = default;
  explicit WholeHandle(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }

  /// Ends the collection: on every PE its elements are destroyed and its memory is freed. The
  /// current epoch waits until all PEs have freed it, and so until waiting coroutines of its
  /// elements are done; `co_await handle.destroy()` waits for that alone. A coroutine of one of its
  /// own elements would wait for itself. Ending it again waits likewise, and has no other effect.
  auto destroy() const {
    return Deed([id = id_] { end_collection(id); });
  }
  /// `co_await handle` continues once the collection is known on every PE; it gives the handle.
  [[nodiscard]] auto operator co_await() const { return Known(static_cast<const Self&>(*this)); }

  [[nodiscard]] std::size_t hash() const { return std::hash<CollectionId>()(id_); }
  friend auto operator<=>(const WholeHandle&, const WholeHandle&) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 protected:
  CollectionId id_{};

 private:
  class Known : public EpochAwait<WaitEverywhere> {
   public:
    explicit Known(const Self& handle)
        : EpochAwait<WaitEverywhere>({handle.id()}), handle_(handle) {}
    [[nodiscard]] Self await_resume() const {
      EpochBase::await_resume();
      return handle_;
    }

   private:
    Self handle_;
  };
};

}  // namespace detail

/// The proxy of a whole array, or of a whole group (GroupProxy). Ending an array, by destroy():
/// messages, broadcasts, contributions and elements that are still under way to it are dropped where
/// they arrive; messages and broadcasts count as dead letters. An element with a waiting coroutine
/// gets no more messages and is destroyed once the coroutine is done.
template <class C>
class ArrayProxy : public detail::WholeHandle<ArrayProxy<C>>, public Broadcasts<ArrayProxy<C>> {
 public:
  using Receiver = C;
  template <class Self>
  using Verbs = Broadcasts<Self>;
  using detail::WholeHandle<ArrayProxy>::WholeHandle;

  /// The element of this index. (A template, so that a proxy may be a member of a class before C is
  /// complete.)
  template <class Of = C>
  [[nodiscard]] ElementProxy<Of> operator[](const typename Of::Index& index) const {
    return ElementProxy<Of>(id_, index);
  }
  /// The element x of an array of one axis: array[3] is array[{3}].
  template <std::integral X, class Of = C>
    requires std::same_as<typename Of::Index, Index1>
  [[nodiscard]] ElementProxy<Of> operator[](X x) const {
    return ElementProxy<Of>(id_, Index1{detail::axis_of(x)});
  }
  /// {1} would be (1, 0) otherwise.
  template <class Of = C>
    requires(n_axes_of<typename Of::Index> > 1)
  void operator[](std::int32_t /*x*/) const {
    static_assert(sizeof(Of) == 0, "an index has a number for each axis: array[{x, y}]");
  }
  template <class Of = C>
  void operator[](const typename detail::FewerAxes<n_axes_of<typename Of::Index>>::type&) const =
      delete;
  template <class Of = C>
  void operator[](const detail::MoreAxes<n_axes_of<typename Of::Index>>& /*list*/) const {
    static_assert(sizeof(Of) == 0, "an index has one number for each axis, and no more");
  }

  /// The member of a group on that PE.
  template <std::same_as<PeId> P, class Of = C>
  [[nodiscard]] ElementProxy<Of, Index1> operator[](P pe) const {
    static_assert(detail::OnePerPe<Of>,
                  "an array has an element for each index; groups, for each PE");
    return {id_, Index1{pe.value}};
  }
  /// The member of a group on this PE; null if the group is not known here yet or was destroyed.
  template <class Of = C>
  [[nodiscard]] Of* local_or_null() const {
    static_assert(detail::OnePerPe<Of>, "the elements of an array on this PE: local(index)");
    const detail::Collection* group = detail::find_collection(current_pe(), id_);
    return group == nullptr || group->n_local() == 0 ? nullptr
                                                     : static_cast<Of*>(group->elements().front());
  }
  /// The member of a group on this PE.
  template <class Of = C>
  [[nodiscard]] Of& local() const {
    Of* member = local_or_null();
    if (member == nullptr) [[unlikely]]
      detail::refuse_absent(id_, "this group", "");
    return *member;
  }

  /// The element of this index if it is on this PE now, otherwise null. It may leave or be
  /// destroyed once the current message is done, unless a coroutine of it waits.
  template <class Of = C>
  [[nodiscard]] Of* local(const typename Of::Index& index) const {
    return static_cast<Of*>(here().find(index));
  }

  /// The number of elements that the array was created with. On a PE that the proxy reached before
  /// the array it is not known, which ends the job: create the array inside an awaited epoch.
  [[nodiscard]] std::int64_t size() const {
    return static_cast<std::int64_t>(here().range().size());
  }
  [[nodiscard]] const Range& range() const { return here().range(); }

  friend auto operator<=>(const ArrayProxy&, const ArrayProxy&) = default;

  /// True if the array was destroyed and this PE has freed its part, or does so once the waiting
  /// coroutines of its elements are done.
  [[nodiscard]] bool ended() const { return current_pe().collections().ended(id_); }

  /// How many elements of the array were destroyed on this PE so far, and the last one in words: for
  /// libraries whose plans are about elements.
  [[nodiscard]] std::pair<std::uint64_t, std::string> destroyed_here() const {
    const detail::Collection* array = detail::find_collection(current_pe(), id_);
    if (array == nullptr || array->n_destroyed() == 0) return {};
    return {array->n_destroyed(), array->last_destroyed()};
  }

  /// The part of the array on this PE with its local elements, for libraries and tests.
  [[nodiscard]] detail::Array<C>& here() const {
    detail::Collection* collection = detail::find_collection(current_pe(), id_);
    if (collection == nullptr) [[unlikely]]
      detail::refuse_absent(id_, "the array of this proxy", ", or send its size with the proxy");
    return *static_cast<detail::Array<C>*>(collection);
  }

 private:
  friend detail::ProxyAccess;

  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<C, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    detail::start_broadcast(
        id_, detail::SharedCall(new detail::CallOfAll<C, Of, F>(
                 of, detail::as_parameters<Arguments>(std::forward<Args>(args)...))));
  }

  [[nodiscard]] std::tuple<CollectionId> fields() const { return {id_}; }
  [[nodiscard]] std::string in_words() const {
    return "all elements of " + plain_name(name_of_type<C>);
  }

  using detail::WholeHandle<ArrayProxy>::id_;
};

}  // namespace tess
