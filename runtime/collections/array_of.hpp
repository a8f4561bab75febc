// An array on one PE, as far as its type of index goes: which elements live here, how a message
// finds one that does not, creation on demand, insertion, migration and death. The chare's own type
// is behind four virtual functions (Array).
//
// A message that does not meet its element here goes, in this order: to the pending creation here;
// to the grave of an element whose death the home has not noted; after an element that left here;
// after a cached hint; to the home. It carries the version it has been sent after, so each hop
// follows newer knowledge than the last, and what knows more than the home waits there: no message
// runs in circles, whatever overtakes what.
#pragma once

#include "runtime/check.hpp"
#include "runtime/collections/collection_action.hpp"
#include "runtime/index.hpp"
#include "runtime/location/element_message.hpp"
#include "runtime/location/home_registry.hpp"
#include "runtime/location/location_cache.hpp"

#include <algorithm>

namespace tess {

/// An element with its index. The constructor takes the index from the birth that the PE is at.
template <class Index>
class IndexedElement : public Element {
 public:
  virtual ~IndexedElement() = default;

 protected:
  IndexedElement() : index_(*static_cast<const Index*>(birth())) {}

 private:
  template <class>
  friend class ArrayOf;
  template <class>
  friend class Array;
  template <class, class>
  friend class Chare;
  [[nodiscard]] static const void* birth() {
    const void* index = current_pe().birth();
    TESS_CHECK(index != nullptr,
               "a chare is made by its array alone: create<C>(…) or array[index].insert(…)");
    return index;
  }

  const Index index_;
};

/// What becomes of a message to an element that was destroyed.
enum class DeadLetters : std::uint8_t {
  report,    ///< it is counted, and the run's end reports how many there were
  recreate,  ///< the element is created again on its home PE
  wait,      ///< it waits at home for the next insertion
};

template <class Index>
class ArrayOf : public Collection {
 public:
  using Element_ = IndexedElement<Index>;
  using Letter = ElementMessage<Index>;

  ArrayOf(Pe& pe, CollectionId id, std::string name, const Range& range)
      : Collection(pe, id, std::move(name)), range_(range) {}

  [[nodiscard]] const Range& range() const { return range_; }
  [[nodiscard]] virtual PeId home(const Index& index) const = 0;

  [[nodiscard]] Element_* find(const Index& index) const {
    const auto at = here_.find(index);
    return at == here_.end() ? nullptr : at->second;
  }

  /// A user's message starts here.
  void post(Letter* letter) {
    if (here_.contains(letter->index)) {
      pe_.send_here(letter);
    } else {
      route(letter);
    }
  }

  /// A message arrived: it runs if its element is here.
  void arrive(Letter* letter) {
    if (Element_* element = find(letter->index); element != nullptr) [[likely]] {
      execute(*element, letter);
    } else {
      route(letter);
    }
  }

  [[nodiscard]] std::string index_text_of(const Element& element) const override {
    return index_text(static_cast<const Element_&>(element).index_);
  }

  void settle(Element& element) override {
    if (element.n_suspended_ != 0) return;
    if (element.doomed_) {
      bury(static_cast<Element_&>(element));
    } else if (element.migrate_to_.value >= 0) {
      const PeId to = element.migrate_to_;
      element.migrate_to_ = PeId{-1};
      if (to != pe_.id()) depart(static_cast<Element_&>(element), to);
    }
  }

  [[nodiscard]] std::uint64_t key_of(const Element& element) const override {
    return IndexHash<Index>()(static_cast<const Element_&>(element).index_);
  }

  void describe_waiting(std::vector<std::string>& lines) const override;

  // Messages between the parts of this array.
  struct Request {
    Index index;
    PeId from;
  };
  struct Grant {
    Index index;
    Version version;
  };
  struct Where {
    Index index;
    Place place;
  };
  struct Landed {
    Index index;
    Place place;
    PeId from;
    std::uint64_t seen;
  };
  struct Known {
    Index index;
    Version version;
    std::uint64_t seen;
  };
  struct Died {
    Index index;
    Version version;
    PeId from;
  };
  struct Buried {
    Index index;
  };
  static void request_arrives(ArrayOf& self, Request&& m) { self.on_request(m); }
  static void grant_arrives(ArrayOf& self, Grant&& m) { self.on_grant(m); }
  static void where_arrives(ArrayOf& self, Where&& m) { self.on_where(m); }
  static void hint_arrives(ArrayOf& self, Where&& m) { self.learn(m.index, m.place); }
  static void landed_arrives(ArrayOf& self, Landed&& m) { self.on_landed(m); }
  static void known_arrives(ArrayOf& self, Known&& m) { self.on_known(m); }
  static void died_arrives(ArrayOf& self, Died&& m) { self.on_died(m); }
  static void buried_arrives(ArrayOf& self, Buried&& m) { self.on_buried(m); }

 protected:
  /// Makes an element by its default constructor; misuse if it has none.
  virtual Element_* construct_default() = 0;
  virtual void destroy(Element_& element) = 0;
  /// Sends the element itself to another PE; it is no longer listed here.
  virtual void ship(Element_& element, PeId to) = 0;
  [[nodiscard]] virtual DeadLetters dead_letters() const = 0;

  /// Enters an element that is born on this PE.
  template <class Make>
  void bear(const Index& index, Version version, const Make& make) {
    Element_* element = [&] {
      const Pe::Birth birth(pe_, &index, this);
      return make();
    }();
    element->state_.version = version;
    born(*element);
    here_.emplace(index, element);
    list(*element);
    if (element->migrate_to_.value >= 0 || element->doomed_) [[unlikely]]
      settle(*element);  // its constructor asked for it
  }

  /// Takes in an element that comes from another PE.
  void land(Element_* element, PeId from);

  void destroy_all() {
    for (auto& [index, element] : here_) destroy(*element);
    for (auto& [index, pending] : pending_)
      for (Letter* letter : pending.letters) discard(letter);
    for (auto& [index, grave] : graves_)
      for (Letter* letter : grave.letters) discard(letter);
    for (auto& [index, letters] : registry_.waiting())
      for (Letter* letter : letters) discard(letter);
  }

 private:
  struct Pending {
    std::vector<Letter*> letters;
  };
  struct Grave {
    std::uint32_t n_deaths = 0;
    std::vector<Letter*> letters;
  };

  static constexpr std::uint8_t most_hops = 6;

  void execute(Element_& element, Letter* letter);
  void route(Letter* letter);
  void at_home(Letter* letter);
  void ask(Letter* letter);
  void grant(const Index& index, Version version);
  void forward(Letter* letter, const Place& place);
  void depart(Element_& element, PeId to);
  void bury(Element_& element);
  void dead_letter(Letter* letter);
  void reroute(std::vector<Letter*>&& letters) {
    for (Letter* letter : letters) arrive_later(letter);
  }
  /// To this PE's queue, where it meets the element or is routed.
  void arrive_later(Letter* letter) { pe_.send_here(letter); }
  void learn(const Index& index, const Place& place) {
    if (place.pe != pe_.id() && !here_.contains(index)) cache_.learn(index, place);
  }

  void on_request(const Request& request);
  void on_grant(const Grant& m) { grant(m.index, m.version); }
  void on_where(const Where& where);
  void on_landed(const Landed& landed);
  void on_known(const Known& known);
  void on_died(const Died& died);
  void on_buried(const Buried& buried);

  const Range range_;
  boost::unordered_flat_map<Index, Element_*, IndexHash<Index>> here_;
  boost::unordered_flat_map<Index, Pending, IndexHash<Index>> pending_;  // asked for, not answered
  boost::unordered_flat_map<Index, Grave, IndexHash<Index>>
      graves_;  // died here, not noted by the home
  boost::unordered_flat_map<Index, Place, IndexHash<Index>>
      departed_;  // left here, not noted by the home
  LocationCache<Index> cache_;
  HomeRegistry<Index> registry_;
};

template <class Index>
void ArrayOf<Index>::execute(Element_& element, Letter* letter) {
  const auto& action = static_cast<const ElementAction<Index>&>(*letter->action);
  const EpochId epoch = letter->epoch;
  if (action.invoke == nullptr) [[unlikely]] {
    TESS_CHECK(letter->demand == Demand::insert_if_absent,
               name(),
               index_text(letter->index),
               " is inserted, but it exists already on ",
               pe_.id(),
               "; insert_if_absent() allows for that");
    discard(letter);
  } else {
    const ElementScope scope(pe_, element, letter->action, epoch);
    try {
      action.invoke(element, *letter);
    } catch (...) {
      pe_.note_place();
      discard(letter);
      throw;
    }
    discard(letter);
  }
  pe_.completion().processed(epoch);
}

template <class Index>
void ArrayOf<Index>::forward(Letter* letter, const Place& place) {
  letter->tried = place.version;
  letter->ask = false;
  if (letter->source != pe_.id()) {
    ++pe_.statistics().forwards;
    if (letter->hops < 255) ++letter->hops;
    send_to_collection<&hint_arrives, Traffic::location>(
        *this, letter->source, Where{letter->index, place});
  }
  pe_.send(place.pe, letter);
}

template <class Index>
void ArrayOf<Index>::route(Letter* letter) {
  const Index& index = letter->index;
  if (pe_.birth() != nullptr) [[unlikely]] {
    // A constructor sent it: it may be to an element that is made next, or to its own.
    arrive_later(letter);
    return;
  }
  if (const auto at = pending_.find(index); at != pending_.end()) {
    at->second.letters.push_back(letter);
    return;
  }
  if (const auto at = graves_.find(index); at != graves_.end()) {
    at->second.letters.push_back(letter);
    return;
  }
  const PeId at = home(index);
  if (const auto left = departed_.find(index); left != departed_.end() &&
                                               left->second.version > letter->tried &&
                                               (letter->hops < most_hops || at == pe_.id())) {
    forward(letter, left->second);
    return;
  }
  if (at == pe_.id()) {
    at_home(letter);
    return;
  }
  if (const Place* hint = cache_.find(index);
      hint != nullptr && hint->version > letter->tried && letter->hops < most_hops) {
    forward(letter, *hint);
    return;
  }
  if (letter->ask) {
    ask(letter);
    return;
  }
  pe_.send(at, letter);
}

template <class Index>
void ArrayOf<Index>::at_home(Letter* letter) {
  const Index& index = letter->index;
  const HomeRecord* record = registry_.find(index);
  if (record != nullptr && !record->dead) {
    if (record->version > letter->tried || (record->version == letter->tried && record->landed)) {
      forward(letter, Place{record->pe, record->version});
    } else {
      registry_.wait(letter);
    }
    return;
  }
  const std::uint32_t incarnation = record == nullptr ? 0 : record->version.incarnation;
  if (letter->tried.incarnation >
      incarnation) {  // it knows a life that this home has yet to hear of
    registry_.wait(letter);
    return;
  }
  const bool revives = letter->demand == Demand::none && record != nullptr &&
                       dead_letters() == DeadLetters::recreate;
  if (letter->demand == Demand::home || revives) {
    grant(index, Version{incarnation + 1, 1});
    arrive_later(letter);
  } else if (letter->demand == Demand::none) {
    if (record == nullptr || dead_letters() == DeadLetters::wait) {
      registry_.wait(letter);
    } else {
      dead_letter(letter);
    }
  } else if (letter->asker == pe_.id()) {
    pending_[index].letters.push_back(letter);
    grant(index, Version{incarnation + 1, 1});
  } else {
    letter->ask = true;
    // Not to be misled by a hint to the life that is over.
    letter->tried = record == nullptr ? Version{} : record->version;
    pe_.send(letter->asker, letter);
  }
}

template <class Index>
void ArrayOf<Index>::dead_letter(Letter* letter) {
  const EpochId epoch = letter->epoch;
  ++pe_.statistics().dead_letters;
  discard(letter);
  pe_.completion().processed(epoch);
}

template <class Index>
void ArrayOf<Index>::ask(Letter* letter) {
  const Index index = letter->index;
  letter->ask = false;
  pending_[index].letters.push_back(letter);
  send_to_collection<&request_arrives, Traffic::location>(
      *this, home(index), Request{index, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_request(const Request& request) {
  const auto reply = [&](const Place& place) {
    send_to_collection<&where_arrives, Traffic::location>(
        *this, request.from, Where{request.index, place});
  };
  if (const Element_* element = find(request.index); element != nullptr) {
    reply(Place{pe_.id(), element->state_.version});
    return;
  }
  const HomeRecord* record = registry_.find(request.index);
  if (record != nullptr && !record->dead) {
    reply(Place{record->pe, record->version});
    return;
  }
  const Version version{record == nullptr ? 1 : record->version.incarnation + 1, 1};
  registry_.at(request.index) = HomeRecord{request.from, version, true, false};
  send_to_collection<&grant_arrives, Traffic::location>(
      *this, request.from, Grant{request.index, version});
  reroute(registry_.take_waiting(request.index));
}

/// This PE creates the element now: with the first constructor call that waits for it, or by
/// default.
template <class Index>
void ArrayOf<Index>::grant(const Index& granted, Version version) {
  const Index index = granted;
  // What waits stays in pending_ until the constructor is through: if it throws, nothing is lost.
  Letter* insert = nullptr;
  if (const auto at = pending_.find(index); at != pending_.end()) {
    for (Letter* letter : at->second.letters) {
      const bool inserts =
          letter->demand == Demand::insert || letter->demand == Demand::insert_if_absent;
      if (insert == nullptr && inserts) insert = letter;
    }
  }
  cache_.forget(index);
  departed_.erase(index);
  if (home(index) == pe_.id()) registry_.erase(index);
  if (insert == nullptr) {
    bear(index, version, [this] { return construct_default(); });
  } else {
    const EpochId before = pe_.context().epoch;
    pe_.context().epoch = insert->epoch;
    bear(index, version, [insert] {
      return static_cast<Element_*>(
          static_cast<const ElementAction<Index>&>(*insert->action).construct(*insert));
    });
    pe_.context().epoch = before;
  }
  std::vector<Letter*> letters;
  if (const auto at = pending_.find(index); at != pending_.end()) {
    letters = std::move(at->second.letters);
    pending_.erase(at);
  }
  if (insert != nullptr) {
    std::erase(letters, insert);
    const EpochId epoch = insert->epoch;
    discard(insert);
    pe_.completion().processed(epoch);
  }
  reroute(std::move(letters));
  if (home(index) == pe_.id()) reroute(registry_.take_waiting(index));
}

template <class Index>
void ArrayOf<Index>::on_where(const Where& where) {
  learn(where.index, where.place);
  const auto at = pending_.find(where.index);
  if (at == pending_.end()) return;
  std::vector<Letter*> letters = std::move(at->second.letters);
  pending_.erase(at);
  reroute(std::move(letters));
}

template <class Index>
void ArrayOf<Index>::depart(Element_& element, PeId to) {
  const Index index = element.index_;
  unlist(element);
  count_departure(element);
  here_.erase(index);
  const Version version{element.state_.version.incarnation, element.state_.version.epoch + 1};
  element.state_.version = version;
  departed_[index] = Place{to, version};
  if (home(index) == pe_.id()) registry_.at(index) = HomeRecord{to, version, false, false};
  broadcasts().left(element.state_.seen_broadcast);
  ++pe_.statistics().migrations;
  pe_.completion().sent(pe_.context().epoch);
  ship(element, to);
  reductions().advance();
}

template <class Index>
void ArrayOf<Index>::land(Element_* element, PeId from) {
  const Index index = element->index_;
  const EpochId epoch = pe_.context().epoch;
  const std::uint64_t seen = element->state_.seen_broadcast;
  const Version version = element->state_.version;
  here_.emplace(index, element);
  cache_.forget(index);
  departed_.erase(index);
  count_arrival(*element);
  list(*element);
  // It stays until it has met the broadcasts that it missed on its way: only then has it landed.
  ++element->n_suspended_;
  for (const NumberedCall& call : broadcasts().missed(seen)) {
    if (element->doomed_ || pe_.stopped()) break;
    this->call(*element, call);
    // Who asks it to move on waits for that.
    if (element->migrate_to_.value >= 0) pe_.context().epoch = call.epoch;
  }
  const Landed landed{index, Place{pe_.id(), version}, from, seen};
  if (home(index) == pe_.id()) {
    on_landed(landed);
  } else {
    send_to_collection<&landed_arrives, Traffic::location>(*this, home(index), landed);
  }
  pe_.completion().processed(epoch);
  --element->n_suspended_;
  settle(*element);
}

template <class Index>
void ArrayOf<Index>::on_landed(const Landed& landed) {
  send_to_collection<&known_arrives, Traffic::location>(
      *this, landed.from, Known{landed.index, landed.place.version, landed.seen});
  if (landed.place.pe == pe_.id()) {
    registry_.erase(landed.index);
  } else if (here_.contains(landed.index)) {
    return;  // it has come home since
  } else {
    HomeRecord& record = registry_.at(landed.index);
    const bool newer = record.dead ? landed.place.version.incarnation > record.version.incarnation
                                   : landed.place.version >= record.version;
    if (!newer) return;
    record = HomeRecord{landed.place.pe, landed.place.version, true, false};
  }
  reroute(registry_.take_waiting(landed.index));
}

template <class Index>
void ArrayOf<Index>::on_known(const Known& known) {
  if (const auto at = departed_.find(known.index);
      at != departed_.end() && at->second.version == known.version) {
    learn(known.index, at->second);
    departed_.erase(at);
  }
  broadcasts().landed(known.seen);
}

template <class Index>
void ArrayOf<Index>::bury(Element_& element) {
  const Index index = element.index_;
  const Version version = element.state_.version;
  const std::uint32_t next = element.state_.next_reduction;
  unlist(element);
  here_.erase(index);
  if (watcher() != nullptr) [[unlikely]]
    watcher()->died(element);
  destroy(element);
  reductions().died(next);
  reductions().advance();
  if (home(index) == pe_.id()) {
    registry_.at(index) = HomeRecord{pe_.id(), version, true, true};
    return;
  }
  ++graves_[index].n_deaths;
  send_to_collection<&died_arrives, Traffic::location>(
      *this, home(index), Died{index, version, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_died(const Died& died) {
  if (!here_.contains(died.index)) {
    HomeRecord& record = registry_.at(died.index);
    if (record.version.incarnation <= died.version.incarnation)
      record = HomeRecord{died.from, died.version, true, true};
  }
  send_to_collection<&buried_arrives, Traffic::location>(*this, died.from, Buried{died.index});
  reroute(registry_.take_waiting(died.index));
}

template <class Index>
void ArrayOf<Index>::on_buried(const Buried& buried) {
  const auto at = graves_.find(buried.index);
  if (--at->second.n_deaths != 0) return;
  std::vector<Letter*> letters = std::move(at->second.letters);
  graves_.erase(at);
  reroute(std::move(letters));
}

template <class Index>
void ArrayOf<Index>::describe_waiting(std::vector<std::string>& lines) const {
  Collection::describe_waiting(lines);
  const auto say = [&](const Index& index, const std::vector<Letter*>& letters, const char* what) {
    if (letters.empty()) return;
    lines.push_back(text(letters.size(),
                         letters.size() == 1 ? " message" : " messages",
                         " (",
                         plain_name(letters.front()->action->name()),
                         ") on ",
                         pe_.id(),
                         " to ",
                         name(),
                         index_text(index),
                         ", ",
                         what));
  };
  for (const auto& [index, letters] : registry_.waiting())
    say(index, letters, "which does not exist");
  for (const auto& [index, pending] : pending_)
    say(index, pending.letters, "whose creation was not answered");
  for (const auto& [index, grave] : graves_) say(index, grave.letters, "whose death was not noted");
}

}  // namespace tess
