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
// So it is settled when a multicast is numbered which PE sends it to a member, and a stale list costs
// a hop, nothing else. A member that gets an ordinary message reports its place to the root. Once the
// stale entries are a sixteenth of the members the root makes new lists: their next generation. A PE
// keeps a generation until it has delivered all its multicasts (Retire gives their number).
#pragma once

#include "runtime/base/spanning_tree.hpp"
#include "runtime/collections/array_of.hpp"
#include "runtime/collections/call.hpp"
#include "runtime/collections/sections.hpp"
#include "runtime/core/algorithm.hpp"

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

struct JoinSection {
  SectionId section;
  std::uint32_t ordinal = 0;
};
struct SectionToken {
  SectionId section;
  SectionCall call;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, call);
  }
};

template <class Index>
class SectionListsOf final : public SectionLists {
 public:
  using Array = ArrayOf<Index>;

  explicit SectionListsOf(Array& array) : array_(array) {}

  struct Create {
    SectionId section;
    EpochId epoch;
    std::vector<Index> indices;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(section, epoch, indices);
    }
    std::uint64_t drop(Pe& pe) const {
      pe.completion().processed(epoch);
      return 0;
    }
  };
  struct Start {
    SectionId section;
    SectionCall call;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(section, call);
    }
    std::uint64_t drop(Pe& pe) const { return call.numbered.drop(pe); }
  };
  static void create_arrives(Array& array, Create&& m) { of(array).on_create(std::move(m)); }
  static void start_arrives(Array& array, Start&& m) { of(array).on_start(std::move(m)); }

  void send_again(Element& element, SectionId section, const SectionCall& call) override {
    send_token(section, array_.index_of(element), call);
  }
  void gone(SectionId section, std::uint32_t ordinal, std::uint32_t next) override;
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
  struct Entry {
    std::uint32_t ordinal = 0;
    Index index{};
    template <class Ar>
    void serialize(Ar& ar) {
      ar(ordinal, index);
    }
  };
  /// The members that a PE delivers to.
  struct PeList {
    PeId pe;
    std::vector<Entry> entries;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(pe, entries);
    }
  };
  struct Setup {
    SectionId section;
    std::uint64_t generation = 0;
    std::vector<PeList> subtree;  // the first is the receiver's
    template <class Ar>
    void serialize(Ar& ar) {
      ar(section, generation, subtree);
    }
  };
  struct Multicast {
    SectionId section;
    std::uint64_t generation = 0;
    SectionCall call;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(section, generation, call);
    }
    std::uint64_t drop(Pe& pe) const { return call.numbered.drop(pe); }
  };
  struct Retire {
    SectionId section;
    std::uint64_t generation = 0;
    std::uint64_t n_calls = 0;
  };
  /// A member was seen on a PE: it has joined there, or an ordinary message met it there.
  struct Seen {
    SectionId section;
    std::uint32_t ordinal = 0;
    Place place;
  };
  /// There is no element of this index; it was destroyed before it could join.
  struct Lost {
    SectionId section;
    std::uint32_t ordinal = 0;
  };
  static void setup_arrives(Array& array, Setup&& m) { of(array).on_setup(std::move(m)); }
  static void multicast_arrives(Array& array, Multicast&& m) {
    of(array).on_multicast(std::move(m));
  }
  static void retire_arrives(Array& array, Retire&& m) { of(array).on_retire(m); }
  static void seen_arrives(Array& array, Seen&& m) { of(array).on_seen(m); }
  static void lost_arrives(Array& array, Lost&& m) { of(array).on_lost(m); }

  struct JoinCall final : TypedMessage<JoinCall, AnyChare<Index>, std::tuple<JoinSection>> {
    using Base = TypedMessage<JoinCall, AnyChare<Index>, std::tuple<JoinSection>>;
    using Base::Base;
    static void invoke(Element& element, ElementMessage<Index>& message);
    static void undelivered(Pe& pe, ElementMessage<Index>& message);
    static inline const ElementAction<Index> entry{std::type_identity<JoinCall>{},
                                                   &JoinCall::invoke, nullptr, Traffic::control,
                                                   &JoinCall::undelivered};
  };
  struct TokenCall final : TypedMessage<TokenCall, AnyChare<Index>, std::tuple<SectionToken>> {
    using Base = TypedMessage<TokenCall, AnyChare<Index>, std::tuple<SectionToken>>;
    using Base::Base;
    static void invoke(Element& element, ElementMessage<Index>& message);
    static inline const ElementAction<Index> entry{std::type_identity<TokenCall>{},
                                                   &TokenCall::invoke, nullptr, Traffic::control};
  };

  enum class State : std::uint8_t { unjoined, joined, gone };
  struct RootMember {
    Index index{};
    Place place;
    State state = State::unjoined;
    bool listed = false;
  };
  struct Root {
    bool created = false;
    std::vector<RootMember> members;  // by ordinal
    std::size_t n_unjoined = 0, n_alive = 0;
    std::size_t n_outside = 0;  // joined and not listed
    std::size_t n_stale = 0;    // changes since the lists were made
    std::uint64_t last_number = 0;
    std::uint64_t generation = 0;
    std::uint64_t n_calls = 0;         // of this generation
    std::vector<SectionCall> kept;     // for members that have not joined
    std::vector<SectionCall> waiting;  // calls that arrived before the list
  };
  /// One generation of lists on one PE.
  struct Generation {
    bool known = false;  // Setup has arrived
    std::vector<Entry> entries;
    std::vector<PeId> children;
    std::uint64_t n_done = 0;
    bool retired = false;
    std::uint64_t n_calls = 0;       // once retired
    std::vector<SectionCall> early;  // multicasts that arrived before Setup
  };
  struct Lists {
    Root root;  // used on the root
    std::map<std::uint64_t, Generation> generations;
  };

  static constexpr std::size_t most_stale = 16;  // one of so many members

  [[nodiscard]] Sections& sections() { return array_.sections(); }
  [[nodiscard]] Completion& completion() { return array_.pe().completion(); }
  /// The lists of a section; null once it has ended here.
  [[nodiscard]] Lists* lists(SectionId id) {
    return sections().part(id) == nullptr ? nullptr : &lists_[id.value];
  }

  void on_create(Create&& create);
  void on_start(Start&& start);
  void on_setup(Setup&& setup);
  void on_multicast(Multicast&& multicast);
  void on_retire(const Retire& retire);
  void on_seen(const Seen& seen);
  void on_lost(const Lost& lost);

  void multicast(SectionId id, Root& root, SectionCall&& call);
  void make_lists(SectionId id, Root& root);
  void release_kept(Root& root);
  void deliver(SectionId id, std::uint64_t number, const Generation& generation,
               const SectionCall& call);
  /// Sends a multicast to one member as an ordinary message, which is counted as sent.
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
  const Collection* array = find_collection(pe, message.collection);
  if (array == nullptr || array->ended()) return;  // its sections ended with it
  const auto& [join] = static_cast<JoinCall&>(message).arguments;
  send_to_collection<&lost_arrives>(pe, message.collection,
                                    root_of(CollectionId{join.section.value}, pe.n_pes()),
                                    Lost{join.section, join.ordinal});
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
                                    Seen{id, ordinal, array.place_of(element)});
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
void SectionListsOf<Index>::on_create(Create&& create) {
  Lists* const lists = this->lists(create.section);
  if (lists == nullptr) {
    completion().processed(create.epoch);
    return;
  }
  Root& root = lists->root;
  root.created = true;
  root.n_unjoined = root.n_alive = create.indices.size();
  SectionPart& part = *sections().part(create.section);
  part.total.begin(create.indices.size());
  root.members.reserve(create.indices.size());
  for (std::uint32_t ordinal = 0; Index & index : create.indices) {
    completion().sent(create.epoch);
    auto* join =
        JoinCall::make(array_.pe(), array_.id(), index, JoinSection{create.section, ordinal++});
    join->epoch = create.epoch;
    join->demand = Demand::member;
    array_.post(join);
    root.members.push_back(RootMember{std::move(index), {}, State::unjoined, false});
  }
  for (SectionCall& call : std::exchange(root.waiting, {}))
    multicast(create.section, root, std::move(call));
  completion().processed(create.epoch);
  part.deliver_complete();
}

template <class Index>
void SectionListsOf<Index>::on_start(Start&& start) {
  Lists* const lists = this->lists(start.section);
  if (lists == nullptr) {
    array_.pe().statistics().dead_letters += start.drop(array_.pe());
  } else if (!lists->root.created) {
    lists->root.waiting.push_back(std::move(start.call));
  } else {
    multicast(start.section, lists->root, std::move(start.call));
  }
}

/// A call that is counted as sent gets its number.
template <class Index>
void SectionListsOf<Index>::multicast(SectionId id, Root& root, SectionCall&& call) {
  if (most_stale * root.n_stale >= root.n_alive && root.n_stale > 0) make_lists(id, root);
  call.numbered.number = ++root.last_number;
  const EpochId epoch = call.numbered.epoch;
  if (root.n_unjoined > 0) {
    for (std::size_t i = 0; i < root.n_unjoined; ++i) completion().sent(epoch);
    root.kept.push_back(call);
  }
  if (root.n_outside > 0) {
    for (const RootMember& member : root.members) {
      if (member.state != State::joined || member.listed) continue;
      completion().sent(epoch);
      send_token(id, member.index, call);
    }
  }
  if (root.generation == 0) {
    completion().processed(epoch);
    return;
  }
  ++root.n_calls;
  on_multicast(Multicast{id, root.generation, std::move(call)});
}

template <class Index>
void SectionListsOf<Index>::make_lists(SectionId id, Root& root) {
  if (root.generation != 0) on_retire(Retire{id, root.generation, root.n_calls});
  ++root.generation;
  root.n_calls = root.n_stale = root.n_outside = 0;
  std::map<PeId, std::vector<Entry>> by_pe;
  for (std::uint32_t ordinal = 0; RootMember & member : root.members) {
    member.listed = member.state == State::joined;
    if (member.listed) by_pe[member.place.pe].push_back(Entry{ordinal, member.index});
    ++ordinal;
  }
  Setup setup{id, root.generation, {}};
  const PeId here = array_.pe().id();
  setup.subtree.push_back(PeList{here, std::move(by_pe[here])});
  by_pe.erase(here);
  for (auto& [pe, entries] : by_pe) setup.subtree.push_back(PeList{pe, std::move(entries)});
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
  if (setup.generation > part.generation) {
    std::vector<std::uint32_t> ordinals;
    ordinals.reserve(generation.entries.size());
    for (const Entry& entry : generation.entries) ordinals.push_back(entry.ordinal);
    sections().list(part, setup.generation, std::move(ordinals));
  }
  if (generation.retired)
    for (const PeId child : generation.children)
      send_to_collection<&retire_arrives>(
          array_, child, Retire{setup.section, setup.generation, generation.n_calls});
  for (SectionCall& call : std::exchange(generation.early, {}))
    on_multicast(Multicast{setup.section, setup.generation, std::move(call)});
  if (const auto at = lists->generations.find(setup.generation); at != lists->generations.end())
    finish(*lists, setup.generation);
}

template <class Index>
void SectionListsOf<Index>::on_multicast(Multicast&& multicast) {
  Lists* const lists = this->lists(multicast.section);
  const EpochId epoch = multicast.call.numbered.epoch;
  if (lists == nullptr) {
    completion().processed(epoch);
    return;
  }
  Generation& generation = lists->generations[multicast.generation];
  if (!generation.known) {
    generation.early.push_back(std::move(multicast.call));
    return;
  }
  for (const PeId child : generation.children) {
    completion().sent(epoch);
    send_to_collection<&multicast_arrives>(array_, child, multicast);
  }
  if (!generation.children.empty())
    array_.pe().flush();  // other processes do not wait for the local members
  deliver(multicast.section, multicast.generation, generation, multicast.call);
  ++generation.n_done;
  finish(*lists, multicast.generation);
  completion().processed(epoch);
}

template <class Index>
void SectionListsOf<Index>::deliver(SectionId id, std::uint64_t number,
                                    const Generation& generation, const SectionCall& call) {
  SectionPart& part = *sections().part(id);
  const auto forward = [&](const Entry& entry) {
    completion().sent(call.numbered.epoch);
    send_token(id, entry.index, call);
  };
  if (number == part.generation && part.n_listed == generation.entries.size()) {
    for (const std::uint32_t ordinal : sections().deliver_listed(part, call))
      forward(
          *std::lower_bound(generation.entries.begin(), generation.entries.end(), ordinal,
                            [](const Entry& entry, std::uint32_t o) { return entry.ordinal < o; }));
    return;
  }
  std::vector<const Entry*> here;
  for (const Entry& entry : generation.entries) {
    if (part.slots.contains(entry.ordinal)) {
      here.push_back(&entry);
    } else {
      forward(entry);
    }
  }
  const Sections::Run run(sections(), part, call);
  for (const Entry* entry : here) {
    if (array_.pe().stopped()) return;
    if (const auto at = part.slots.find(entry->ordinal); at != part.slots.end()) {
      sections().deliver({&part, at->second}, call);
    } else {
      forward(*entry);  // another member's call has made it leave
    }
  }
}

template <class Index>
void SectionListsOf<Index>::on_retire(const Retire& retire) {
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
  if (at->second.known && at->second.retired && at->second.n_done == at->second.n_calls)
    lists.generations.erase(at);
}

template <class Index>
void SectionListsOf<Index>::on_seen(const Seen& seen) {
  Lists* const lists = this->lists(seen.section);
  if (lists == nullptr) return;
  Root& root = lists->root;
  RootMember& member = root.members[seen.ordinal];
  if (member.state == State::gone) return;
  if (seen.place.version > member.place.version) member.place = seen.place;
  ++root.n_stale;
  if (member.state == State::joined) return;
  member.state = State::joined;
  ++root.n_outside;
  --root.n_unjoined;
  for (const SectionCall& call : root.kept) send_token(seen.section, member.index, call);
  if (root.n_unjoined == 0) root.kept.clear();
}

/// A member that has not joined is gone: the multicasts kept for it are not sent.
template <class Index>
void SectionListsOf<Index>::release_kept(Root& root) {
  --root.n_unjoined;
  for (const SectionCall& call : root.kept) completion().processed(call.numbered.epoch);
  if (root.n_unjoined == 0) root.kept.clear();
}

template <class Index>
void SectionListsOf<Index>::on_lost(const Lost& lost) {
  Lists* const lists = this->lists(lost.section);
  if (lists == nullptr) return;
  gone(lost.section, lost.ordinal, 0);
  SectionPart& part = *sections().part(lost.section);
  part.total.remove_member(0);
  part.deliver_complete();
}

template <class Index>
void SectionListsOf<Index>::gone(SectionId section, std::uint32_t ordinal, std::uint32_t /*next*/) {
  Root& root = lists_.at(section.value).root;
  RootMember& member = root.members[ordinal];
  --root.n_alive;
  if (member.state == State::unjoined) {
    release_kept(root);  // this message has overtaken the one that it has joined
  } else if (member.listed) {
    ++root.n_stale;
  } else {
    --root.n_outside;
  }
  member.state = State::gone;
}

template <class Index>
void SectionListsOf<Index>::end(SectionId section) {
  const auto at = lists_.find(section.value);
  if (at == lists_.end()) return;
  const Root& root = at->second.root;
  for (const SectionCall& call : root.kept)
    for (std::size_t i = 0; i < root.n_unjoined; ++i) completion().processed(call.numbered.epoch);
  for (const SectionCall& call : root.waiting) completion().processed(call.numbered.epoch);
  for (const auto& [number, generation] : at->second.generations)
    for (const SectionCall& call : generation.early) completion().processed(call.numbered.epoch);
  lists_.erase(at);
}

template <class Index>
void SectionListsOf<Index>::end_all() {
  while (!lists_.empty()) end(SectionId{lists_.begin()->first});
}

template <class Index>
std::vector<SectionId> SectionListsOf<Index>::save(Writer& ar) const {
  std::vector<SectionId> ids;
  for (const auto& [id, of] : lists_)
    if (of.root.created) ids.push_back(SectionId{id});
  ar(static_cast<std::uint64_t>(ids.size()));
  for (const SectionId id : ids) {
    std::vector<Index> indices;
    for (const RootMember& member : lists_.at(id.value).root.members)
      if (member.state != State::gone) indices.push_back(member.index);
    ar(id, indices);
  }
  return ids;
}

template <class Index>
void SectionListsOf<Index>::restore(Reader& ar) {
  for (auto n = ar.take<std::uint64_t>(); n > 0; --n) {
    const auto id = ar.take<SectionId>();
    send_to_collection<&create_arrives>(array_, sections().root(id),
                                        Create{id, EpochId{}, ar.take<std::vector<Index>>()});
  }
}

template <class Index>
void SectionListsOf<Index>::describe_waiting(std::vector<std::string>& lines) const {
  for (const auto& [id, of] : lists_) {
    if (of.root.n_unjoined == 0 || of.root.kept.empty()) continue;
    const auto missing =
        std::find_if(of.root.members.begin(), of.root.members.end(),
                     [](const RootMember& one) { return one.state == State::unjoined; });
    lines.push_back(text(of.root.kept.size(), " multicasts of a section of ", array_.name(),
                         " wait for ", array_.name(), index_text(missing->index),
                         of.root.n_unjoined > 1 ? " and others" : "", ", which does not exist"));
  }
}

// The usual types of indices are compiled once, in section_lists.cpp.
extern template class SectionListsOf<Index1>;
extern template class SectionListsOf<Index2>;
extern template class SectionListsOf<Index3>;

}  // namespace tess::detail
