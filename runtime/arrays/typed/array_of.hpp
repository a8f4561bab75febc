// An array on one PE, as far as it depends on the type of index: the local elements, the routing of
// messages to other elements, creation on demand, insertion, migration and destruction. Array adds
// the type of the chare by four virtual functions.
//
// A message whose element is not here goes to the first of these that applies: the pending creation
// here; the messages that wait until the home confirms a destruction here; the PE that the element
// left for or was last heard of; the home. The message carries the version it was last sent after,
// so each hop follows newer knowledge than the last one. A message with newer knowledge than the
// home's waits at the home. So no message runs in circles, whatever the order of delivery.
//
// At home an index is absent, live or destroyed:
//     absent, destroyed(i)  -- grant -->      live(pe, incarnation i + 1)
//     live                  -- it left -->    moving(its next PE, version + 1)
//     live, moving          -- arrived -->    live(that PE and version), if newer
//     live                  -- destroyed -->  destroyed(incarnation)
// A grant makes the record live at once. The PE that asked keeps messages that reach it until the
// grant arrives. So of two PEs that ask at once exactly one creates the element, and no
// confirmation is needed.
#pragma once

#include "runtime/arrays/collection_action.hpp"
#include "runtime/arrays/elements/element_message.hpp"
#include "runtime/arrays/location/index_table.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/index.hpp"
#include "runtime/pe/block.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tess::detail {

/// An element with its index. The constructor takes the index from the PE's current construction.
template <class Index>
class TessIndexedElement : public Element {
 public:
  virtual ~TessIndexedElement() = default;

 protected:
  TessIndexedElement() : index_(*static_cast<const Index*>(constructed())) {}

  /// The collection of this element; also valid in its constructor, where it is not listed yet.
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
  template <class>
  friend class TessContributor;
  template <class, class>
  friend class tess::Chare;
  template <class>
  friend class tess::Group;
  [[nodiscard]] static const void* constructed() {
    const void* index = current_pe().nesting().constructed_index();
    TESS_CHECK(index != nullptr,
               "only its array makes a chare: use create<C>(…) or array[index].insert(…)");
    return index;
  }

  const Index index_;
};

/// The present or a former place of an element.
struct Place {
  PeId pe{};
  Version version{};
};

/// What happens to a message to an element that was destroyed.
enum class DeadLetters : std::uint8_t {
  report,    ///< it is dropped as a dead letter; the end of the run reports their number
  recreate,  ///< the element is created again on its home PE
  wait,      ///< it waits at home for the next insertion
};

template <class Index>
struct Arrival;
struct ArrivalAction;

template <class Index>
class ArrayOf : public Collection {
 public:
  using Indexed = TessIndexedElement<Index>;
  using CallMessage = ElementMessage<Index>;

  ArrayOf(Pe& pe, CollectionId id, std::string name, const Range& range);
  ArrayOf(const ArrayOf&) = delete;
  ArrayOf& operator=(const ArrayOf&) = delete;
  ~ArrayOf() override;

  [[nodiscard]] const BlockMap& block_map() const { return block_map_; }
  [[nodiscard]] virtual PeId home(const Index& index) const = 0;

  [[nodiscard]] Indexed* find(const Index& index) {
    const Record* record = table_.find(index);
    return record == nullptr ? nullptr : record->element();
  }

  [[nodiscard]] const Index& index_of(const Element& element) const {
    return static_cast<const Indexed&>(element).index_;
  }
  /// The place of an element that is here.
  [[nodiscard]] Place place_of(const Element& element) const {
    return Place{pe_.id(), element.state_.version};
  }

  /// The PE to which a message for this index is sent, as far as this PE knows.
  [[nodiscard]] PeId next_pe(const Index& index) {
    const Record* record = table_.find(index);
    if (record == nullptr || record->state() == IndexState::unknown) return home(index);
    return record->state() == IndexState::here ? pe_.id() : record->pe();
  }

  /// A new message is sent from here. Its epoch waits for it.
  void post(CallMessage* message) {
    Counted::departs(pe_.completion(), message->epoch);
    post_counted(message);
  }
  /// Sends a new message that is counted already.
  void post_counted(CallMessage* message) {
    Record* record = table_.find(message->index);
    if (record != nullptr && record->state() == IndexState::here) [[likely]] {
      message->receiver = record->element();
      message->n_departures = n_departures_;
      pe_.send_here(message);
    } else {
      route(message, record);
    }
  }

  /// A message has arrived; it runs if its element is here.
  void arrive(CallMessage* message) {
    if (message->receiver == nullptr || message->n_departures != n_departures_) {
      message->receiver = nullptr;
      Record* record = table_.find(message->index);
      if (record == nullptr || record->state() != IndexState::here) [[unlikely]]
        return route(message, record);
      message->receiver = record->element();
    }
    execute(static_cast<Indexed&>(*message->receiver), message);
  }

  /// Runs a message to an element of an array with this type of index (Action::run). It waits if
  /// the array is not known here yet.
  static void run_message(Pe& pe, Envelope* envelope);
  /// Ends such a message whose array has ended. Returns the number of dead letters, 0 or 1.
  static std::uint64_t drop_message(Pe& pe, Envelope& envelope);

  /// The element of this index if it may be called now, inside another entry method; otherwise
  /// null.
  [[nodiscard]] Indexed* free_to_run(const Index& index) {
    if (!pe_.may_nest()) return nullptr;
    Indexed* element = find(index);
    return element != nullptr && element->n_suspended_ == 0 ? element : nullptr;
  }
  /// Calls that element as a part of the running message, which its epochs wait for. An exception
  /// ends the job once the caller is done.
  template <class Invoke>
  void run_now(Indexed& element, const Action& action, const Invoke& invoke) {
    const Nesting::Call nested(pe_.nesting());
    const Action* const outer = pe_.running();
    const std::uint32_t led_by = Collection::led_by(pe_.context(), id());
    pe_.begins(&action);
    {
      const ElementScope scope(pe_, element, &action, pe_.context().epoch, led_by);
      try {
        invoke();
      } catch (...) {
        pe_.error().keep(std::current_exception());
      }
    }
    pe_.begins(outer);
  }

  [[nodiscard]] std::string index_text_of(const Element& element) const override {
    return index_text(static_cast<const Indexed&>(element).index_);
  }

  void settle(Element& element) override {
    if (element.n_suspended_ != 0) return;
    if (!element.destroy_requested_ && element.migrate_to_.value < 0) return;
    // The caller may have it as an object (local()), and its destructor may send messages.
    if (pe_.nesting().nests()) return settle_later(element);
    const Nesting::Call none(pe_.nesting(), Nesting::most_calls);
    if (element.destroy_requested_) {
      destroy_here(static_cast<Indexed&>(element));
    } else {
      const PeId to = element.migrate_to_;
      element.migrate_to_ = PeId{-1};
      if (to != pe_.id()) depart(static_cast<Indexed&>(element), to);
    }
  }

  [[nodiscard]] std::uint64_t key_of(const Element& element) const override {
    return IndexHash<Index>()(static_cast<const Indexed&>(element).index_);
  }

  [[nodiscard]] std::int64_t rank_of(const Element& element) const override {
    if (&Collection::of(element) != this) return -1;
    if constexpr (Coordinates<Index>)
      if (range().n_axes != 0) return rank_in(range(), index_of(element));
    return static_cast<std::int64_t>(key_of(element) >> 1U);
  }

  void restore_sections(Reader& ar) override;
  void drop_unwanted() override;
  void describe_waiting(std::vector<std::string>& lines) const override;
  void end() override;
  [[nodiscard]] std::uint64_t packed_bytes(Element& element) const override;
  /// An element arrives from another PE.
  void take_in(Arrival<Index>& arrival);
  /// An element that arrives after the end of its array is destroyed, and no epoch waits for it.
  static std::uint64_t drop_arrival(Pe& pe, Envelope& envelope);
  [[nodiscard]] std::string last_destroyed() const override {
    return constructed_text(&last_destroyed_);
  }
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
  struct LocationUpdate {
    Index index;
    Place place;
  };
  struct MoveReport {
    Index index;
    Place place;
    PeId from;
    std::uint64_t seen;
  };
  struct MoveNoted {
    Index index;
    Version version;
    std::uint64_t seen;
  };
  struct DestroyReport {
    Index index;
    Version version;
    PeId from;
  };
  struct DestroyNoted {
    Index index;
  };
  static void request_arrives(ArrayOf& self, Request&& m) { self.on_request(m); }
  static void grant_arrives(ArrayOf& self, Grant&& m) { self.on_grant(m); }
  static void location_update_arrives(ArrayOf& self, LocationUpdate&& m) {
    self.on_location_update(m);
  }
  static void hint_arrives(ArrayOf& self, LocationUpdate&& m) { self.learn(m.index, m.place); }
  static void move_report_arrives(ArrayOf& self, MoveReport&& m) { self.on_move_report(m); }
  static void move_noted_arrives(ArrayOf& self, MoveNoted&& m) { self.on_move_noted(m); }
  static void destroy_report_arrives(ArrayOf& self, DestroyReport&& m) {
    self.on_destroy_report(m);
  }
  static void destroy_noted_arrives(ArrayOf& self, DestroyNoted&& m) { self.on_destroy_noted(m); }

 protected:
  /// Constructs an element by its default constructor; misuse if it has none.
  virtual Indexed* construct_default() = 0;
  virtual void destroy(Indexed& element) = 0;
  /// The action of its migrating elements; null if the class cannot migrate.
  [[nodiscard]] virtual const ArrivalAction* arrival_action() const = 0;
#ifdef TESS_CHECKS_ALL
  /// Describes how the element differs from the members that were sent; empty if it does not.
  [[nodiscard]] virtual std::string difference_from(std::span<const std::byte> sent,
                                                    Indexed& element) const = 0;
#endif
  /// Constructs an element that is to be read from bytes.
  Indexed* construct_again(const Index& index);
  [[nodiscard]] virtual DeadLetters dead_letters() const = 0;

  /// Constructs an element on this PE.
  template <class Make>
  void construct(const Index& index, Version version, const Make& make, std::uint32_t joins = 0) {
    Indexed* element = [&] {
      const Nesting::Construction construction(pe_.nesting(), &index, this);
      return make();
    }();
    add_constructed(*element, index, version, joins);
  }
  /// Constructs the initial elements, which all count as created at once.
  template <class Make>
  void construct_initial(const Make& make_all) {
    makes_initial_ = true;
    make_all();
    makes_initial_ = false;
    run_after_construction();
  }

  void destroy_all();
  /// Adds an element that was read from a checkpoint.
  void add_restored(Indexed& element, std::uint32_t incarnation);
  void restore_destroyed(const Index& index, std::uint32_t incarnation);
  std::uint64_t save_destroyed(Writer& ar) const override;

 private:
  using Record = IndexRecord<Indexed>;
  template <class Value>
  using ByIndex = std::unordered_map<Index, Value, IndexHash<Index>, std::equal_to<>,
                                     PoolAllocator<std::pair<const Index, Value>>>;
  using Messages = ByIndex<std::vector<CallMessage*>>;

  static constexpr std::uint8_t most_hops = 6;
  static constexpr std::size_t most_hints = 1U << 18U;

  /// Adds an element that arrived from another PE.
  void add_arrived(Indexed* element, PeId from, Memberships&& memberships);
  void add_constructed(Indexed& element, const Index& index, Version version, std::uint32_t joins);
  void execute(Indexed& element, CallMessage* message);
  /// insert() of an element that exists: misuse unless the message allows for that.
  void refuse_insertion(CallMessage* message);
  void route(CallMessage* message, Record* record);
  void at_home(CallMessage* message, const Record* record);
  [[nodiscard]] Messages& parked(Parked why) {
    return why == Parked::pending ? pending_ : why == Parked::waiting ? waiting_ : destroyed_;
  }
  void park(CallMessage* message, Parked why);
  /// Removes the parked messages of an index; the caller routes them again.
  [[nodiscard]] std::vector<CallMessage*> unpark(const Index& index, Parked why);
  void ask(CallMessage* message);
  void grant(const Index& index, Version version);
  void forward(CallMessage* message, const Place& place);
  void depart(Indexed& element, PeId to);
  /// Sends the element to another PE; it is no longer listed here.
  void ship(Indexed& element, PeId to, Memberships&& memberships);
  void destroy_here(Indexed& element);
  void dead_letter(CallMessage* message);
  [[nodiscard]] static bool may_be_unwanted(const CallMessage& message) {
    return static_cast<const ElementAction<Index>&>(*message.action).unwanted != nullptr;
  }
  /// True if the message need not wait for its element (ElementAction::Unwanted).
  [[nodiscard]] bool unwanted(const CallMessage& message) {
    return may_be_unwanted(message) &&
           static_cast<const ElementAction<Index>&>(*message.action).unwanted(*this, message);
  }
  void end_element(Indexed& element);
  void reroute(std::vector<CallMessage*>&& messages) {
    for (CallMessage* message : messages) arrive_later(message);
  }
  /// Puts a message into this PE's queue, from which it reaches the element or is routed.
  void arrive_later(CallMessage* message) { pe_.send_here(message); }
  /// Applies a hint if it is newer than what is known.
  void learn(const Index& index, const Place& place);

  void on_request(const Request& request);
  void on_grant(const Grant& m) { grant(m.index, m.version); }
  void on_location_update(const LocationUpdate& update);
  void on_move_report(const MoveReport& report);
  void on_move_noted(const MoveNoted& noted);
  void on_destroy_report(const DestroyReport& report);
  void on_destroy_noted(const DestroyNoted& noted);

  const BlockMap block_map_;
  bool makes_initial_ = false;
  IndexTable<Index, Indexed> table_;
  std::uint32_t n_departures_ = 0;          // elements that left or were destroyed
  std::size_t n_purposeful_ = 0;            // parked messages that may become unwanted, or more
  std::size_t n_hints_ = 0;                 // hints learnt since they were last forgotten
  Messages pending_, waiting_, destroyed_;  // parked messages by reason (Parked)
  ByIndex<std::uint32_t> n_unconfirmed_;    // destructions that the home has not confirmed
  Index last_destroyed_{};
};

template <class Index>
inline void ArrayOf<Index>::execute(Indexed& element, CallMessage* message) {
  const auto& action = static_cast<const ElementAction<Index>&>(*message->action);
  Counted counted(pe_.completion(), message->epoch);
  if (action.invoke == nullptr) [[unlikely]] {
    refuse_insertion(message);
  } else {
    const ElementScope scope(pe_, element, message->action, counted.epoch(), message->led_by);
    try {
      action.invoke(element, *message);
    } catch (...) {
      pe_.error().note_place();
      discard(message);
      throw;
    }
    discard(message);
  }
  counted.done();
}

// The usual types of indices are compiled once, in array_of.cpp.
extern template class ArrayOf<Index1>;
extern template class ArrayOf<Index2>;
extern template class ArrayOf<Index3>;

}  // namespace tess::detail

namespace tess {

using detail::DeadLetters;

}  // namespace tess
