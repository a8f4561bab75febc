// Messages with a priority:
//
// Sample: tests/samples/priority.cpp
//
//     searcher.with(tess::Priority{depth}).send<&Searcher::search>(state);  // the shallowest first
//     // …
//     if (ends) searcher.with(tess::expedited).send<&Searcher::stop>();  // before all others
//
// A priority orders the messages that are ready on one PE. It travels with the message to other
// processes and to the PE to which the element has moved. It neither interrupts a running entry
// method nor orders messages that are under way. The broadcasts of an array keep their order among
// themselves: one of a late priority delays those that follow. A coroutine that continues after a
// co_await has no priority.
#pragma once

#include "runtime/ask.hpp"
#include "runtime/collections/elements/element_message.hpp"
#include "runtime/future.hpp"
#include "runtime/messages/entry_attributes.hpp"

#include <utility>

namespace tess {

template <class C>
class ArrayProxy;
template <class C, class IndexType>
class ElementProxy;

/// An element, or a group's member, and the priority of what is sent to it: element.with(priority).
template <class C, class IndexType>
class PrioritisedElement {
 public:
  PrioritisedElement(const ElementProxy<C, IndexType>& element, Priority priority)
      : element_(element), priority_(priority) {}

  // As those of ElementProxy.
  template <auto F, class... Args>
  void send(Args&&... args) const {
    element_.template send_as<F>(priority_, std::forward<Args>(args)...);
  }
  /// The call has the priority; the reply has none.
  template <auto F, class... Args>
  [[nodiscard]] auto ask(Args&&... args) const {
    return element_.template ask_as<F>(priority_, std::forward<Args>(args)...);
  }
  template <auto F, class... Args>
  void send_or_create_here(Args&&... args) const {
    element_.template send_on_demand<F>(priority_, detail::Demand::here,
                                        std::forward<Args>(args)...);
  }
  template <auto F, class... Args>
  void send_or_create_home(Args&&... args) const {
    element_.template send_on_demand<F>(priority_, detail::Demand::home,
                                        std::forward<Args>(args)...);
  }

 private:
  ElementProxy<C, IndexType> element_;
  Priority priority_;
};

/// An array, or a group, and the priority of its broadcasts: array.with(priority).
template <class C>
class PrioritisedArray {
 public:
  PrioritisedArray(const ArrayProxy<C>& array, Priority priority)
      : array_(array), priority_(priority) {}

  // As those of ArrayProxy.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    array_.template broadcast_as<F>(priority_, std::forward<Args>(args)...);
  }
  /// The calls have the priority; the result has none.
  template <auto F, class... Args>
  [[nodiscard]] detail::FutureOf<F> reduce(Args&&... args) const {
    return detail::reduce<F>(*this, std::forward<Args>(args)...);
  }

 private:
  ArrayProxy<C> array_;
  Priority priority_;
};

}  // namespace tess
