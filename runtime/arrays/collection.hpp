// One collection (array or group) on one PE: its local elements, its part in broadcasts and
// reductions. ArrayOf and Array add what depends on the types of index and chare.
#pragma once

#include "runtime/arrays/balanced_elements.hpp"
#include "runtime/arrays/collection_hosts.hpp"
#include "runtime/arrays/collection_kind.hpp"
#include "runtime/arrays/elements/element.hpp"
#include "runtime/arrays/membership.hpp"
#include "runtime/pe/pe.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tess::detail {

struct LoadRecord;
class IndexMap;
class KeptScans;
class Sections;

/// The PE that numbers the broadcasts and completes the reductions of a collection.
[[nodiscard]] inline PeId root_of(CollectionId id, std::int32_t n_pes) {
  return PeId{static_cast<std::int32_t>(mix(id.value) % static_cast<std::uint64_t>(n_pes))};
}

class Collection : public HostedCollection {
 public:
  Collection(Pe& pe, CollectionId id, std::string name, const Range& range);
  Collection(const Collection&) = delete;
  Collection& operator=(const Collection&) = delete;
  ~Collection() override;

  [[nodiscard]] static Collection& of(const Element& element) { return *element.collection_; }
  [[nodiscard]] Pe& pe() { return pe_; }
  /// The PE that numbers broadcasts and completes reductions.
  [[nodiscard]] PeId root() const { return root_of(id(), pe_.n_pes()); }

  [[nodiscard]] BroadcastLog& broadcasts() { return broadcasts_; }
  [[nodiscard]] ReductionTree& reductions() { return reductions_; }
  [[nodiscard]] ReductionTree& tree(Track track);
  /// Its sections on this PE; made by the first call.
  [[nodiscard]] Sections& sections();
  /// The contributions to scans that wait on this PE; made by the first call.
  [[nodiscard]] KeptScans& kept_scans();
  /// From now on the messages of its reductions run before those of users. Called on every PE.
  void expedite_reductions() { reduction_host_.expedite(); }
  /// Sets a library's tree, to which messages of the second track go; the library owns it.
  void set_second_tree(ReductionTree& tree) { second_tree_ = &tree; }

  /// The map that the array was created with; null for none.
  [[nodiscard]] const IndexMap* index_map() const { return index_map_.get(); }
  void set_index_map(std::shared_ptr<const IndexMap> map) { index_map_ = std::move(map); }

  /// Local elements; a slot may be null while elements leave in the middle of a broadcast.
  [[nodiscard]] const std::vector<Element*>& elements() const final { return elements_; }

  /// Calls one element for a broadcast.
  void call(Element& element, const NumberedCall& call);
  /// Completes a reduction in the epoch of its contributions. `of`: "", or what of the collection.
  void deliver(Partial& result, EpochId epoch, std::string_view of);

  /// Calls all local elements that have not received this broadcast yet.
  void apply(const NumberedCall& call);

  /// An element of this PE contributes to its next reduction, or to the round that it names.
  void contribute(Element& element, std::unique_ptr<Partial> value, std::optional<RoundId> round);
  /// The partial result to which the element can add its value directly; null if there is none.
  /// After adding, the caller calls contributed().
  [[nodiscard]] Partial* open_sum(Element& element, const PartialKind& kind) {
    const ElementState& state = element.state_;
    if (state.created_after != 0 || state.inserted_in != not_new || state.ahead != 0)
      return nullptr;  // contribute() looks at it
    return reductions_.open_sum(element.state_.next_reduction, kind, pe_.context().epoch);
  }
  void contributed(Element& element) {
    reductions_.added(element.state_.next_reduction++, cause_of(element));
  }

  /// The elements that were destroyed here while the collection lived, and the last one in words.
  [[nodiscard]] std::uint64_t n_destroyed() const { return n_destroyed_; }
  [[nodiscard]] virtual std::string last_destroyed() const { return {}; }

  /// The element is destroyed now: its destructor does not contribute.
  static void counts_no_more(Element& element) { element.state_.created_after = destroyed_now; }
  /// The element ends: it is misuse if it has contributed to a round and not to one before.
  static void require_no_gap(const Element& element);
  /// Ends the run with the element's name and the claim if its destructor runs.
  static void require_not_destroyed(const Element& element, std::string_view claim);
  /// From now on the element keeps the number of its next reduction.
  void settle_join(Element& element) {
    if (element.state_.created_after == 0) return;
    element.state_.created_after = 0;
    --n_new_;
  }
  /// It is now known which reductions broadcasts led to: elements that were created after these
  /// broadcasts join later.
  void postpone_new_elements();

  /// The broadcast of a collection that led to the running code; 0 if none did.
  [[nodiscard]] static std::uint32_t led_by(const Context& context, CollectionId collection) {
    return context.led_in == collection ? context.led_by : 0;
  }

  /// What a balancer needs of the elements here.
  [[nodiscard]] BalancedElements& balanced() { return balanced_; }
  /// The element stays here, as if a coroutine of it waited, until it is released; settle() follows.
  static void hold(Element& element) {
    ++element.n_suspended_;
    ++element.n_held_;
  }
  static void release(Element& element) {
    --element.n_suspended_;
    --element.n_held_;
  }
  /// True if the element has called destroy(), and none of its code runs outside the present
  /// message or waits: it stays only since it is held.
  [[nodiscard]] bool is_over(const Element& element) const {
    const std::uint32_t runs_now = pe_.context().element == &element ? 1 : 0;
    return element.destroy_requested_ && element.n_suspended_ == element.n_held_ + runs_now;
  }
  /// The element waits until its balancer resumes it.
  void at_sync(Element& element);
  /// Lets the element migrate once none of its code runs or waits. The current epoch waits for the
  /// migration, unless a waiting coroutine delays it.
  void move(Element& element, PeId to);
  /// Sends the element the message that calls its resume_from_sync().
  virtual void resume(Element& element);
  /// The hash of the element's index.
  [[nodiscard]] virtual std::uint64_t key_of(const Element& element) const;
  [[nodiscard]] std::int64_t rank_of(const Element& element) const override;
  /// The result of its balance_position(), if it has one.
  [[nodiscard]] virtual std::optional<std::array<double, 3>> position_of(
      const Element& element) const;
  /// The result of its describe_state(), if it has one.
  [[nodiscard]] virtual std::string state_of(const Element& element) const;
  /// The number of bytes that a migration to another process would send.
  [[nodiscard]] virtual std::uint64_t packed_bytes(Element& element) const;

  /// Writes an element: its index, its state and the user's members.
  using PackElement = void (*)(Element& element, Writer& ar);
  /// What `pack` writes: the number of bytes, and the bytes.
  [[nodiscard]] static std::uint64_t n_bytes_of(Element& element, PackElement pack);
  [[nodiscard]] static Buffer bytes_of(Element& element, PackElement pack);

  /// Called after code of the element ran: the element leaves or is destroyed now if that was
  /// requested and none of its code waits.
  virtual void settle(Element& element) = 0;
  /// Holds the element until the running message is done, and settles it then. The current epoch
  /// waits for this.
  void settle_later(Element& element);

  /// A constructor requests something that needs the element to be listed: `call` runs once it is.
  /// For initial elements of an array, `call` runs once all of them are listed on this PE.
  void after_construction(std::function<void()> call) {
    after_construction_.push_back(std::move(call));
  }

  /// Ends the collection on this PE, after it was removed from the PE's table: its contents are
  /// dropped and its elements destroyed. Elements with a waiting coroutine follow one by one; the
  /// last one calls free_later().
  virtual void end();
  [[nodiscard]] bool ended() const { return ended_; }

  // For checkpoints, which are made while nothing runs and nothing is under way.

  /// How collections of this class are saved and made anew.
  [[nodiscard]] virtual const CollectionKind& kind() const = 0;
  [[nodiscard]] const Range& range() const final { return range_; }
  /// Appends a line for each element here that waits at its balancer's barrier: it cannot be saved.
  void describe_unsaved(std::vector<std::string>& lines) const;
  /// Writes the elements that are here. Calls written() after each: what was written may be taken
  /// out of the writer's buffer then.
  void save(Writer& ar, const std::function<void()>& written);
  /// Reads what save() wrote on some PE, and sends each element to its new home.
  void restore(Reader& ar);
  /// An element has arrived at its home, or that the last one of its index was destroyed.
  virtual void take_saved(std::uint32_t incarnation, bool alive, Reader& ar) = 0;
  /// All elements have arrived.
  virtual void restored() {}
  [[nodiscard]] bool has_sections() const { return sections_ != nullptr; }
  /// Writes the sections whose root is this PE, and returns their ids.
  std::vector<SectionId> save_sections(Writer& ar) const;
  virtual void restore_sections(Reader& ar) = 0;
  /// Drops the messages that wait here for absent elements and have lost their purpose.
  virtual void drop_unwanted() = 0;
  /// After a restart: the section had ended before the checkpoint.
  void section_had_ended(SectionId id);

  /// True if elements can be packed and rebuilt elsewhere.
  [[nodiscard]] virtual bool migratable() const = 0;
  [[nodiscard]] virtual std::string index_text_of(const Element& element) const = 0;
  [[nodiscard]] std::pair<bool, bool> has_nothing_to_reduce() const override;
  void describe_waiting(std::vector<std::string>& lines) const override;
  /// The first few local elements that have not contributed to all reductions below `number`, as
  /// text.
  [[nodiscard]] std::string elements_before(std::uint32_t number) const;

 protected:
  /// The home of an index, which has the array's type, by the map that the array was created with.
  [[nodiscard]] PeId mapped_home(const void* index) const;
  /// The ranks in the range, first and end, among which are the initial elements of this PE: its
  /// block, or all if the class or a map places them.
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> ranks_of_blocks(bool class_places) const;
  /// Misuse: place() of the class gave a PE that does not exist.
  [[noreturn]] void refuse_place(const std::string& index, PeId at) const;
  /// Reads the user's members from the rest of the bytes; misuse if they read more or less.
  void read_all_members(Element& element, Reader& ar) const;
  /// The same for an element of a checkpoint, which another program may have written: throws Error.
  void read_saved_members(Element& element, Reader& ar) const;
  /// Reads the user's members.
  virtual void read_members(Element& element, Reader& ar) const = 0;
  /// Writes the index and the user's members.
  virtual void save_element(Element& element, Writer& ar) = 0;
  /// Writes the indices with this home whose elements were destroyed; returns their number.
  virtual std::uint64_t save_destroyed(Writer& ar) const = 0;
  [[nodiscard]] virtual PeId home_of_saved(Reader ar) const = 0;
  void list(Element& element);
  void unlist(Element& element);
  /// Runs the calls that constructors have requested.
  void run_after_construction();
  [[nodiscard]] bool has_after_construction() const { return !after_construction_.empty(); }
  /// Drops the calls that a constructor requested: the element was constructed to be read from
  /// bytes, and the calls have run before its migration.
  void drop_after_construction() { after_construction_.clear(); }
  /// Registers an element that was just created here; `joins` as its constructor call carries it.
  void register_new(Element& element, std::uint32_t joins = 0);

  /// An element leaves or is destroyed: it is not listed any more.
  [[nodiscard]] Memberships leave_sections(Element& element);
  void end_memberships(Element& element);
  /// An element arrives with its memberships.
  void enter_sections(Element& element, Memberships&& memberships);

  Pe& pe_;
  std::uint64_t n_destroyed_ = 0;

 private:
  void postpone(Element& element);
  /// True if this is the first contribution of an element that was inserted without the name of a
  /// round, and nothing tells that it joined at the round for which the program means the value.
  [[nodiscard]] bool is_unawaited(Element& element, const Cause& cause);
  /// Marks a number as contributed to; misuse if the element cannot contribute to it.
  void claim(Element& element, std::int64_t number);
  [[nodiscard]] Cause cause_of(const Element& element) const {
    const Context& context = pe_.context();
    return {element.state_.seen_broadcast, context.element == &element ? context.led_by : 0};
  }

  const Range range_;
  std::shared_ptr<const IndexMap> index_map_;
  std::vector<Element*> elements_;
  std::vector<std::function<void()>> after_construction_;
  BalancedElements balanced_{pe_};
  ReductionTree* second_tree_ = nullptr;
  std::size_t n_new_ = 0;  // local elements that have not contributed since their construction
  unsigned applying_ = 0;
  bool ended_ = false;
  BroadcastHostOfCollection broadcast_host_{*this};
  ReductionHostOfCollection reduction_host_{*this, Track::own};
  BroadcastLog broadcasts_;
  ReductionTree reductions_;
  std::unique_ptr<Sections> sections_;  // null until a section has members or messages here
  std::unique_ptr<KeptScans> scans_;    // null until the first scan
};

/// Marks that code of an element runs: the element is the context's element, and it neither leaves
/// nor ends before the scope does.
class ElementScope {
 public:
  ElementScope(Pe& pe, Element& element, const Action* action, EpochId epoch,
               std::uint32_t led_by = 0)
      : pe_(pe),
        element_(element),
        context_{&element, action, epoch, led_by,
                 led_by == 0 ? CollectionId{} : element.collection_->id()},
        before_(pe.enter(&context_)),
        meter_(pe.meter()) {
    ++element.n_suspended_;
    element.has_run_ = true;
    if (meter_ != nullptr) [[unlikely]]
      outer_ = meter_->enter({load_of(pe, element), action});
  }
  ElementScope(const ElementScope&) = delete;
  ElementScope& operator=(const ElementScope&) = delete;
  /// Ends the scope; the element may not exist afterwards.
  ~ElementScope() noexcept(false) {
    pe_.enter(before_);
    if (meter_ != nullptr) [[unlikely]]
      meter_->leave(outer_);
    if (--element_.n_suspended_ == 0) {
      if (pe_.intercepts()) [[unlikely]]
        force_migration();
      if (element_.migrate_to_.value >= 0 || element_.destroy_requested_) [[unlikely]]
        element_.collection_->settle(element_);
    }
  }

 private:
  void force_migration();
  [[nodiscard]] static LoadRecord* load_of(Pe& pe, Element& element);
  Pe& pe_;
  Element& element_;
  Context context_;  // used by address: a copy of what was just written would stall
  Context* const before_;
  Meter* const meter_;
  Meter::Scope outer_;
};

/// The part of a collection on this PE; null if it is not known yet, or has ended.
[[nodiscard]] inline Collection* find_collection(Pe& pe, CollectionId id) {
  return static_cast<Collection*>(pe.collections().find(id));
}
/// Makes the part on this PE of a collection of this kind; its initial elements are still to come.
Collection& add_collection(Pe& pe, const CollectionKind& kind, CollectionId id, const Range& range,
                           const std::shared_ptr<const IndexMap>& map);
/// An element is inserted from this PE that is a member from this round on. Returns what its
/// constructor call carries.
[[nodiscard]] std::uint32_t join_at(Pe& pe, CollectionId id, RoundId round, std::string element);
/// Ends the job: `use`, as "a broadcast of f to", has an empty proxy.
[[noreturn]] void refuse_empty_proxy(std::string_view use);
/// Ends the job with the reason why find_collection() is null: the proxy is empty, or `what` has
/// ended, or it is not known here yet, for which `or_else` is another remedy.
[[noreturn]] void refuse_absent(CollectionId id, std::string_view what, std::string_view or_else);
/// The collection whose element is under construction; null if there is none.
[[nodiscard]] inline Collection* constructing_collection(Pe& pe) {
  return static_cast<Collection*>(pe.nesting().constructing_collection());
}

}  // namespace tess::detail
