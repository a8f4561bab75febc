// How an element moves and dies: what its old place, its new one and its home tell each other.
#pragma once

#include "runtime/collections/array_of.hpp"
#include "runtime/collections/ending.hpp"

namespace tess {

template <class Index>
void ArrayOf<Index>::depart(Indexed& element, PeId to) {
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
void ArrayOf<Index>::land(Indexed* element, PeId from) {
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
void ArrayOf<Index>::end() {
  Collection::end();
  const auto drop = [this](const auto& letters) {
    for (Letter* letter : letters) dead_letter(letter);
  };
  for (const auto& [index, pending] : pending_) drop(pending.letters);
  for (const auto& [index, grave] : graves_) drop(grave.letters);
  for (const auto& [index, letters] : registry_.waiting()) drop(letters);
  pending_.clear();
  graves_.clear();
  registry_.clear_waiting();
  std::vector<Indexed*> ready;
  for (const auto& [index, element] : here_)
    if (element->n_suspended_ == 0) ready.push_back(element);
  for (Indexed* element : ready) end_element(*element);
}

/// Ends an element of an array that has ended.
template <class Index>
void ArrayOf<Index>::end_element(Indexed& element) {
  unlist(element);
  here_.erase(element.index_);
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
  here_.erase(index);
  end_wait(element);
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

}  // namespace tess
