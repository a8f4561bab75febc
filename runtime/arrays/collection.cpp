#include "runtime/arrays/collection.hpp"

#include "runtime/arrays/elements/balance_record.hpp"
#include "runtime/arrays/elements/index_map.hpp"
#include "runtime/arrays/sections.hpp"
#include "runtime/base/first_few.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/text.hpp"
#include "runtime/pe/interfaces/element_mover.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/reduce/kept_scans.hpp"

#include <exception>

namespace tess::detail {
namespace {

/// An element that is held, in the queue of its own PE, which it never leaves.
struct Settling {
  Element* element = nullptr;
  std::uint32_t led_by = 0;
  CollectionId led_in{};
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    TESS_CHECK(false, "an element that is held cannot leave its PE");
  }
};

void run_settling(Pe& pe, Settling&& settling, Counted /*counted*/) {
  Context& context = pe.context();
  context.led_by = settling.led_by;
  context.led_in = settling.led_in;
  Collection::release(*settling.element);
  Collection::of(*settling.element).settle(*settling.element);
}

}  // namespace

std::string element_text(const Element& element) {
  return element.collection_->name() + element.collection_->index_text_of(element);
}

std::string element_key(const Element& element) {
  return reply_key(Collection::of(element).id(), Collection::of(element).key_of(element));
}

LoadRecord* element_load(Element& element) {
  BalanceRecord* const record = BalancedElements::record_of(element);
  return record != nullptr ? &record->load : nullptr;
}

std::string element_state(const Element& element) {
  // A report goes on.
  try {
    return Collection::of(element).state_of(element);
  } catch (const std::exception& error) {
    return std::string("its describe_state() throws: ") + error.what();
  } catch (...) {
    return "its describe_state() throws";
  }
}

void Element::after_construction(const char* what, std::function<void()> call) {
  Collection* collection = constructing_collection(current_pe());
  TESS_CHECK(collection != nullptr, what,
             " belongs into an entry method or the constructor; serialize() is neither");
  collection->after_construction(std::move(call));
}

Collection::Collection(Pe& pe, CollectionId id, std::string name, const Range& range)
    : HostedCollection(id, std::move(name)),
      pe_(pe),
      range_(range),
      broadcasts_(broadcast_host_, pe.id(), root(), pe.n_pes()),
      reductions_(reduction_host_, pe.completion(), pe.id(), root(), pe.n_pes(),
                  {this->name() + ": reduction",
                   [this](std::uint32_t number) { return elements_before(number); }}) {
  for (const std::uint32_t round : pe.collections().take_early_joins(id))
    reductions_.add_member(round);
}

Collection::~Collection() = default;

ReductionTree& Collection::tree(Track track) {
  return track == Track::own ? reductions_ : *second_tree_;
}

Sections& Collection::sections() {
  if (!sections_) sections_ = std::make_unique<Sections>(*this);
  return *sections_;
}

PeId Collection::mapped_home(const void* index) const {
  return call_user([&] { return index_map_->home(index, range_, pe_.n_pes()); });
}

std::pair<std::int64_t, std::int64_t> Collection::ranks_of_blocks(bool class_places) const {
  const auto size = static_cast<std::int64_t>(range_.size());
  if (class_places || index_map_ != nullptr) return {0, size};
  const auto pe = static_cast<std::int64_t>(pe_.id().value);
  const std::int64_t n_pes = pe_.n_pes();
  return {(pe * size + n_pes - 1) / n_pes, ((pe + 1) * size + n_pes - 1) / n_pes};
}

void Collection::refuse_place(const std::string& index, PeId at) const {
  check_failed("place()", __FILE__, __LINE__,
               text("place() of ", name(), " puts the element ", index, " on ", at,
                    ", but the run has ", pe_.n_pes(), pe_.n_pes() == 1 ? " PE" : " PEs"));
}

KeptScans& Collection::kept_scans() {
  if (!scans_) scans_ = std::make_unique<KeptScans>();
  return *scans_;
}

Memberships Collection::leave_sections(Element& element) {
  return element.in_sections_ ? sections_->leave(element) : Memberships();
}

void Collection::end_memberships(Element& element) {
  if (element.in_sections_) sections_->destroyed(element);
}

void Collection::enter_sections(Element& element, Memberships&& memberships) {
  if (!memberships.empty()) sections().enter(element, std::move(memberships));
}

void Collection::list(Element& element) {
  element.collection_ = this;
  element.slot_ = static_cast<std::uint32_t>(elements_.size());
  elements_.push_back(&element);
  ++n_local_;
  reductions_.enter(element.state_.next_reduction);
  if (element.state_.created_after != 0) [[unlikely]] {
    ++n_new_;
    postpone(element);
  }
  balanced_.listed(element);
}

void Collection::unlist(Element& element) {
  --n_local_;
  reductions_.leave(element.state_.next_reduction);
  if (element.state_.created_after != 0) [[unlikely]]
    --n_new_;
  balanced_.unlisted(element);
  if (applying_ != 0) {  // a loop over the slots runs: it must neither miss nor repeat an element
    elements_[element.slot_] = nullptr;
    return;
  }
  elements_.back()->slot_ = element.slot_;
  elements_[element.slot_] = elements_.back();
  elements_.pop_back();
}

void Collection::register_new(Element& element, std::uint32_t joins) {
  const std::uint64_t applied = broadcasts_.applied();
  element.state_.seen_broadcast = applied;
  if (joins != 0) {  // join() has registered it
    element.state_.next_reduction = joins - 1;
    return;
  }
  element.state_.created_after = static_cast<std::uint32_t>(applied);
  element.state_.next_reduction = reductions_.joins_at();  // list() postpones it
  reductions_.add_member(element.state_.next_reduction);
}

void Collection::run_after_construction() {
  const auto calls = std::exchange(after_construction_, {});
  for (const auto& call : calls) call();
}

void Collection::postpone(Element& element) {
  ElementState& state = element.state_;
  state.next_reduction = reductions_.postpone(state.next_reduction, state.created_after);
}

void Collection::postpone_new_elements() {
  if (n_new_ == 0) return;
  for (Element* element : elements_)
    if (element != nullptr && element->state_.created_after != 0) postpone(*element);
}

void Collection::deliver(Partial& result, EpochId epoch, std::string_view of) {
  const DeliveryScope scope(pe_, epoch);
  try {
    result.complete(pe_);
  } catch (...) {
    pe_.error().note_place(text("at the end of a reduction of ", of, name()));
    pe_.error().keep(std::current_exception());
    throw;
  }
}

void Collection::call(Element& element, const NumberedCall& call) {
  element.state_.seen_broadcast = call.number;
  const ElementScope scope(pe_, element, &call.call->action(), call.epoch,
                           static_cast<std::uint32_t>(call.number));
  try {
    call.call->invoke(element);
  } catch (...) {
    pe_.error().note_place();
    throw;
  }
}

void Collection::apply(const NumberedCall& call) {
  ++applying_;
  // If the call makes an element migrate, the broadcast's epoch waits for it.
  const EpochId before = std::exchange(pe_.context().epoch, call.epoch);
  pe_.begins(&call.call->action());
  const std::size_t n =
      elements_
          .size();  // later ones were created after this broadcast or arrived after receiving it
  for (std::size_t i = 0; i < n; ++i) {
    Element* element = elements_[i];
    if (element == nullptr || element->state_.seen_broadcast >= call.number) continue;
    this->call(*element, call);
    if (pe_.stopped()) break;
  }
  pe_.context().epoch = before;
  if (--applying_ != 0) return;
  std::size_t kept = 0;
  for (Element* element : elements_) {
    if (element == nullptr) continue;
    element->slot_ = static_cast<std::uint32_t>(kept);
    elements_[kept++] = element;
  }
  elements_.resize(kept);
}

void Collection::require_not_destroyed(const Element& element, std::string_view claim) {
  TESS_CHECK(element.state_.created_after != destroyed_now, element_text(element), claim);
}

std::uint32_t join_at(Pe& pe, CollectionId id, RoundId round, std::string element) {
  TESS_CHECK(round.number >= 0 && round.number < most_rounds, element, " cannot join at round ",
             round.number, ": rounds are numbered from 0 to ", most_rounds - 1);
  const auto number = static_cast<std::uint32_t>(round.number);
  if (Collection* const known = find_collection(pe, id)) {
    known->reductions().join(number, std::move(element));
  } else {
    pe.collections().keep_early_join(id, number);
  }
  return number + 1;
}

void Collection::require_no_gap(const Element& element) {
  TESS_CHECK(element.state_.ahead == 0, element_text(element),
             " ends before it contributes to round ", element.state_.next_reduction,
             ", but it has contributed to a later one: destroy it after its last contribution");
}

// If its insertion was awaited in an epoch, no round was open when it was inserted, or the program
// says which. A broadcast of the array says where the element joins (see ReductionTree).
bool Collection::is_unawaited(Element& element, const Cause& cause) {
  const EpochId in = std::exchange(element.state_.inserted_in, not_new);
  return in != not_new && cause.led_by == 0 && element.has_run_ &&
         (in == EpochId{} || in == pe_.context().epoch);
}

void Collection::claim(Element& element, std::int64_t number) {
  ElementState& state = element.state_;
  const std::int64_t ahead = number - state.next_reduction;
  TESS_CHECK(ahead < 64, element_text(element), " contributes to round ", number,
             ", but it has not contributed to round ", state.next_reduction,
             ": it may be ahead by 63 rounds; await a result before more are started");
  TESS_CHECK(ahead >= 0 && (state.ahead >> ahead & 1U) == 0, element_text(element),
             " contributes to round ", number,
             " again, or before it joined: it has not contributed to round ", state.next_reduction,
             " yet; an inserted element joins at the round that insert(tess::RoundId{…}, …) names");
  const std::uint32_t before = state.next_reduction;
  state.ahead |= std::uint64_t{1} << ahead;
  for (; (state.ahead & 1U) != 0; state.ahead >>= 1U) ++state.next_reduction;
  if (state.next_reduction == before) return;
  reductions_.leave(before);
  reductions_.enter(state.next_reduction);
}

void Collection::contribute(Element& element, std::unique_ptr<Partial> value,
                            std::optional<RoundId> round) {
  if (ended_) return;  // its coroutine outlives the array: nothing waits for a result
  require_not_destroyed(element, " contributes in its destructor: contribute before destroy()");
  const Cause cause = cause_of(element);
  const std::int64_t number = round ? round->number : element.state_.next_reduction;
  Newcomer newcomer;
  const bool unawaited = is_unawaited(element, cause);
  if (unawaited || element.state_.created_after != 0)
    newcomer = {element.state_.created_after, element_text(element), unawaited && !round};
  if (unawaited && element.state_.seen_broadcast == element.state_.created_after)
    reductions_.refuse_unawaited(newcomer.element, number);
  settle_join(element);
  claim(element, number);
  reductions_.gather(static_cast<std::uint32_t>(number), pe_.context().epoch, std::move(value),
                     cause, std::move(newcomer), round.has_value());
}

std::string Collection::elements_before(std::uint32_t number) const {
  FirstFew missing;
  for (const Element* element : elements_)
    if (element != nullptr && element->state_.next_reduction < number)
      missing.add([element] { return element_text(*element); });
  return missing.text();
}

std::pair<bool, bool> Collection::has_nothing_to_reduce() const {
  return {n_local() == 0 && broadcasts_.applied() != 0, sections_ && sections_->any_empty()};
}

void Collection::describe_waiting(std::vector<std::string>& lines) const {
  reductions_.describe_waiting(lines);
  if (second_tree_ != nullptr) second_tree_->describe_waiting(lines);
  if (sections_) sections_->describe_waiting(lines);
  balanced_.describe_waiting(elements_, lines);
}

LoadRecord* ElementScope::load_of(Pe& pe, Element& element) {
  if (!element.balance_ && !pe.measuring().measures_elements()) return nullptr;
  return &BalancedElements::make_record(element).load;
}

void Collection::end() {
  ended_ = true;
  if (sections_) sections_->end_all();
  balanced_.collection_ends();
  for (Element* element : elements_) {
    if (element->n_suspended_ != 0) element->destroy_requested_ = true;
    BalancedElements::ends(pe_, *element);
  }
  broadcasts_.end();
  reductions_.end();
  if (second_tree_ != nullptr) second_tree_->end();
  scans_.reset();
}

void Collection::at_sync(Element& element) {
  if (ended_) return;  // no round resumes it: it ends once its coroutine is done
  require_not_destroyed(element, " calls at_sync() in its destructor, and nothing resumes it");
  balanced_.at_sync(element);
}

void Collection::move(Element& element, PeId to) {
  element.migrate_to_ = to;
  settle(element);
}

void Collection::settle_later(Element& element) {
  hold(element);
  const Context& context = pe_.context();
  pe_.run_next(make_message_in<&run_settling>(pe_, context.epoch,
                                              Settling{&element, context.led_by, context.led_in}));
}

void Collection::resume(Element& element) {
  TESS_CHECK(false, element_text(element), " has no resume_from_sync()");
}

std::int64_t Collection::rank_of(const Element& element) const {
  return element.collection_ == this ? pe_.id().value : -1;  // an array has indices instead
}

std::uint64_t Collection::key_of(const Element& /*element*/) const {
  return 0;
}

std::optional<std::array<double, 3>> Collection::position_of(const Element& /*element*/) const {
  return std::nullopt;
}

std::string Collection::state_of(const Element& /*element*/) const {
  return {};
}

std::uint64_t Collection::packed_bytes(Element& /*element*/) const {
  return 0;
}

void ElementScope::force_migration() {
  if (!element_.collection_->migratable()) return;
  const Collection& of = *element_.collection_;
  const std::uint64_t key = mix(of.id().value) ^ of.key_of(element_);
  const PeId to = pe_.forced_migrations().next({element_, key, pe_.id(), context_.action});
  if (to != pe_.id() && element_.migrate_to_.value < 0) element_.migrate_to_ = to;
}

Collection& add_collection(Pe& pe, const CollectionKind& kind, CollectionId id, const Range& range,
                           const std::shared_ptr<const IndexMap>& map) {
  auto made = kind.make(pe, id, range);
  Collection& collection = *made;
  collection.set_index_map(map);
  pe.collections().add(std::move(made));
  return collection;
}

void refuse_empty_proxy(std::string_view use) {
  check_failed("the proxy names a collection", __FILE__, __LINE__,
               text(use, " an empty proxy: assign what create() returned to it first"));
}

void refuse_absent(CollectionId id, std::string_view what, std::string_view or_else) {
  if (id == CollectionId{}) refuse_empty_proxy("a use of");
  Pe& pe = current_pe();
  const std::string why = pe.collections().ended(id)
                              ? text(what, " was destroyed on ", pe.id())
                              : text(what, " is not known yet on ", pe.id(),
                                     ": create it inside an awaited epoch", or_else);
  check_failed("the proxy's elements are known here", __FILE__, __LINE__, why);
}

}  // namespace tess::detail
