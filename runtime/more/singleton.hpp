// One chare without an index:
//
//     const auto census = tess::create<Census>(tess::one, args…);  // the runtime chooses the PE
//     const auto writer = tess::create<Writer>(tess::one_on(tess::PeId{0}), path);
//     census.send<&Census::add>(3);
//
// It is an array of one element, so it may migrate, and its proxy can be sent. Each is known on
// every PE: for very many tasks use one array, whose elements are inserted or created on demand.
// After a restart it is on the PE on which it was saved. On another number of PEs the runtime
// chooses again; a PE that the program chose counts modulo their number.
#pragma once

#include "runtime/array.hpp"
#include "runtime/arrays/home_of_one.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace tess {

/// The proxy of a single chare.
template <class C>
class ChareProxy : public detail::WholeHandle<ChareProxy<C>>, public Sends<ChareProxy<C>> {
  static_assert(std::is_default_constructible_v<typename C::Index>,
                "the index of a single chare has a default constructor");

 public:
  using Receiver = C;
  template <class Self>
  using Verbs = Sends<Self>;
  using detail::WholeHandle<ChareProxy>::WholeHandle;

  void migrate_to(PeId pe) const { element().migrate_to(pe); }
  [[nodiscard]] PeId next_pe() const { return element().next_pe(); }

  /// The chare as the element that it is.
  [[nodiscard]] ElementProxy<C> element() const { return {id_, typename C::Index{}}; }

  friend auto operator<=>(const ChareProxy&, const ChareProxy&) = default;

 private:
  friend detail::ProxyAccess;
  using detail::WholeHandle<ChareProxy>::id_;

  template <auto F, class Of, class... Args>
  void post(detail::How<Of> how, Args&&... args) const {
    detail::ProxyAccess::post<F>(element(), how, std::forward<Args>(args)...);
  }
  template <auto F, class Of, class... Args>
  [[nodiscard]] Ask<C, F> ask_as(detail::How<Of> how, Args&&... args) const {
    return detail::ProxyAccess::ask<F>(element(), how, std::forward<Args>(args)...);
  }
  static consteval bool check_on_demand() {
    return detail::ProxyAccess::check_on_demand<ElementProxy<C>>();
  }
  [[nodiscard]] std::tuple<CollectionId> fields() const { return {id_}; }
  [[nodiscard]] std::string in_words() const { return detail::ProxyAccess::in_words(element()); }
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

/// Says where the element of create() is: on that PE, or on one that the runtime chooses; many such
/// chares are spread over all PEs.
struct One {
  std::optional<PeId> pe{};
};
inline constexpr One one{};
[[nodiscard]] constexpr One one_on(PeId pe) {
  return {pe};
}

/// Creates one chare, constructed with these arguments. Returns immediately: messages wait for it.
template <class C, class... Args>
ChareProxy<C> create(One where, Args&&... args) {
  if (where.pe) detail::check_exists(current_pe(), *where.pe);
  const auto chare = detail::create_for_one<C>(where.pe.value_or(PeId{-1}));
  chare.element().insert_on(
      where.pe ? *where.pe : detail::root_of(chare.id(), current_pe().n_pes()),
      std::forward<Args>(args)...);
  return chare;
}
template <class C, class... Args>
[[deprecated("create<C>(tess::one_on(pe), …)")]] ChareProxy<C> create_one_on(PeId pe,
                                                                             Args&&... args) {
  return create<C>(one_on(pe), std::forward<Args>(args)...);
}
template <class C, class... Args>
[[deprecated("create<C>(tess::one, …)")]] ChareProxy<C> create_one(Args&&... args) {
  return create<C>(one, std::forward<Args>(args)...);
}

}  // namespace tess
