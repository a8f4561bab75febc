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
    send_to_collection<&hint_arrives, Traffic::location>(*this, letter->source,
                                                         Where{letter->index, place});
  }
  pe_.send(place.pe, letter);
}

template <class Index>
void ArrayOf<Index>::park(Letter* letter, Parked why) {
  table_.at(letter->index).park(why);
  parked(why)[letter->index].push_back(letter);
}

template <class Index>
auto ArrayOf<Index>::unpark(const Index& index, Parked why) -> std::vector<Letter*> {
  Record* record = table_.find(index);
  if (record == nullptr || !record->parks(why)) return {};
  record->unpark(why);
  Letters& letters = parked(why);
  const auto at = letters.find(index);
  if (at == letters.end()) return {};  // a grave to which no message came
  std::vector<Letter*> out = std::move(at->second);
  letters.erase(at);
  return out;
}

template <class Index>
void ArrayOf<Index>::learn(const Index& index, const Place& place) {
  if (place.pe == pe_.id() || home(index) == pe_.id()) return;
  const Record* known = table_.find(index);
  if (known == nullptr || known->state() == IndexState::unknown) {
    if (++n_hints_ > most_hints) {
      table_.forget_hints();
      n_hints_ = 1;
    }
  } else if (known->state() == IndexState::here || place.version <= known->version()) {
    return;
  }
  table_.at(index).set(IndexState::hint, place.pe, place.version);
}

/// `record`: what this PE knows of the index, or null.
template <class Index>
void ArrayOf<Index>::route(Letter* letter, Record* record) {
  if (pe_.constructed_index() != nullptr) [[unlikely]] {
    // A constructor sent it: it may be to an element that is made next, or to its own.
    arrive_later(letter);
    return;
  }
  if (record != nullptr && record->parks_any()) {
    for (const Parked why : {Parked::pending, Parked::grave}) {
      if (!record->parks(why)) continue;
      park(letter, why);
      return;
    }
  }
  const PeId at = home(letter->index);
  if (at == pe_.id()) {
    at_home(letter, record);
    return;
  }
  if (record != nullptr && record->state() != IndexState::unknown &&
      record->version() > letter->tried) {
    if (letter->hops < most_hops) {
      forward(letter, Place{record->pe(), record->version()});
      return;
    }
    // The home waits with it for news of that place: it would send it back here until then.
    letter->tried = record->version();
    letter->ask = false;
  }
  if (letter->ask) {
    ask(letter);
  } else {
    pe_.send(at, letter);
  }
}

template <class Index>
void ArrayOf<Index>::at_home(Letter* letter, const Record* record) {
  const Index index = letter->index;
  const IndexState state = record == nullptr ? IndexState::unknown : record->state();
  if (state == IndexState::live || state == IndexState::moving) {
    if (record->version() > letter->tried ||
        (record->version() == letter->tried && state == IndexState::live)) {
      forward(letter, Place{record->pe(), record->version()});
    } else {
      park(letter, Parked::waiting);
    }
    return;
  }
  const bool died = state == IndexState::dead;
  const Version last = died ? record->version() : Version{};
  if (letter->tried.incarnation > last.incarnation) {
    park(letter, Parked::waiting);  // it knows a life that this home has yet to hear of
    return;
  }
  const bool revives =
      letter->demand == Demand::none && died && dead_letters() == DeadLetters::recreate;
  if (letter->demand == Demand::home || revives) {
    grant(index, Version{last.incarnation + 1, 1});
    arrive_later(letter);
  } else if (letter->demand == Demand::none) {
    if (!died || dead_letters() == DeadLetters::wait) {
      park(letter, Parked::waiting);
    } else {
      dead_letter(letter);
    }
  } else if (letter->asker == pe_.id()) {
    park(letter, Parked::pending);
    grant(index, Version{last.incarnation + 1, 1});
  } else {
    letter->ask = true;
    letter->tried = last;  // not to be misled by a hint to the life that is over
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
  park(letter, Parked::pending);
  send_to_collection<&request_arrives, Traffic::location>(*this, home(index),
                                                          Request{index, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_request(const Request& request) {
  const auto reply = [&](const Place& place) {
    send_to_collection<&where_arrives, Traffic::location>(*this, request.from,
                                                          Where{request.index, place});
  };
  Record& record = table_.at(request.index);
  if (record.state() == IndexState::here) {
    reply(Place{pe_.id(), record.element()->state_.version});
    return;
  }
  if (record.state() == IndexState::live || record.state() == IndexState::moving) {
    reply(Place{record.pe(), record.version()});
    return;
  }
  const Version version{record.version().incarnation + 1, 1};
  record.set(IndexState::live, request.from, version);
  send_to_collection<&grant_arrives, Traffic::location>(*this, request.from,
                                                        Grant{request.index, version});
  reroute(unpark(request.index, Parked::waiting));
}

/// This PE creates the element now: with the first constructor call that waits for it, or by
/// default.
template <class Index>
void ArrayOf<Index>::grant(const Index& granted, Version version) {
  const Index index = granted;
  // What waits stays parked until the constructor is through: if it throws, nothing is lost.
  Letter* insert = nullptr;
  Record& record = table_.at(index);
  record.set_unknown();
  if (record.parks(Parked::pending)) {
    for (Letter* letter : pending_.at(index)) {
      const bool inserts =
          letter->demand == Demand::insert || letter->demand == Demand::insert_if_absent;
      if (insert == nullptr && inserts) insert = letter;
    }
  }
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
  std::vector<Letter*> letters = unpark(index, Parked::pending);
  if (insert != nullptr) {
    std::erase(letters, insert);
    const EpochId epoch = insert->epoch;
    discard(insert);
    pe_.completion().processed(epoch);
  }
  reroute(std::move(letters));
  reroute(unpark(index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_where(const Where& where) {
  learn(where.index, where.place);
  reroute(unpark(where.index, Parked::pending));
  table_.tidy(where.index);
}

template <class Index>
void ArrayOf<Index>::describe_waiting(std::vector<std::string>& lines) const {
  Collection::describe_waiting(lines);
  const auto say = [&](const Index& index, const std::vector<Letter*>& letters, const char* what) {
    if (letters.empty()) return;
    lines.push_back(text(letters.size(), letters.size() == 1 ? " message" : " messages", " (",
                         plain_name(letters.front()->action->name()), ") on ", pe_.id(), " to ",
                         name(), index_text(index), ", ", what));
  };
  for (const auto& [index, letters] : waiting_) say(index, letters, "which does not exist");
  for (const auto& [index, letters] : pending_)
    say(index, letters, "whose creation was not answered");
  for (const auto& [index, letters] : graves_) say(index, letters, "whose death was not noted");
}

}  // namespace tess
