// Sections: some elements of an array, by a list of their indices.
//
//     auto row = tess::create_section(blocks, {{3, 0}, {3, 1}, {3, 2}});
//     row.broadcast<&Block::step>(0);                 // a multicast: calls each member once
//     contribute(row, tess::sum, value, target);      // in a member: a reduction over the members
//
// The members are the elements that the list finds: one that is created later joins then, one that
// is destroyed leaves, and a later element of its index is no member. Multicasts reach at once the
// members that are there; a reduction, and the epoch of a multicast, wait until all indices of the
// list have had their element. Members may migrate at any time. An element may be in many sections.
#pragma once

#include "runtime/array.hpp"
#include "runtime/arrays/typed/section_lists.hpp"

#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tess {

/// The proxy of a section: a small value that can be stored, sent, and used on every PE.
template <class C>
class SectionProxy : public Broadcasts<SectionProxy<C>> {
 public:
  using Receiver = C;
  template <class Self>
  using Verbs = Broadcasts<Self>;

  /// It refers to no section: it can only be assigned to.
  SectionProxy() = default;
  SectionProxy(CollectionId array, detail::SectionId id) : array_(array), id_(id) {}

  [[nodiscard]] ArrayProxy<C> array() const { return ArrayProxy<C>(array_); }

  /// Ends the section: it frees what it holds on every PE; its members stay. What is still under
  /// way to it is dropped: multicasts and contributions. The current epoch waits until all PEs have
  /// freed it. Ending a section again has no effect.
  auto destroy() const {
    require_section("destroy() of");
    return detail::Deed([array = array_, id = id_] { detail::end_section(array, id); });
  }

  friend auto operator<=>(const SectionProxy&, const SectionProxy&) = default;
  [[nodiscard]] std::size_t hash() const { return static_cast<std::size_t>(id_.value); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(array_, id_);
  }

 private:
  template <class>
  friend class detail::TessContributor;
  friend detail::ProxyAccess;

  /// Calls each member once, also those that the list finds later. All members receive the
  /// multicasts of a section in one order.
  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<C, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    using Lists = detail::SectionListsOf<typename C::Index>;
    require_section("a broadcast to");
    Pe& pe = current_pe();
    detail::SectionCall call;
    call.numbered.epoch = pe.context().epoch;
    call.numbered.call = detail::SharedCall(new detail::CallOfAll<C, Of, F>(
        of, detail::as_parameters<Arguments>(std::forward<Args>(args)...)));
    if (pe.context().led_by != 0) call.led_by = detail::Collection::led_by(pe.context(), array_);
    detail::send_to_collection<&Lists::start_arrives>(pe, array_, root(pe), {id_, std::move(call)});
  }
  void require_section(const char* use) const {
    TESS_CHECK(array_ != CollectionId{}, use, " an empty SectionProxy<", name_of_type<C>,
               ">: assign create_section() to it first");
  }
  [[nodiscard]] PeId root(const Pe& pe) const {
    return detail::root_of(CollectionId{id_.value}, pe.n_pes());
  }

  [[nodiscard]] std::tuple<CollectionId, detail::SectionId> fields() const { return {array_, id_}; }
  [[nodiscard]] std::string in_words() const {
    return "the members of a section of " + plain_name(name_of_type<C>);
  }

  CollectionId array_{};
  detail::SectionId id_{};
};

/// Makes a section of an array, from any PE. The indices differ from each other; they need not have
/// elements yet, but an awaited epoch in which this is called ends only when all of them have had
/// theirs. Returns immediately.
template <class C>
SectionProxy<C> create_section(const ArrayProxy<C>& array, std::vector<typename C::Index> indices) {
  using Index = typename C::Index;
  using Lists = detail::SectionListsOf<Index>;
  {
    std::unordered_map<Index, bool, IndexHash<Index>> known;
    for (const Index& index : indices)
      TESS_CHECK(known.emplace(index, true).second, "the list of a section of ", name_of_type<C>,
                 " has the index ", index_text(index), " twice");
  }
  Pe& pe = current_pe();
  const detail::SectionId id{pe.collections().new_id(LateMessages::ignored).value};
  detail::send_to_collection<&Lists::create_arrives>(
      pe, array.id(), detail::root_of(CollectionId{id.value}, pe.n_pes()),
      {id, std::move(indices)});
  return SectionProxy<C>(array.id(), id);
}

/// Indices of another type do not name elements of the array.
template <class C, class Index>
  requires(!std::is_convertible_v<std::vector<Index>, std::vector<typename C::Index>>)
SectionProxy<C> create_section(const ArrayProxy<C>& array, std::vector<Index> indices) {
  static_assert(std::is_same_v<Index, typename C::Index>,
                "the indices of a section are of the array's type of index");
  return create_section(array, std::vector<typename C::Index>(indices.size()));
}

/// The section of the initial elements (ArrayProxy::range) whose index fulfils the condition.
template <class C, class Condition>
SectionProxy<C> create_section_if(const ArrayProxy<C>& array, const Condition& condition) {
  using Index = typename C::Index;
  static_assert(std::is_invocable_r_v<bool, const Condition&, const Index&>,
                "the condition of a section is a function of an index that returns bool");
  std::vector<Index> indices;
  for (std::int64_t rank = 0; rank < array.size(); ++rank) {
    const auto index = index_at<Index>(array.range(), rank);
    if (condition(index)) indices.push_back(index);
  }
  return create_section(array, std::move(indices));
}

}  // namespace tess
