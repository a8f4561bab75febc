// The sections of a collection on one PE, as far as they do not depend on the type of index: the
// members that are here, the order in which they receive multicasts, and their contributions.
//
// An element becomes a member by the message Join, which the section's root sends to each index of
// its list. Until then it may contribute already: then it neither moves nor ends before Join has
// reached it, and its contributions wait with it, since it may be no member. So a member that ends
// always knows that it is one, and reports its end to the root.
//
// A member receives each multicast once, since the root sends it once (see SectionLists), and in
// the order of the numbers: what arrives before its turn waits with the member.
#pragma once

#include "runtime/arrays/membership.hpp"
#include "runtime/pe/tables/ended_collections.hpp"
#include "runtime/reduce/reduction_tree.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace tess::detail {

class Collection;
class Sections;

/// The parts of sections that depend on the type of index: section_lists.hpp.
class SectionLists {
 public:
  SectionLists() = default;
  SectionLists(const SectionLists&) = delete;
  SectionLists& operator=(const SectionLists&) = delete;
  virtual ~SectionLists() = default;

  /// Sends a multicast to an element here as an ordinary message.
  virtual void send_again(Element& element, SectionId section, const SectionCall& call) = 0;
  /// On the root: a member was destroyed.
  virtual void gone(SectionId section, std::uint32_t ordinal) = 0;
  /// The section ends here: what waits for it is dropped.
  virtual void end(SectionId section) = 0;
  virtual void end_all() = 0;
  // For checkpoints: the sections whose root is this PE, with the indices of their members.
  virtual std::vector<SectionId> save(Writer& ar) const = 0;
  virtual void restore(Reader& ar) = 0;
  virtual void describe_waiting(std::vector<std::string>& lines) const = 0;
};

/// One section on one PE.
class SectionPart final : public ReductionHost {
 public:
  SectionPart(Sections& sections, SectionId id);

  void send(PeId to, ReductionReport&& report) override;
  void deliver(Partial& result, EpochId epoch) override;
  // PEs that attach are not asked, and broadcasts do not say where members join.
  void send(PeId /*to*/, const ReductionBegin& /*begin*/) override {}
  [[nodiscard]] std::uint64_t applied_broadcast() const override { return 0; }
  void postpone_new_elements() override {}
  /// The members here that have not contributed to all numbers below one, as text.
  [[nodiscard]] std::string members_before(std::uint32_t number) const;

  struct Member {
    Element* element = nullptr;  // null: it has left while multicasts run
    std::uint32_t ordinal = 0;
    std::uint32_t next = 0;
    std::uint64_t seen = 0;
    std::uint64_t listed = 0;  // the generation of lists that has it on this PE; 0: none
    bool joined = false;
    std::vector<WaitingCall> early;
    struct Held {
      Counted counted;
      std::unique_ptr<Partial> value;
    };
    std::vector<Held> held;  // its contributions before it has joined
  };

  Sections& sections;
  const SectionId id;
  std::vector<Member> members;
  std::unordered_map<std::uint32_t, std::uint32_t> slots;  // of the members that have joined
  std::uint64_t generation = 0;                            // of the lists; the newest known here
  std::vector<std::uint32_t> listed;                       // its ordinals on this PE, ascending
  std::size_t n_listed = 0;                                // those of them that are here
  unsigned running = 0;       // multicasts that run: members keep their slots
  bool has_holes = false;     // members left meanwhile
  std::uint32_t current = 0;  // the slot of the member that runs, or ran last
  ReductionTree reduction;
};

class Sections {
 public:
  explicit Sections(Collection& collection) : collection_(collection) {}
  Sections(const Sections&) = delete;
  Sections& operator=(const Sections&) = delete;
  ~Sections();

  [[nodiscard]] Collection& collection() { return collection_; }
  [[nodiscard]] std::unique_ptr<SectionLists>& lists() { return lists_; }

  /// The part of a section here, made if it is new; null once the section has ended here.
  [[nodiscard]] SectionPart* part(SectionId id) {
    return last_ != nullptr && last_->id == id ? last_ : find_part(id);
  }
  /// The root of a section.
  [[nodiscard]] PeId root(SectionId id) const;

  /// A member of a section: its slot, as long as no member leaves.
  struct Seat {
    SectionPart* part = nullptr;  ///< null: the section has ended, or the element is no member
    std::uint32_t slot = 0;
    [[nodiscard]] SectionPart::Member& member() const { return part->members[slot]; }
  };
  /// The seat of an element that has joined the section.
  [[nodiscard]] Seat find(Element& element, SectionId id);

  /// Join has reached the element. Returns false if the section has ended here.
  bool join(Element& element, SectionId id, std::uint32_t ordinal);
  /// The lists of a generation have these members on this PE, ascending.
  void list(SectionPart& part, std::uint64_t generation, std::vector<std::uint32_t> ordinals);

  /// Calls the member, or keeps the call until its turn. Within a Run.
  void deliver(const Seat& seat, const SectionCall& call);
  /// Calls all members that are listed here. (No call makes another member leave at once.)
  void deliver_listed(SectionPart& part, const SectionCall& call);
  /// While it lives, members keep their slots, and what they cause belongs to the call's epoch.
  class Run {
   public:
    Run(Sections& sections, SectionPart& part, const SectionCall& call);
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    ~Run();

   private:
    Sections& sections_;
    SectionPart& part_;
    EpochId before_;
  };

  // Contributions.

  /// The seat of an element that contributes; an element that has not joined yet gets one.
  [[nodiscard]] Seat contributor(Element& element, SectionId id) {
    SectionPart* const of = part(id);
    if (of == nullptr) return {};
    if (of->current < of->members.size() && of->members[of->current].element == &element) [[likely]]
      return {of, of->current};
    return find_contributor(*of, element);
  }
  void contributed(const Seat& seat) { seat.part->reduction.added(seat.member().next++); }
  void contribute(const Seat& seat, std::unique_ptr<Partial> value);

  // Elements that come and go.

  void enter(Element& element, Memberships&& memberships);
  [[nodiscard]] Memberships leave(Element& element);
  /// The element is being destroyed; it has been told to leave the collection's list.
  void destroyed(Element& element);

  /// The section ends on this PE.
  void end(SectionId id);
  [[nodiscard]] bool has_ended(SectionId id) const {
    return ended_.contains(CollectionId{id.value});
  }
  /// After a restart: the section had ended before the checkpoint.
  void had_ended(SectionId id) { ended_.add(CollectionId{id.value}); }
  /// The collection ends on this PE.
  void end_all();

  void describe_waiting(std::vector<std::string>& lines) const;
  /// A section whose root is here has no members.
  [[nodiscard]] bool any_empty() const;

 private:
  friend class SectionPart;
  [[nodiscard]] SectionPart* find_part(SectionId id);
  [[nodiscard]] Seat find_contributor(SectionPart& part, Element& element);
  Seat add(SectionPart& part, Element& element, SectionPart::Member&& member);
  /// Frees a member's slot. Its element's list of seats is unchanged.
  [[nodiscard]] SectionPart::Member remove(SectionPart& part, std::uint32_t slot);
  void move_slot(SectionPart& part, std::uint32_t from, std::uint32_t to);
  void close_holes(SectionPart& part);
  void free(std::unique_ptr<SectionPart> part, std::vector<Element*>& released);
  void call(Element& element, const SectionCall& call);

  Collection& collection_;
  std::unordered_map<std::uint64_t, std::unique_ptr<SectionPart>> parts_;
  SectionPart* last_ = nullptr;  // the part that was used last
  std::unordered_map<const Element*, std::vector<Seat>> seats_;
  EndedCollections ended_;
  bool all_ended_ = false;
  std::unique_ptr<SectionLists> lists_;
};

/// Ends a section on all PEs. Ending it again has no effect.
void end_section(CollectionId collection, SectionId section);

}  // namespace tess::detail
