// An array on one PE, as far as its type of index goes: which elements live here, how a message
// finds one that does not, creation on demand, insertion, migration and death. The chare's own type
// is behind four virtual functions (Array).
//
// A message that does not meet its element here goes, in this order: to the pending creation here;
// to the grave of an element whose death the home has not noted; after the element, if it left here
// or this PE heard where it is; to the home. It carries the version it has been sent after, so each
// hop follows newer knowledge than the last, and what knows more than the home waits there: no
// message runs in circles, whatever overtakes what.
//
// At home an index is absent, live or dead:
//     absent, dead(i)  -- grant -->     live(pe, incarnation i + 1)
//     live             -- it left -->   moving(its next PE, version + 1)
//     live, moving     -- landed -->    live(that PE and version), if newer
//     live             -- died -->      dead(incarnation)
// A grant makes the record live at once: the PE that asked keeps what reaches it until the grant
// does, so of two PEs that ask at once exactly one creates, and nothing needs to wait for a
// confirmation.
#pragma once

#include "runtime/collections/collection_action.hpp"
#include "runtime/collections/element_message.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/index.hpp"
#include "runtime/location/index_table.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <algorithm>

namespace tess {

/// An element with its index. The constructor takes the index from the birth that the PE is at.
template <class Index>
class IndexedElement : public Element {
 public:
  virtual ~IndexedElement() = default;

 protected:
  IndexedElement() : index_(*static_cast<const Index*>(constructed())) {}

  /// The collection it is an element of; also in its constructor, where it is not listed yet.
  [[nodiscard]] CollectionId collection_id() const {
    return (this->collection_ != nullptr ? this->collection_
                                         : constructing_collection(current_pe()))
        ->id();
  }

 private:
  template <class>
  friend class ArrayOf;
  template <class>
  friend class Array;
  template <class, class>
  friend class Chare;
  template <class>
  friend class Group;
  [[nodiscard]] static const void* constructed() {
    const void* index = current_pe().constructed_index();
    TESS_CHECK(index != nullptr,
               "a chare is made by its array alone: create<C>(…) or array[index].insert(…)");
    return index;
  }

  const Index index_;
};

/// Where an element is, or was.
struct Place {
  PeId pe{};
  Version version{};
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
  using Indexed = IndexedElement<Index>;
  using Letter = ElementMessage<Index>;

  ArrayOf(Pe& pe, CollectionId id, std::string name, const Range& range)
      : Collection(pe, id, std::move(name)),
        range_(range),
        block_map_(range, pe.n_pes()),
        table_(range) {}

  [[nodiscard]] const Range& range() const { return range_; }
  [[nodiscard]] const BlockMap& block_map() const { return block_map_; }
  [[nodiscard]] virtual PeId home(const Index& index) const = 0;

  [[nodiscard]] Indexed* find(const Index& index) {
    const Record* record = table_.find(index);
    return record == nullptr ? nullptr : record->element();
  }

  /// Where a message to that index goes from here, as far as this PE knows.
  [[nodiscard]] PeId next_pe(const Index& index) {
    const Record* record = table_.find(index);
    if (record == nullptr || record->state() == IndexState::unknown) return home(index);
    return record->state() == IndexState::here ? pe_.id() : record->pe();
  }

  /// A user's message starts here.
  void post(Letter* letter) {
    Record* record = table_.find(letter->index);
    if (record != nullptr && record->state() == IndexState::here) [[likely]] {
      letter->receiver = record->element();
      letter->n_departures = n_departures_;
      pe_.send_here(letter);
    } else {
      route(letter, record);
    }
  }

  /// A message arrived: it runs if its element is here.
  void arrive(Letter* letter) {
    if (letter->receiver != nullptr && letter->n_departures == n_departures_) [[likely]] {
      execute(static_cast<Indexed&>(*letter->receiver), letter);
      return;
    }
    letter->receiver = nullptr;
    Record* record = table_.find(letter->index);
    if (record != nullptr && record->state() == IndexState::here) [[likely]] {
      execute(*record->element(), letter);
    } else {
      route(letter, record);
    }
  }

  [[nodiscard]] std::string index_text_of(const Element& element) const override {
    return index_text(static_cast<const Indexed&>(element).index_);
  }

  void settle(Element& element) override {
    if (element.n_suspended_ != 0) return;
    if (element.doomed_) {
      bury(static_cast<Indexed&>(element));
    } else if (element.migrate_to_.value >= 0) {
      const PeId to = element.migrate_to_;
      element.migrate_to_ = PeId{-1};
      if (to != pe_.id()) depart(static_cast<Indexed&>(element), to);
    }
  }

  [[nodiscard]] std::uint64_t key_of(const Element& element) const override {
    return IndexHash<Index>()(static_cast<const Indexed&>(element).index_);
  }

  void describe_waiting(std::vector<std::string>& lines) const override;
  void end() override;
  [[nodiscard]] std::string constructed_text(const void* index) const override {
    return name() + index_text(*static_cast<const Index*>(index));
  }

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
  virtual Indexed* construct_default() = 0;
  virtual void destroy(Indexed& element) = 0;
  /// Sends the element itself to another PE; it is no longer listed here.
  virtual void ship(Indexed& element, PeId to) = 0;
  [[nodiscard]] virtual DeadLetters dead_letters() const = 0;

  /// Enters an element that is born on this PE.
  template <class Make>
  void bear(const Index& index, Version version, const Make& make) {
    Indexed* element = [&] {
      const Pe::Construction construction(pe_, &index, this);
      return make();
    }();
    element->state_.version = version;
    born(*element);
    table_.at(index).set_here(*element);
    list(*element);
    if (element->migrate_to_.value >= 0 || element->doomed_) [[unlikely]]
      after_construction([this, element] { settle(*element); });  // its constructor asked for it
    if (has_after_construction() && !makes_initial_) [[unlikely]]
      run_after_construction();
  }
  /// Makes the first elements, which are all born at once.
  template <class Make>
  void bear_initial(const Make& make_all) {
    makes_initial_ = true;
    make_all();
    makes_initial_ = false;
    run_after_construction();
  }

  /// Takes in an element that comes from another PE.
  void land(Indexed* element, PeId from);

  void destroy_all() {
    table_.for_each([this](const Index& /*index*/, const Record& record) {
      if (record.element() != nullptr) destroy(*record.element());
    });
    for (Letters* letters : {&pending_, &waiting_, &graves_})
      for (auto& [index, parked] : *letters)
        for (Letter* letter : parked) discard(letter);
  }

 private:
  using Record = IndexRecord<Indexed>;
  template <class Value>
  using ByIndex = boost::unordered_flat_map<Index, Value, IndexHash<Index>>;
  using Letters = ByIndex<std::vector<Letter*>>;

  static constexpr std::uint8_t most_hops = 6;
  static constexpr std::size_t most_hints = 1U << 18U;

  void execute(Indexed& element, Letter* letter);
  void route(Letter* letter, Record* record);
  void at_home(Letter* letter, const Record* record);
  [[nodiscard]] Letters& parked(Parked why) {
    return why == Parked::pending ? pending_ : why == Parked::waiting ? waiting_ : graves_;
  }
  void park(Letter* letter, Parked why);
  /// Takes out the messages that are parked; the caller routes them again.
  [[nodiscard]] std::vector<Letter*> unpark(const Index& index, Parked why);
  void ask(Letter* letter);
  void grant(const Index& index, Version version);
  void forward(Letter* letter, const Place& place);
  void depart(Indexed& element, PeId to);
  void bury(Indexed& element);
  void dead_letter(Letter* letter);
  void end_element(Indexed& element);
  void reroute(std::vector<Letter*>&& letters) {
    for (Letter* letter : letters) arrive_later(letter);
  }
  /// To this PE's queue, where it meets the element or is routed.
  void arrive_later(Letter* letter) { pe_.send_here(letter); }
  /// A hint applies only if it is newer than what is known.
  void learn(const Index& index, const Place& place);

  void on_request(const Request& request);
  void on_grant(const Grant& m) { grant(m.index, m.version); }
  void on_where(const Where& where);
  void on_landed(const Landed& landed);
  void on_known(const Known& known);
  void on_died(const Died& died);
  void on_buried(const Buried& buried);

  const Range range_;
  const BlockMap block_map_;
  bool makes_initial_ = false;
  IndexTable<Index, Indexed> table_;
  std::uint32_t n_departures_ = 0;      // elements that left or died here: no message counts on one
  std::size_t n_hints_ = 0;             // learnt since they were last forgotten
  Letters pending_, waiting_, graves_;  // what is parked, by the reason (Parked)
  ByIndex<std::uint32_t> n_deaths_;     // of the indices with a grave
};

template <class Index>
inline void ArrayOf<Index>::execute(Indexed& element, Letter* letter) {
  const auto& action = static_cast<const ElementAction<Index>&>(*letter->action);
  const EpochId epoch = letter->epoch;
  if (action.invoke == nullptr) [[unlikely]] {
    TESS_CHECK(letter->demand == Demand::insert_if_absent, name(), index_text(letter->index),
               " is inserted, but it exists already on ", pe_.id(),
               "; insert_if_absent() allows for that");
    discard(letter);
  } else {
    const ElementScope scope(pe_, element, letter->action, epoch, letter->led_by);
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

// The usual indices are compiled once, in array_of.cpp.
extern template class ArrayOf<Index1>;
extern template class ArrayOf<Index2>;
extern template class ArrayOf<Index3>;

}  // namespace tess
