// Migration and destruction of elements: the messages between an element's old PE, its new PE and
// its home.
#pragma once

#include "runtime/arrays/ending.hpp"
#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/arrival.hpp"

#include <memory>
#include <span>
#include <string>

namespace tess::detail {

template <class Index>
void ArrayOf<Index>::depart(Indexed& element, PeId to) {
  const Index index = element.index_;
  unlist(element);
  ++n_departures_;
  balanced().departs(element);
  const Version version{element.state_.version.incarnation, element.state_.version.epoch + 1};
  element.state_.version = version;
  table_.at(index).set(home(index) == pe_.id() ? IndexState::moving : IndexState::departed, to,
                       version);
  broadcasts().left(element.state_.seen_broadcast);
  ++pe_.statistics().migrations;
  ship(element, to, leave_sections(element));
  reductions().advance();
}

template <class Index>
void ArrayOf<Index>::ship(Indexed& element, PeId to, Memberships&& memberships) {
  const ArrivalAction* action = arrival_action();
  TESS_CHECK(action != nullptr, name(),
             " cannot migrate: it needs a default constructor and a public serialize()");
  auto* arrival = pe_.stamp(new Arrival<Index>());
  pe_.count(*arrival);
  arrival->action = action;
  arrival->collection = id();
  arrival->from = pe_.id();
  arrival->element = &element;
  arrival->memberships = std::move(memberships);
#ifdef TESS_CHECKS_ALL
  // Within a process the element is also rebuilt from its bytes, so members that serialize()
  // omits are lost on one PE as they are on a cluster.
  try {
    arrival->pack_state();
  } catch (...) {
    Arrival<Index>::destroy(arrival);
    throw;
  }
#endif
  pe_.send(to, arrival);
}

template <class Index>
auto ArrayOf<Index>::construct_again(const Index& index) -> Indexed* {
  const Nesting::Construction construction(pe_.nesting(), &index, this);
  Indexed* const element = construct_default();
  // The first construction has already done what the constructor asks for.
  drop_after_construction();
  element->migrate_to_ = PeId{-1};
  element->destroy_requested_ = false;
  return element;
}

template <class Index>
void ArrayOf<Index>::take_in(Arrival<Index>& arrival) {
  if (arrival.element == nullptr) {
    const std::span<const std::byte> state(arrival.state.data(), arrival.state.size());
    Reader ar(state);
    const auto index = ar.template take<Index>();
    arrival.element = construct_again(index);
    ar(arrival.element->state_);
    BalancedElements::unpack_record(*arrival.element, ar);
    [[maybe_unused]] const auto sent = state.last(ar.remaining());
    read_all_members(*arrival.element, ar);
#ifdef TESS_CHECKS_ALL
    const std::string difference = difference_from(sent, *arrival.element);
    TESS_CHECK(difference.empty(), index_text(index), " of ", difference);
#endif
  }
  add_arrived(std::exchange(arrival.element, nullptr), arrival.from,
              std::move(arrival.memberships));
}

template <class Index>
std::uint64_t ArrayOf<Index>::drop_arrival(Pe& pe, Envelope& envelope) {
  auto& arrival = static_cast<Arrival<Index>&>(envelope);
  const Counted counted(pe.completion(), arrival.epoch);
  if (arrival.element != nullptr) {
    BalancedElements::ends(pe, *arrival.element);
  } else {
    Reader ar(std::span<const std::byte>(arrival.state.data(), arrival.state.size()));
    (void)ar.template take<Index>();
    BalancedElements::drop_record(pe, ar);
  }
  tess::detail::drop(pe, arrival.memberships);
  if (arrival.element == nullptr) return 0;
  // The part of the array that the element left may have been freed, but its destructor may call
  // array().
  const auto& action = static_cast<const ArrivalAction&>(*arrival.action);
  const std::unique_ptr<Collection> gone = action.kind.make(pe, arrival.collection, Range{});
  arrival.element->collection_ = gone.get();
  delete std::exchange(arrival.element, nullptr);
  return 0;
}

template <class Index>
std::uint64_t ArrayOf<Index>::packed_bytes(Element& element) const {
  const ArrivalAction* action = arrival_action();
  return action == nullptr ? 0 : n_bytes_of(element, action->pack_element);
}

template <class Index>
void ArrayOf<Index>::add_arrived(Indexed* element, PeId from, Memberships&& memberships) {
  const Index index = element->index_;
  const std::uint64_t seen = element->state_.seen_broadcast;
  const Version version = element->state_.version;
  table_.at(index).set_here(*element);
  balanced().arrives(*element);
  list(*element);
  enter_sections(*element, std::move(memberships));
  // It stays until it has received the broadcasts that it missed: only then has it arrived.
  hold(*element);
  for (const NumberedCall& call : broadcasts().missed(seen)) {
    if (is_over(*element) || pe_.stopped()) break;
    pe_.begins(&call.call->action());
    this->call(*element, call);
    // The epoch of the call that requests the next migration waits for it.
    if (element->migrate_to_.value >= 0) pe_.context().epoch = call.epoch;
  }
  const MoveReport report{index, Place{pe_.id(), version}, from, seen};
  if (home(index) == pe_.id()) {
    on_move_report(report);
  } else {
    send_to_collection<&move_report_arrives, Traffic::location>(*this, home(index), report);
  }
  release(*element);
  settle(*element);
}

template <class Index>
void ArrayOf<Index>::on_move_report(const MoveReport& report) {
  send_to_collection<&move_noted_arrives, Traffic::location>(
      *this, report.from, MoveNoted{report.index, report.place.version, report.seen});
  if (report.place.pe != pe_.id()) {
    Record& record = table_.at(report.index);
    if (record.state() == IndexState::here) return;  // it has returned home since
    const bool newer = record.state() == IndexState::destroyed
                           ? report.place.version.incarnation > record.version().incarnation
                           : report.place.version >= record.version();
    if (!newer) return;
    record.set(IndexState::live, report.place.pe, report.place.version);
  }
  reroute(unpark(report.index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_move_noted(const MoveNoted& noted) {
  if (Record* record = table_.find(noted.index); record != nullptr &&
                                                 record->state() == IndexState::departed &&
                                                 record->version() == noted.version) {
    record->confirm();
    ++n_hints_;
  }
  broadcasts().arrived(noted.seen);
}

template <class Index>
ArrayOf<Index>::~ArrayOf() = default;

template <class Index>
void ArrayOf<Index>::destroy_all() {
  table_.for_each([this](const Index& /*index*/, const Record& record) {
    if (record.element() != nullptr) destroy(*record.element());
  });
  for (Messages* messages : {&pending_, &waiting_, &destroyed_})
    for (auto& [index, parked] : *messages)
      for (CallMessage* message : parked) discard(message);
}

template <class Index>
void ArrayOf<Index>::end() {
  Collection::end();
  const auto drop = [this](const auto& messages) {
    for (CallMessage* message : messages) dead_letter(message);
  };
  for (Messages* messages : {&pending_, &waiting_, &destroyed_}) {
    for (const auto& [index, parked] : *messages) drop(parked);
    messages->clear();
  }
  std::vector<Indexed*> ready;
  table_.for_each([&ready](const Index& /*index*/, const Record& record) {
    if (record.element() != nullptr && record.element()->n_suspended_ == 0)
      ready.push_back(record.element());
  });
  for (Indexed* element : ready) end_element(*element);
}

/// Destroys an element of an array that has ended.
template <class Index>
void ArrayOf<Index>::end_element(Indexed& element) {
  unlist(element);
  ++n_departures_;
  table_.at(element.index_).set_unknown();
  counts_no_more(element);
  destroy(element);
}

template <class Index>
void ArrayOf<Index>::destroy_here(Indexed& element) {
  if (ended()) {
    end_element(element);
    if (n_local() == 0) free_later(*this);
    return;
  }
  require_no_gap(element);
  const Index index = element.index_;
  const Version version = element.state_.version;
  const std::uint32_t next = element.state_.next_reduction;
  unlist(element);
  ++n_departures_;
  BalancedElements::ends(pe_, element);
  end_memberships(element);
  balanced().destroyed(element);
  // The destructor may send to its own index or insert there again.
  const bool is_home = home(index) == pe_.id();
  if (is_home) {
    table_.at(index).set(IndexState::destroyed, pe_.id(), version);
  } else {
    table_.at(index).set_unknown();
    ++n_unconfirmed_[index];
    table_.at(index).park(Parked::destroyed);
  }
  counts_no_more(element);
  ++n_destroyed_;
  last_destroyed_ = index;
  destroy(element);
  reductions().remove_member(next);
  reductions().advance();
  if (is_home) return;
  send_to_collection<&destroy_report_arrives, Traffic::location>(
      *this, home(index), DestroyReport{index, version, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_destroy_report(const DestroyReport& report) {
  // This is the last incarnation that the home knows: it grants the next only after this report.
  table_.at(report.index).set(IndexState::destroyed, report.from, report.version);
  send_to_collection<&destroy_noted_arrives, Traffic::location>(*this, report.from,
                                                                DestroyNoted{report.index});
  reroute(unpark(report.index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_destroy_noted(const DestroyNoted& noted) {
  const auto n_destroyed = n_unconfirmed_.find(noted.index);
  if (--n_destroyed->second != 0) return;
  n_unconfirmed_.erase(n_destroyed);
  reroute(unpark(noted.index, Parked::destroyed));
  table_.tidy(noted.index);
}

}  // namespace tess::detail
