// The lists of a section: which PE delivers a multicast to which member. A section is made from a
// list of indices. Its root (a PE chosen by the section's id) sends Join to each, numbers the
// multicasts, and sends each of them once to each member:
//
//     listed     The root groups the members by the PE they were last seen on, and sends these lists
//                down a tree of these PEs (Setup). A multicast follows the tree; each PE delivers it to
//                the members on its list, and forwards it as an ordinary message to those that have
//                left.
//     not listed A member that has joined since gets ordinary messages from the root; one that has not
//                joined yet gets all multicasts once it has.
//
// So when a multicast is numbered, it is decided which PE sends it to each member, and a stale list
// costs only a hop. A member that gets an ordinary message reports its place to the root. Once the
// stale entries are a sixteenth of the members the root makes new lists: their next generation. A
// PE keeps a generation until it has delivered all its multicasts (Retire gives their number).
//
// The alternative is a condition on the broadcasts of the array. It needs no lists, but all PEs: with
// 4 members of 4096 elements on 1024 simulated PEs a multicast and a sum take 8328 messages and 31 us
// instead of 156 messages on 55 PEs and 16 us; on 16 PEs 125 and 13 us instead of 35 and 10 us.
//
// What the root knows of the members is in SectionRoster, the lists of one PE in SectionGeneration.
#pragma once

#include "runtime/arrays/sections.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/call.hpp"
#include "runtime/arrays/typed/section_generation.hpp"
#include "runtime/arrays/typed/section_messages.hpp"
#include "runtime/arrays/typed/section_roster.hpp"
#include "runtime/base/spanning_tree.hpp"

#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tess::detail {

/// Stands for the chare in messages that any array with this type of index takes.
template <class IndexType>
struct AnyChare {
  using Index = IndexType;
};

template <class Index>
class SectionListsOf final : public SectionLists {
 public:
  using Array = ArrayOf<Index>;

  explicit SectionListsOf(Array& array) : array_(array) {}

  using Create = SectionCreate<Index>;
  using Start = SectionStart;
  static void create_arrives(Array& array, Create&& m, Counted counted) {
    of(array).on_create(std::move(m), counted.epoch());
  }
  static void start_arrives(Array& array, Start&& m, Counted counted) {
    of(array).on_start(std::move(m), std::move(counted));
  }

  void send_again(Element& element, SectionId section, const SectionCall& call) override {
    send_token(section, array_.index_of(element), call);
  }
  void gone(SectionId section, std::uint32_t ordinal) override;
  void end(SectionId section) override;
  void end_all() override;
  std::vector<SectionId> save(Writer& ar) const override;
  void restore(Reader& ar) override;
  void describe_waiting(std::vector<std::string>& lines) const override;

  [[nodiscard]] static SectionListsOf& of(Array& array) {
    auto& lists = array.sections().lists();
    if (!lists) lists = std::make_unique<SectionListsOf>(array);
    return static_cast<SectionListsOf&>(*lists);
  }

 private:
  using Entry = SectionEntry<Index>;
  using Generation = SectionGeneration<Index>;
  using PeList = SectionPeList<Index>;
  using Setup = SectionSetup<Index>;
  static void setup_arrives(Array& array, Setup&& m) { of(array).on_setup(std::move(m)); }
  static void multicast_arrives(Array& array, SectionMulticast&& m, Counted counted) {
    of(array).on_multicast(std::move(m), std::move(counted));
  }
  static void retire_arrives(Array& array, SectionRetire&& m) { of(array).on_retire(m); }
  static void seen_arrives(Array& array, SectionSeen&& m) { of(array).on_seen(m); }
  static void lost_arrives(Array& array, SectionLost&& m) { of(array).on_lost(m); }

  struct JoinCall final : TypedMessage<JoinCall, AnyChare<Index>, std::tuple<SectionJoin>> {
    using Base = TypedMessage<JoinCall, AnyChare<Index>, std::tuple<SectionJoin>>;
    using Base::Base;
    static void invoke(Element& element, ElementMessage<Index>& message);
    static void undelivered(Pe& pe, ElementMessage<Index>& message);
    static bool unwanted(Collection& array, const ElementMessage<Index>& message);
    static inline const ElementAction<Index> entry{
        std::type_identity<JoinCall>{}, &JoinCall::invoke,  nullptr, Traffic::control,
        &JoinCall::undelivered,         &JoinCall::unwanted};
  };
  struct TokenCall final : TypedMessage<TokenCall, AnyChare<Index>, std::tuple<SectionToken>> {
    using Base = TypedMessage<TokenCall, AnyChare<Index>, std::tuple<SectionToken>>;
    using Base::Base;
    static void invoke(Element& element, ElementMessage<Index>& message);
    static std::int64_t priority_of(const Envelope& envelope) {
      return std::get<0>(static_cast<const TokenCall&>(envelope).arguments)
          .call.numbered.priority();
    }
    static inline const ElementAction<Index> entry{std::type_identity<TokenCall>{},
                                                   &TokenCall::invoke, nullptr, Traffic::control};
  };

  struct Root {
    SectionRoster roster;
    std::vector<Index> indices;  // of the members
    EpochId epoch{};             // waits until all indices have had their element
    std::uint64_t last_number = 0;
    std::uint64_t generation = 0;
    std::uint64_t n_calls = 0;         // of this generation
    std::vector<WaitingCall> kept;     // for members that have not joined
    std::vector<WaitingCall> waiting;  // calls that arrived before the list
  };
  struct Lists {
    Root root;  // used on the root
    std::map<std::uint64_t, Generation> generations;
  };

  [[nodiscard]] Sections& sections() { return array_.sections(); }
  /// The lists of a section; null once it has ended here.
  [[nodiscard]] Lists* lists(SectionId id) {
    return sections().part(id) == nullptr ? nullptr : &lists_[id.value];
  }

  void on_create(Create&& create, EpochId epoch);
  void on_start(Start&& start, Counted counted);
  void on_setup(Setup&& setup);
  void on_multicast(SectionMulticast&& multicast, Counted counted);
  void on_retire(const SectionRetire& retire);
  void on_seen(const SectionSeen& seen);
  void on_lost(const SectionLost& lost);

  /// A call gets its number.
  void multicast(SectionId id, Root& root, WaitingCall&& waiting);
  void make_lists(SectionId id, Root& root);
  void deliver(SectionId id, std::uint64_t number, const Generation& generation,
               const SectionCall& call);
  /// Sends a multicast to one member as an ordinary message.
  void send_token(SectionId id, const Index& index, const SectionCall& call);
  static void report_place(Array& array, SectionId id, std::uint32_t ordinal, Element& element);
  void finish(Lists& lists, std::uint64_t generation);

  Array& array_;
  std::unordered_map<std::uint64_t, Lists> lists_;
};

template <class Index>
void SectionListsOf<Index>::JoinCall::invoke(Element& element, ElementMessage<Index>& message) {
  const auto& [join] = static_cast<JoinCall&>(message).arguments;
  auto& array = static_cast<Array&>(*find_collection(current_pe(), message.collection));
  if (array.sections().join(element, join.section, join.ordinal))
    report_place(array, join.section, join.ordinal, element);
}

template <class Index>
void SectionListsOf<Index>::JoinCall::undelivered(Pe& pe, ElementMessage<Index>& message) {
  Collection* array = find_collection(pe, message.collection);
  if (array == nullptr || array->ended()) return;  // its sections ended with it
  // Where the section still lives, a result that lacks this index would be delivered.
  if (unwanted(*array, message)) return;
  const auto& [join] = static_cast<JoinCall&>(message).arguments;
  send_to_collection<&lost_arrives>(pe, message.collection,
                                    root_of(CollectionId{join.section.value}, pe.n_pes()),
                                    SectionLost{join.section, join.ordinal});
}

template <class Index>
bool SectionListsOf<Index>::JoinCall::unwanted(Collection& array,
                                               const ElementMessage<Index>& message) {
  const auto& [join] = static_cast<const JoinCall&>(message).arguments;
  return array.sections().has_ended(join.section);
}

template <class Index>
void SectionListsOf<Index>::TokenCall::invoke(Element& element, ElementMessage<Index>& message) {
  const auto& [token] = static_cast<TokenCall&>(message).arguments;
  auto& array = static_cast<Array&>(*find_collection(current_pe(), message.collection));
  const auto seat = array.sections().find(element, token.section);
  // The member may have been destroyed, and another element of the index have been created.
  if (seat.part == nullptr || !seat.member().joined) return;
  (void)of(array);  // it may be the first message of a section here
  const SectionPart::Member& member = seat.member();
  if (member.listed == 0 || member.listed != seat.part->generation)
    report_place(array, token.section, member.ordinal, element);
  const Sections::Run run(array.sections(), *seat.part, token.call);
  array.sections().deliver(seat, token.call);
}

template <class Index>
void SectionListsOf<Index>::report_place(Array& array, SectionId id, std::uint32_t ordinal,
                                         Element& element) {
  send_to_collection<&seen_arrives>(array, array.sections().root(id),
                                    SectionSeen{id, ordinal, array.place_of(element)});
}

template <class Index>
void SectionListsOf<Index>::send_token(SectionId id, const Index& index, const SectionCall& call) {
  auto* message = TokenCall::make(array_.pe(), array_.id(), index, SectionToken{id, call});
  message->epoch = call.numbered.epoch;
  message->led_by = call.led_by;
  message->demand = Demand::member;
  array_.post(message);
}

template <class Index>
void SectionListsOf<Index>::on_create(Create&& create, EpochId epoch) {
  Lists* const lists = this->lists(create.section);
  if (lists == nullptr) return;
  Root& root = lists->root;
  sections().part(create.section)->reduction.begin(create.indices.size());
  root.roster.create(create.indices.size());
  root.indices = std::move(create.indices);
  root.epoch = epoch;
  for (std::uint32_t ordinal = 0; const Index& index : root.indices) {
    auto* join =
        JoinCall::make(array_.pe(), array_.id(), index, SectionJoin{create.section, ordinal++});
    join->demand = Demand::member;
    array_.post(join);
  }
  for (WaitingCall& waiting : std::exchange(root.waiting, {}))
    multicast(create.section, root, std::move(waiting));
}

template <class Index>
void SectionListsOf<Index>::on_start(Start&& start, Counted counted) {
  Lists* const lists = this->lists(start.section);
  if (lists == nullptr) {
    array_.pe().statistics().dead_letters += start.drop(array_.pe());
  } else if (!lists->root.roster.created()) {
    lists->root.waiting.push_back({std::move(start.call), std::move(counted)});
  } else {
    multicast(start.section, lists->root, {std::move(start.call), std::move(counted)});
  }
}

template <class Index>
void SectionListsOf<Index>::multicast(SectionId id, Root& root, WaitingCall&& waiting) {
  auto& [call, counted] = waiting;
  if (root.roster.wants_lists()) make_lists(id, root);
  call.numbered.number = ++root.last_number;
  if (root.roster.n_unjoined() > 0)
    root.kept.push_back({call, Counted::sent(array_.pe().completion(), call.numbered.epoch)});
  if (root.roster.any_outside()) {
    for (std::size_t ordinal = 0; ordinal < root.indices.size(); ++ordinal) {
      if (root.roster.members()[ordinal].outside()) send_token(id, root.indices[ordinal], call);
    }
  }
  if (root.generation == 0) return;
  ++root.n_calls;
  on_multicast(SectionMulticast{id, root.generation, std::move(call)}, std::move(counted));
}

template <class Index>
void SectionListsOf<Index>::make_lists(SectionId id, Root& root) {
  if (root.generation != 0) on_retire(SectionRetire{id, root.generation, root.n_calls});
  ++root.generation;
  root.n_calls = 0;
  Setup setup{id, root.generation, {PeList{array_.pe().id(), {}}}};
  for (const auto& [pe, ordinals] : root.roster.new_lists()) {
    PeList& list =
        pe == array_.pe().id() ? setup.subtree.front() : setup.subtree.emplace_back(PeList{pe, {}});
    list.entries.reserve(ordinals.size());
    for (const std::uint32_t ordinal : ordinals)
      list.entries.push_back({ordinal, root.indices[ordinal]});
  }
  on_setup(std::move(setup));
}

template <class Index>
void SectionListsOf<Index>::on_setup(Setup&& setup) {
  Lists* const lists = this->lists(setup.section);
  if (lists == nullptr) return;
  Generation& generation = lists->generations[setup.generation];
  generation.known = true;
  generation.entries = std::move(setup.subtree.front().entries);
  const std::size_t n = setup.subtree.size() - 1;
  const auto fan_out = static_cast<std::size_t>(SpanningTree::fan_out);
  for (std::size_t child = 0; child < std::min(n, fan_out); ++child) {
    const auto begin = setup.subtree.begin() + 1;
    const auto first = begin + static_cast<std::ptrdiff_t>(child * n / std::min(n, fan_out));
    const auto last = begin + static_cast<std::ptrdiff_t>((child + 1) * n / std::min(n, fan_out));
    generation.children.push_back(first->pe);
    send_to_collection<&setup_arrives>(
        array_, first->pe,
        Setup{setup.section,
              setup.generation,
              {std::make_move_iterator(first), std::make_move_iterator(last)}});
  }
  SectionPart& part = *sections().part(setup.section);
  if (setup.generation > part.generation)
    sections().list(part, setup.generation, generation.ordinals());
  if (generation.retired)
    for (const PeId child : generation.children)
      send_to_collection<&retire_arrives>(
          array_, child, SectionRetire{setup.section, setup.generation, generation.n_calls});
  for (auto& [call, counted] : std::exchange(generation.early, {}))
    on_multicast(SectionMulticast{setup.section, setup.generation, std::move(call)},
                 std::move(counted));
  if (const auto at = lists->generations.find(setup.generation); at != lists->generations.end())
    finish(*lists, setup.generation);
}

template <class Index>
void SectionListsOf<Index>::on_multicast(SectionMulticast&& multicast, Counted counted) {
  Lists* const lists = this->lists(multicast.section);
  if (lists == nullptr) return;
  Generation& generation = lists->generations[multicast.generation];
  if (!generation.known) {
    generation.early.push_back({std::move(multicast.call), std::move(counted)});
    return;
  }
  const DeliveryScope scope(array_.pe(), counted.epoch());  // it may have waited here
  for (const PeId child : generation.children)
    send_to_collection<&multicast_arrives>(array_, child, multicast);
  if (!generation.children.empty())
    array_.pe().peers().flush();  // other processes do not wait for the local members
  deliver(multicast.section, multicast.generation, generation, multicast.call);
  ++generation.n_done;
  finish(*lists, multicast.generation);
}

template <class Index>
void SectionListsOf<Index>::deliver(SectionId id, std::uint64_t number,
                                    const Generation& generation, const SectionCall& call) {
  SectionPart& part = *sections().part(id);
  if (number == part.generation && part.n_listed == generation.entries.size()) {
    sections().deliver_listed(part, call);
    return;
  }
  std::vector<const Entry*> here;
  for (const Entry& entry : generation.entries) {
    if (part.slots.contains(entry.ordinal)) {
      here.push_back(&entry);
    } else {
      send_token(id, entry.index, call);
    }
  }
  const Sections::Run run(sections(), part, call);
  for (const Entry* entry : here) {
    if (array_.pe().stopped()) return;
    sections().deliver({&part, part.slots.at(entry->ordinal)}, call);
  }
}

template <class Index>
void SectionListsOf<Index>::on_retire(const SectionRetire& retire) {
  Lists* const lists = this->lists(retire.section);
  if (lists == nullptr) return;
  Generation& generation = lists->generations[retire.generation];
  generation.retired = true;
  generation.n_calls = retire.n_calls;
  for (const PeId child : generation.children)
    send_to_collection<&retire_arrives>(array_, child, retire);
  finish(*lists, retire.generation);
}

/// Frees a generation whose multicasts are all delivered here.
template <class Index>
void SectionListsOf<Index>::finish(Lists& lists, std::uint64_t generation) {
  const auto at = lists.generations.find(generation);
  if (at->second.finished()) lists.generations.erase(at);
}

template <class Index>
void SectionListsOf<Index>::on_seen(const SectionSeen& seen) {
  Lists* const lists = this->lists(seen.section);
  if (lists == nullptr) return;
  Root& root = lists->root;
  if (!root.roster.seen(seen.ordinal, seen.place)) return;
  const Index& index = root.indices[seen.ordinal];
  for (const WaitingCall& kept : root.kept) send_token(seen.section, index, kept.call);
  if (root.roster.n_unjoined() == 0) root.kept.clear();
}

template <class Index>
void SectionListsOf<Index>::on_lost(const SectionLost& lost) {
  Lists* const lists = this->lists(lost.section);
  if (lists == nullptr) return;
  gone(lost.section, lost.ordinal);
  sections().part(lost.section)->reduction.member_destroyed(0);
}

template <class Index>
void SectionListsOf<Index>::gone(SectionId section, std::uint32_t ordinal) {
  Root& root = lists_.at(section.value).root;
  if (!root.roster.gone(ordinal)) return;
  // Those that are kept are not sent to it.
  if (root.roster.n_unjoined() == 0) root.kept.clear();
}

template <class Index>
void SectionListsOf<Index>::end(SectionId section) {
  lists_.erase(section.value);
}

template <class Index>
void SectionListsOf<Index>::end_all() {
  lists_.clear();
}

template <class Index>
std::vector<SectionId> SectionListsOf<Index>::save(Writer& ar) const {
  std::vector<SectionId> ids;
  for (const auto& [id, of] : lists_)
    if (of.root.roster.created()) ids.push_back(SectionId{id});
  ar(static_cast<std::uint64_t>(ids.size()));
  for (const SectionId id : ids) {
    const Root& root = lists_.at(id.value).root;
    std::vector<Index> indices;
    for (std::size_t ordinal = 0; ordinal < root.indices.size(); ++ordinal)
      if (root.roster.members()[ordinal].state != SectionRoster::State::gone)
        indices.push_back(root.indices[ordinal]);
    ar(id, indices);
  }
  return ids;
}

template <class Index>
void SectionListsOf<Index>::restore(Reader& ar) {
  const DeliveryScope scope(array_.pe(), EpochId{});  // no epoch waits for the members
  for (auto n = ar.take<std::uint64_t>(); n > 0; --n) {
    const auto id = ar.take<SectionId>();
    send_to_collection<&create_arrives>(array_, sections().root(id),
                                        Create{id, ar.take<std::vector<Index>>()});
  }
}

template <class Index>
void SectionListsOf<Index>::describe_waiting(std::vector<std::string>& lines) const {
  for (const auto& [id, of] : lists_) {
    const SectionRoster& roster = of.root.roster;
    const std::size_t n_kept = of.root.kept.size();
    if (roster.n_unjoined() == 0 || (n_kept == 0 && of.root.epoch == EpochId{})) continue;
    std::size_t missing = 0;
    while (roster.members()[missing].state != SectionRoster::State::unjoined) ++missing;
    const std::string waits = text(
        " for ", array_.name(), index_text(of.root.indices[missing]),
        roster.n_unjoined() > 1 ? " and others, which do not exist" : ", which does not exist");
    if (n_kept != 0)
      lines.push_back(text(n_kept, n_kept == 1 ? " multicast" : " multicasts", " of a section of ",
                           array_.name(), n_kept == 1 ? " waits" : " wait", waits));
    if (of.root.epoch != EpochId{})
      lines.push_back(text("the epoch that create_section() of ", array_.name(), " ran in waits",
                           waits,
                           ": call it outside of the epoch, or with the elements there are"));
  }
}

// The usual types of indices are compiled once, in section_lists.cpp.
extern template class SectionListsOf<Index1>;
extern template class SectionListsOf<Index2>;
extern template class SectionListsOf<Index3>;

}  // namespace tess::detail
