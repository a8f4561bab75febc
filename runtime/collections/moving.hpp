// How an element moves and dies: what its old place, its new one and its home tell each other.
#pragma once

#include "runtime/collections/array_of.hpp"
#include "runtime/collections/ending.hpp"

namespace tess {

template <class Index>
void ArrayOf<Index>::depart(Indexed& element, PeId to) {
  const Index index = element.index_;
  unlist(element);
  ++n_departures_;
  count_departure(element);
  const Version version{element.state_.version.incarnation, element.state_.version.epoch + 1};
  element.state_.version = version;
  table_.at(index).set(home(index) == pe_.id() ? IndexState::moving : IndexState::departed, to,
                       version);
  broadcasts().left(element.state_.seen_broadcast);
  ++pe_.statistics().migrations;
  pe_.completion().sent(pe_.context().epoch);
  ship(element, to);
  reductions().advance();
}

template <class Index>
void ArrayOf<Index>::land(Indexed* element, PeId from) {
  const Index index = element->index_;
  const EpochId epoch = pe_.context().epoch;
  const std::uint64_t seen = element->state_.seen_broadcast;
  const Version version = element->state_.version;
  table_.at(index).set_here(*element);
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
  if (landed.place.pe != pe_.id()) {
    Record& record = table_.at(landed.index);
    if (record.state() == IndexState::here) return;  // it has come home since
    const bool newer = record.state() == IndexState::dead
                           ? landed.place.version.incarnation > record.version().incarnation
                           : landed.place.version >= record.version();
    if (!newer) return;
    record.set(IndexState::live, landed.place.pe, landed.place.version);
  }
  reroute(unpark(landed.index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_known(const Known& known) {
  if (Record* record = table_.find(known.index); record != nullptr &&
                                                 record->state() == IndexState::departed &&
                                                 record->version() == known.version) {
    record->confirm();
    ++n_hints_;
  }
  broadcasts().landed(known.seen);
}

template <class Index>
void ArrayOf<Index>::end() {
  Collection::end();
  const auto drop = [this](const auto& letters) {
    for (Letter* letter : letters) dead_letter(letter);
  };
  for (Letters* letters : {&pending_, &waiting_, &graves_}) {
    for (const auto& [index, parked] : *letters) drop(parked);
    letters->clear();
  }
  std::vector<Indexed*> ready;
  table_.for_each([&ready](const Index& /*index*/, const Record& record) {
    if (record.element() != nullptr && record.element()->n_suspended_ == 0)
      ready.push_back(record.element());
  });
  for (Indexed* element : ready) end_element(*element);
}

/// Ends an element of an array that has ended.
template <class Index>
void ArrayOf<Index>::end_element(Indexed& element) {
  unlist(element);
  ++n_departures_;
  table_.at(element.index_).set_unknown();
  destroy(element);
}

template <class Index>
void ArrayOf<Index>::bury(Indexed& element) {
  if (ended()) {
    end_element(element);
    if (n_local() == 0) free_later(*this);
    return;
  }
  const Index index = element.index_;
  const Version version = element.state_.version;
  const std::uint32_t next = element.state_.next_reduction;
  unlist(element);
  ++n_departures_;
  table_.at(index).set_unknown();
  end_wait(element);
  if (watcher() != nullptr) [[unlikely]]
    watcher()->died(element);
  destroy(element);
  reductions().died(next);
  reductions().advance();
  if (home(index) == pe_.id()) {
    table_.at(index).set(IndexState::dead, pe_.id(), version);
    return;
  }
  ++n_deaths_[index];
  table_.at(index).park(Parked::grave);
  send_to_collection<&died_arrives, Traffic::location>(*this, home(index),
                                                       Died{index, version, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_died(const Died& died) {
  // It is the last life that this home knows of: the home grants the next only once this has come.
  table_.at(died.index).set(IndexState::dead, died.from, died.version);
  send_to_collection<&buried_arrives, Traffic::location>(*this, died.from, Buried{died.index});
  reroute(unpark(died.index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_buried(const Buried& buried) {
  const auto n_deaths = n_deaths_.find(buried.index);
  if (--n_deaths->second != 0) return;
  n_deaths_.erase(n_deaths);
  reroute(unpark(buried.index, Parked::grave));
  table_.tidy(buried.index);
}

}  // namespace tess
