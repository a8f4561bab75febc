// One chare without an index:
//
//     const auto census = tess::create_one<Census>(args…);               // the runtime chooses the PE
//     const auto writer = tess::create_one_on<Writer>(tess::PeId{0}, path);
//     census.send<&Census::add>(3);
//
// It is an array of one element, so it may migrate, and its proxy can be sent. Each is known on
// every PE: for very many tasks use one array, whose elements are inserted or created on demand.
// After a restart it is on the PE on which it was saved. On another number of PEs the runtime
// chooses again; a PE that the program chose counts modulo their number.
#pragma once

#include "runtime/array.hpp"
#include "runtime/collections/home_of_one.hpp"

#include <memory>
#include <utility>

namespace tess {

/// The proxy of a chare that create_one() made.
template <class C>
class ChareProxy : public detail::WholeHandle<ChareProxy<C>> {
  static_assert(std::is_default_constructible_v<typename C::Index>,
                "the index of a single chare has a default constructor");

 public:
  using detail::WholeHandle<ChareProxy>::WholeHandle;

  template <auto F, class... Args>
  void send(Args&&... args) const {
    element().template send<F>(std::forward<Args>(args)...);
  }
  /// As ElementProxy::send_after().
  template <auto F, class... Args>
  Timer send_after(std::chrono::nanoseconds delay, Args&&... args) const {
    return element().template send_after<F>(delay, std::forward<Args>(args)...);
  }
  /// As ElementProxy::ask().
  template <auto F, class... Args>
  [[nodiscard]] Ask<C, F> ask(Args&&... args) const {
    return element().template ask<F>(std::forward<Args>(args)...);
  }
  /// The same chare for messages with a priority.
  [[nodiscard]] auto with(Priority priority) const { return element().with(priority); }
  /// A target for results: entry method F.
  template <auto F>
  [[nodiscard]] auto target() const {
    return element().template target<F>();
  }
  void migrate_to(PeId pe) const { element().migrate_to(pe); }
  [[nodiscard]] PeId next_pe() const { return element().next_pe(); }

  /// Ends the chare and frees it on every PE, as ArrayProxy::destroy().
  void destroy() const { detail::end_collection(id_); }

  /// The chare as the element that it is.
  [[nodiscard]] ElementProxy<C> element() const { return {id_, typename C::Index{}}; }

 private:
  using detail::WholeHandle<ChareProxy>::id_;
};

namespace detail {

template <class C>
struct CreateOne : CreateArray<C> {
  PeId given;
  template <class Ar>
  void serialize(Ar& ar) {
    CreateArray<C>::serialize(ar);
    ar(given);
  }
};
template <class C>
void create_one_arrives(Pe& pe, CreateOne<C>&& m, Counted /*counted*/) {
  make_array(pe, m, std::make_shared<HomeOfOne>(m.id, m.given, pe.n_pes()));
}

/// The array of a single chare; `given` is −1 if the runtime chooses its PE.
template <class C>
ChareProxy<C> create_for_one(PeId given) {
  check_class<C>();
  Pe& pe = current_pe();
  CreateOne<C> one{new_array<C>(pe, sparse), given};
  const ChareProxy<C> chare(one.id);
  send_to_all<&create_one_arrives<C>>(pe, std::move(one));
  return chare;
}

}  // namespace detail

/// Creates one chare on that PE. Returns immediately: messages wait for it.
template <class C, class... Args>
ChareProxy<C> create_one_on(PeId pe, Args&&... args) {
  detail::check_exists(current_pe(), pe);
  const auto chare = detail::create_for_one<C>(pe);
  chare.element().insert_on(pe, std::forward<Args>(args)...);
  return chare;
}

/// The same; the runtime chooses the PE. Many such chares are spread over all PEs.
template <class C, class... Args>
ChareProxy<C> create_one(Args&&... args) {
  const auto chare = detail::create_for_one<C>(PeId{-1});
  chare.element().insert_on(detail::root_of(chare.id(), current_pe().n_pes()),
                            std::forward<Args>(args)...);
  return chare;
}

}  // namespace tess

template <class C>
struct std::hash<tess::ChareProxy<C>> : tess::detail::HashOfHandle {};
