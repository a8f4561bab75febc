// The proxy of a whole array: a small value that can be stored, sent, and used on every PE. It
// gives the proxies of elements, broadcasts to all of them, and ends the array. Programs include
// runtime/array.hpp.
#pragma once

#include "runtime/core/handle.hpp"
#include "runtime/element_proxy.hpp"
#include "runtime/future.hpp"

#include <concepts>
#include <type_traits>
#include <utility>

namespace tess {

/// The proxy of a whole array.
template <class C>
class ArrayProxy : public detail::WholeHandle<ArrayProxy<C>> {
 public:
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

  /// Calls entry method F of every element that exists when the broadcast reaches its PE.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    broadcast_as<F>(detail::OfEntry(), std::forward<Args>(args)...);
  }
  /// Broadcasts to entry method F, whose last parameter is a Callback<T>, with a new future's
  /// callback behind these arguments. Returns that Future<T>: `co_await all.reduce<&C::f>(args…)`
  /// gives the result. The target takes one value; usually each element contributes to it, in F or
  /// later. The future has the rules of every Future: it belongs to this PE and has to outlive the
  /// result, so if it is dropped before, the arrival of the result ends the job. If an array that
  /// is to contribute ends first, no result comes, and the report of the deadlock says what waits.
  template <auto F, class... Args>
  [[nodiscard]] detail::FutureOf<F> reduce(Args&&... args) const {
    return detail::reduce<F>(*this, std::forward<Args>(args)...);
  }
  /// The same array for broadcasts with a priority.
  [[nodiscard]] PrioritisedArray<C> with(Priority priority) const { return {*this, priority}; }

  /// Ends the array: on every PE its elements are destroyed and its memory is freed, including that
  /// of its balancer. Messages, broadcasts, contributions and elements that are still under way to
  /// it are dropped where they arrive; messages and broadcasts count as dead letters. An element
  /// with a waiting coroutine gets no more messages and is destroyed once the coroutine is done.
  /// The current epoch waits until all PEs have freed the array. Ending an array again has no
  /// effect.
  void destroy() const { detail::end_collection(id_); }
  /// True if the array was destroyed and this PE has freed its part, or does so once the waiting
  /// coroutines of its elements are done.
  [[nodiscard]] bool ended() const { return current_pe().ended(id_); }

  /// How many elements of the array were destroyed on this PE so far, and the last one in words: for
  /// libraries whose plans are about elements.
  [[nodiscard]] std::pair<std::uint64_t, std::string> destroyed_here() const {
    const detail::Collection* array = detail::find_collection(current_pe(), id_);
    if (array == nullptr || array->n_destroyed() == 0) return {};
    return {array->n_destroyed(), array->last_destroyed()};
  }

  /// A target for results: entry method F of all elements.
  template <auto F>
  [[nodiscard]] auto target() const {
    return detail::TargetOf<ArrayProxy, F>::make(id_);
  }

  /// The part of the array on this PE with its local elements, for libraries and tests.
  [[nodiscard]] detail::Array<C>& here() const {
    detail::Collection* collection = detail::find_collection(current_pe(), id_);
    if (collection == nullptr) [[unlikely]]
      detail::refuse_absent(id_, "the array of this proxy", ", or send its size with the proxy");
    return *static_cast<detail::Array<C>*>(collection);
  }

 private:
  friend class PrioritisedArray<C>;
  template <class, auto>
  friend struct detail::TargetOf;

  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<C, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    detail::start_broadcast(
        id_, detail::SharedCall(new detail::CallOfAll<C, Of, F>(
                 of, detail::as_parameters<Arguments>(std::forward<Args>(args)...))));
  }

  template <auto F, class... Value>
  void give(Value&&... value) const {
    broadcast<F>(std::forward<Value>(value)...);
  }
  [[nodiscard]] std::string in_words() const {
    return "all elements of " + plain_name(name_of_type<C>);
  }

  using detail::WholeHandle<ArrayProxy>::id_;
};

}  // namespace tess

template <class C>
struct std::hash<tess::ArrayProxy<C>> : tess::detail::HashOfHandle {};
