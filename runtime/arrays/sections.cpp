#include "runtime/arrays/sections.hpp"

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/collection_action.hpp"
#include "runtime/base/first_few.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {
namespace {

struct ReportTo {
  SectionId section;
  ReductionReport report;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(section, report);
  }
  std::uint64_t drop(Pe& pe) const { return report.drop(pe); }
};
struct Gone {
  SectionId section;
  std::uint32_t ordinal = 0;
  std::uint32_t next = 0;
};
struct EndSection {
  SectionId section;
};

void report_arrives(Collection& collection, ReportTo&& m) {
  if (SectionPart* part = collection.sections().part(m.section); part != nullptr) {
    part->reduction.on_report(std::move(m.report));
  } else {
    m.drop(collection.pe());
  }
}
void gone_arrives(Collection& collection, Gone&& m) {
  Sections& sections = collection.sections();
  SectionPart* part = sections.part(m.section);
  if (part == nullptr) return;
  sections.lists()->gone(m.section, m.ordinal);
  part->reduction.member_destroyed(m.next);
}
void end_arrives(Collection& collection, EndSection&& m, Counted /*counted*/) {
  collection.sections().end(m.section);
}

/// The multicasts that wait for their turn with an element that has arrived.
std::vector<WaitingCall> arrived(Pe& pe, std::vector<SectionCall>&& early) {
  std::vector<WaitingCall> waiting;
  for (SectionCall& call : early) {
    Counted counted(pe.completion(), call.numbered.epoch);
    waiting.push_back({std::move(call), std::move(counted)});
  }
  return waiting;
}

}  // namespace

void drop(Pe& pe, Memberships& memberships) {
  for (Membership& membership : memberships) (void)arrived(pe, std::move(membership.early));
}

void end_section(CollectionId collection, SectionId section) {
  Pe& pe = current_pe();
  for (std::int32_t to = 0; to < pe.n_pes(); ++to)
    send_to_collection<&end_arrives>(pe, collection, PeId{to}, EndSection{section});
}

SectionPart::SectionPart(Sections& sections_, SectionId id_)
    : sections(sections_),
      id(id_),
      reduction(*this, sections_.collection().pe().completion(), sections_.collection().pe().id(),
                sections_.root(id_), sections_.collection().pe().n_pes(),
                {"a section of " + sections_.collection().name() + ": reduction",
                 [this](std::uint32_t number) { return members_before(number); }},
                MembersOf::section) {}

void SectionPart::send(PeId to, ReductionReport&& report) {
  send_to_collection<&report_arrives>(sections.collection(), to, ReportTo{id, std::move(report)});
}

void SectionPart::deliver(Partial& result, EpochId epoch) {
  sections.collection().deliver(result, epoch, "a section of ");
}

std::string SectionPart::members_before(std::uint32_t number) const {
  FirstFew missing;
  for (const Member& member : members)
    if (member.element != nullptr && member.next < number)
      missing.add([&member] { return element_text(*member.element); });
  return missing.text();
}

Sections::~Sections() = default;

SectionPart* Sections::find_part(SectionId id) {
  const auto at = parts_.find(id.value);
  if (at != parts_.end()) return last_ = at->second.get();
  if (all_ended_ || ended_.contains(CollectionId{id.value})) return nullptr;
  return last_ =
             parts_.emplace(id.value, std::make_unique<SectionPart>(*this, id)).first->second.get();
}

PeId Sections::root(SectionId id) const {
  return root_of(CollectionId{id.value}, collection_.pe().n_pes());
}

Sections::Seat Sections::add(SectionPart& part, Element& element, SectionPart::Member&& member) {
  const Seat seat{&part, static_cast<std::uint32_t>(part.members.size())};
  member.element = &element;
  if (member.joined) {
    part.slots[member.ordinal] = seat.slot;
    if (std::binary_search(part.listed.begin(), part.listed.end(), member.ordinal)) {
      member.listed = part.generation;
      ++part.n_listed;
    }
  }
  part.reduction.enter(member.next);
  part.members.push_back(std::move(member));
  seats_[&element].push_back(seat);
  element.in_sections_ = true;
  return seat;
}

Sections::Seat Sections::find(Element& element, SectionId id) {
  SectionPart* const of = part(id);
  if (of == nullptr || !element.in_sections_) return {};
  if (of->current < of->members.size() && of->members[of->current].element == &element)
    return {of, of->current};
  for (const Seat& seat : seats_.at(&element))
    if (seat.part == of) return seat;
  return {};
}

bool Sections::join(Element& element, SectionId id, std::uint32_t ordinal) {
  SectionPart* const of = part(id);
  if (of == nullptr) return false;
  Seat seat = find(element, id);
  if (seat.part == nullptr) {
    SectionPart::Member member;
    member.ordinal = ordinal;
    member.joined = true;
    add(*of, element, std::move(member));
    of->reduction.advance();
    return true;
  }
  SectionPart::Member& member = seat.member();
  member.ordinal = ordinal;
  member.joined = true;
  of->slots[ordinal] = seat.slot;
  // A result may be delivered meanwhile: then the seat is another one, or the section has ended.
  for (auto& [counted, value] : std::exchange(member.held, {})) {
    seat = find(element, id);
    if (seat.part != nullptr)
      seat.part->reduction.contribute(seat.member().next++, counted.epoch(), std::move(value));
  }
  Collection::release(element);
  return true;
}

void Sections::list(SectionPart& part, std::uint64_t generation,
                    std::vector<std::uint32_t> ordinals) {
  part.generation = generation;
  part.listed = std::move(ordinals);
  part.n_listed = 0;
  for (const std::uint32_t ordinal : part.listed) {
    const auto at = part.slots.find(ordinal);
    if (at == part.slots.end()) continue;
    part.members[at->second].listed = generation;
    ++part.n_listed;
  }
}

void Sections::call(Element& element, const SectionCall& call) {
  Pe& pe = collection_.pe();
  const BroadcastCall& what = *call.numbered.call;
  const ElementScope scope(pe, element, &what.action(), call.numbered.epoch, call.led_by);
  try {
    what.invoke(element);
  } catch (...) {
    pe.error().note_place();
    throw;
  }
}

Sections::Run::Run(Sections& sections, SectionPart& part, const SectionCall& call)
    : sections_(sections), part_(part) {
  Pe& pe = sections.collection_.pe();
  ++part.running;
  before_ = std::exchange(pe.context().epoch, call.numbered.epoch);
  pe.begins(&call.numbered.call->action());
}
Sections::Run::~Run() {
  sections_.collection_.pe().context().epoch = before_;
  if (--part_.running == 0 && part_.has_holes) sections_.close_holes(part_);
}

void Sections::deliver(const Seat& seat, const SectionCall& call) {
  SectionPart& part = *seat.part;
  Element& element = *seat.member().element;
  Pe& pe = collection_.pe();
  if (call.numbered.number != seat.member().seen + 1) {
    TESS_CHECK(call.numbered.number > seat.member().seen, element_text(element),
               " receives a multicast twice");
    seat.member().early.push_back({call, Counted::sent(pe.completion(), call.numbered.epoch)});
    return;
  }
  seat.member().seen = call.numbered.number;
  part.current = seat.slot;
  // The one that waits for its turn becomes its own message, since its epoch waits for what it
  // causes. It is sent now: the call may make the element leave.
  auto& early = seat.member().early;
  const auto next = std::find_if(early.begin(), early.end(), [&call](const WaitingCall& one) {
    return one.call.numbered.number == call.numbered.number + 1;
  });
  if (next != early.end()) {
    const WaitingCall waiting = std::move(*next);
    early.erase(next);
    lists_->send_again(element, part.id, waiting.call);
  }
  // An element that is over may still wait for Join of another section.
  if (!collection_.is_over(element)) this->call(element, call);
}

void Sections::deliver_listed(SectionPart& part, const SectionCall& call) {
  const Run run(*this, part, call);
  const std::size_t n = part.members.size();  // elements that contribute meanwhile are added
  const std::uint64_t generation = part.generation;
  for (std::size_t i = 0; i < n && !collection_.pe().stopped(); ++i)
    if (part.members[i].listed == generation)
      deliver(Seat{&part, static_cast<std::uint32_t>(i)}, call);
}

Sections::Seat Sections::find_contributor(SectionPart& part, Element& element) {
  const Seat seat = find(element, part.id);
  if (seat.part != nullptr) return seat;
  Collection::require_not_destroyed(element,
                                    " contributes in its destructor: contribute before destroy()");
  Collection::hold(element);  // it stays here until Join has reached it
  const Seat added = add(part, element, SectionPart::Member{});
  part.reduction.advance();
  return added;
}

void Sections::contribute(const Seat& seat, std::unique_ptr<Partial> value) {
  SectionPart::Member& member = seat.member();
  const EpochId epoch = collection_.pe().context().epoch;
  if (member.joined) return seat.part->reduction.contribute(member.next++, epoch, std::move(value));
  member.held.push_back({Counted::sent(collection_.pe().completion(), epoch), std::move(value)});
}

void Sections::move_slot(SectionPart& part, std::uint32_t from, std::uint32_t to) {
  part.members[to] = std::move(part.members[from]);
  const SectionPart::Member& member = part.members[to];
  if (member.joined) part.slots[member.ordinal] = to;
  for (Seat& seat : seats_.at(member.element))
    if (seat.part == &part) seat.slot = to;
}

SectionPart::Member Sections::remove(SectionPart& part, std::uint32_t slot) {
  SectionPart::Member member = std::move(part.members[slot]);
  part.members[slot].element = nullptr;
  part.reduction.leave(member.next);
  if (member.joined) part.slots.erase(member.ordinal);
  if (member.listed != 0 && member.listed == part.generation) --part.n_listed;
  if (part.running != 0) {
    part.has_holes = true;
    return member;
  }
  const auto last = static_cast<std::uint32_t>(part.members.size() - 1);
  if (slot != last) move_slot(part, last, slot);
  part.members.pop_back();
  return member;
}

void Sections::close_holes(SectionPart& part) {
  part.has_holes = false;
  std::uint32_t kept = 0;
  for (std::uint32_t slot = 0; slot < part.members.size(); ++slot) {
    if (part.members[slot].element == nullptr) continue;
    if (slot != kept) move_slot(part, slot, kept);
    ++kept;
  }
  part.members.resize(kept);
}

void Sections::enter(Element& element, Memberships&& memberships) {
  for (Membership& membership : memberships) {
    std::vector<WaitingCall> early = arrived(collection_.pe(), std::move(membership.early));
    SectionPart* const of = part(membership.section);
    if (of == nullptr) continue;
    SectionPart::Member member;
    member.ordinal = membership.ordinal;
    member.next = membership.next;
    member.seen = membership.seen;
    member.joined = true;
    member.early = std::move(early);
    add(*of, element, std::move(member));
    of->reduction.advance();
  }
}

Memberships Sections::leave(Element& element) {
  Memberships memberships;
  if (!element.in_sections_) return memberships;
  element.in_sections_ = false;
  auto node = seats_.extract(&element);
  for (const Seat& seat : node.mapped()) {
    SectionPart::Member member = remove(*seat.part, seat.slot);
    Membership& left = memberships.emplace_back(
        Membership{seat.part->id, member.ordinal, member.next, member.seen, {}});
    for (auto& [call, counted] : member.early) {
      counted.leave();
      left.early.push_back(std::move(call));
    }
  }
  for (const Seat& seat : node.mapped()) seat.part->reduction.advance();
  return memberships;
}

void Sections::destroyed(Element& element) {
  Memberships memberships = leave(element);
  drop(collection_.pe(), memberships);
  for (const Membership& membership : memberships)
    send_to_collection<&gone_arrives>(
        collection_, root(membership.section),
        Gone{membership.section, membership.ordinal, membership.next});
}

/// Ends the part; `released` gets the elements that waited for Join.
void Sections::free(std::unique_ptr<SectionPart> part, std::vector<Element*>& released) {
  for (SectionPart::Member& member : part->members) {
    if (!member.joined) {
      Collection::release(*member.element);
      released.push_back(member.element);
    }
    const auto seats = seats_.find(member.element);
    std::erase_if(seats->second, [&part](const Seat& seat) { return seat.part == part.get(); });
    if (!seats->second.empty()) continue;
    member.element->in_sections_ = false;
    seats_.erase(seats);
  }
  part->reduction.end();
}

void Sections::end(SectionId id) {
  ended_.add(CollectionId{id.value});
  last_ = nullptr;
  collection_.drop_unwanted();  // Join may wait here for an index that has no element
  if (lists_) lists_->end(id);
  auto node = parts_.extract(id.value);
  if (node.empty()) return;
  std::vector<Element*> released;
  free(std::move(node.mapped()), released);
  for (Element* element : released) collection_.settle(*element);
}

void Sections::end_all() {
  all_ended_ = true;
  last_ = nullptr;
  if (lists_) lists_->end_all();
  std::vector<Element*> released;  // the collection destroys them
  for (auto& [id, part] : parts_) free(std::move(part), released);
  parts_.clear();
}

bool Sections::any_empty() const {
  return std::ranges::any_of(parts_,
                             [](const auto& of) { return of.second->reduction.is_empty(); });
}

void Sections::describe_waiting(std::vector<std::string>& lines) const {
  for (const auto& [id, part] : parts_) {
    for (const SectionPart::Member& member : part->members)
      if (member.element != nullptr && !member.joined)
        lines.push_back(text(element_text(*member.element),
                             " contributes to a section that it is no member of"));
    part->reduction.describe_waiting(lines);
  }
  if (lists_) lists_->describe_waiting(lines);
}

}  // namespace tess::detail
