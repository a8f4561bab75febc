// How a message finds its element: where it goes from a PE that does not have it, what the home
// does with it, and creation on demand.
#pragma once

#include "runtime/collections/array_of.hpp"

namespace tess {

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
  if (const auto left = departed_.find(index);
      left != departed_.end() && left->second.version > letter->tried) {
    if (letter->hops < most_hops || at == pe_.id()) {
      forward(letter, left->second);
    } else {
      // The home waits with it for the landing: it would send it back here until then.
      letter->tried = left->second.version;
      letter->ask = false;
      pe_.send(at, letter);
    }
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
  pe_.statistics().dead_letters +=
      static_cast<const ElementAction<Index>&>(*letter->action).n_dead_letters();
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
  if (const Indexed* element = find(request.index); element != nullptr) {
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
      return static_cast<Indexed*>(
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
