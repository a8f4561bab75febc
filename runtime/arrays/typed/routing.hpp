// Routing of messages to elements: forwarding, the home's decisions, and creation on demand.
#pragma once

#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/core/algorithm.hpp"

namespace tess::detail {

template <class Index>
ArrayOf<Index>::ArrayOf(Pe& pe, CollectionId id, std::string name, const Range& range)
    : Collection(pe, id, std::move(name), range), block_map_(range, pe.n_pes()), table_(range) {}

template <class Index>
void ArrayOf<Index>::run_message(Pe& pe, Envelope* envelope) {
  auto* message = static_cast<CallMessage*>(envelope);
  Collection* collection = find_collection(pe, message->collection);
  if (collection == nullptr) [[unlikely]] {
    pe.collections().keep_early(message->collection, envelope, &drop_message);
    return;
  }
  static_cast<ArrayOf*>(collection)->arrive(message);
}

template <class Index>
std::uint64_t ArrayOf<Index>::drop_message(Pe& pe, Envelope& envelope) {
  const Counted counted(pe.completion(), envelope.epoch);
  const auto& action = static_cast<const ElementAction<Index>&>(*envelope.action);
  if (action.undelivered != nullptr)
    action.undelivered(pe, static_cast<ElementMessage<Index>&>(envelope));
  return action.n_dead_letters();
}

template <class Index>
void ArrayOf<Index>::add_constructed(Indexed& element, const Index& index, Version version,
                                     std::uint32_t joins) {
  element.state_.version = version;
  register_new(element, joins);
  if (!makes_initial_ && joins == 0) element.state_.inserted_in = pe_.context().epoch;
  table_.at(index).set_here(element);
  list(element);
  if (element.migrate_to_.value >= 0 || element.destroy_requested_) [[unlikely]]
    after_construction([this, &element] { settle(element); });  // its constructor requested it
  if (has_after_construction() && !makes_initial_) [[unlikely]]
    run_after_construction();
}

template <class Index>
void ArrayOf<Index>::refuse_insertion(CallMessage* message) {
  TESS_CHECK(message->demand == Demand::insert_if_absent, name(), index_text(message->index),
             " is inserted, but it exists already on ", pe_.id(),
             "; insert_if_absent() allows for that");
  discard(message);
}

template <class Index>
void ArrayOf<Index>::forward(CallMessage* message, const Place& place) {
  message->tried = place.version;
  message->ask = false;
  if (message->source != pe_.id()) {
    ++pe_.statistics().forwards;
    if (message->hops < 255) ++message->hops;
    send_to_collection<&hint_arrives, Traffic::location>(*this, message->source,
                                                         LocationUpdate{message->index, place});
  }
  pe_.send(place.pe, message);
}

template <class Index>
void ArrayOf<Index>::park(CallMessage* message, Parked why) {
  table_.at(message->index).park(why);
  if (may_be_unwanted(*message)) ++n_purposeful_;
  parked(why)[message->index].push_back(message);
}

template <class Index>
auto ArrayOf<Index>::unpark(const Index& index, Parked why) -> std::vector<CallMessage*> {
  Record* record = table_.find(index);
  if (record == nullptr || !record->parks(why)) return {};
  record->unpark(why);
  Messages& messages = parked(why);
  const auto at = messages.find(index);
  if (at == messages.end()) return {};  // no message arrived after the destruction
  std::vector<CallMessage*> out = std::move(at->second);
  messages.erase(at);
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

/// `record` is this PE's knowledge of the index, or null.
template <class Index>
void ArrayOf<Index>::route(CallMessage* message, Record* record) {
  if (pe_.nesting().constructed_index() != nullptr) [[unlikely]] {
    // A constructor sent it: its element may be constructed next, or may be the sender.
    arrive_later(message);
    return;
  }
  if (record != nullptr && record->parks_any()) {
    for (const Parked why : {Parked::pending, Parked::destroyed}) {
      if (!record->parks(why)) continue;
      park(message, why);
      return;
    }
  }
  const PeId at = home(message->index);
  if (at == pe_.id()) {
    at_home(message, record);
    return;
  }
  if (record != nullptr && record->state() != IndexState::unknown &&
      record->version() > message->tried) {
    if (message->hops < most_hops) {
      forward(message, Place{record->pe(), record->version()});
      return;
    }
    // The home keeps the message until it learns of that place; before, it would send it back here.
    message->tried = record->version();
    message->ask = false;
  }
  if (message->ask) {
    ask(message);
  } else {
    pe_.send(at, message);
  }
}

template <class Index>
void ArrayOf<Index>::at_home(CallMessage* message, const Record* record) {
  const Index index = message->index;
  const IndexState state = record == nullptr ? IndexState::unknown : record->state();
  if (state == IndexState::live || state == IndexState::moving) {
    if (record->version() > message->tried ||
        (record->version() == message->tried && state == IndexState::live)) {
      forward(message, Place{record->pe(), record->version()});
    } else {
      park(message, Parked::waiting);
    }
    return;
  }
  const bool destroyed = state == IndexState::destroyed;
  const Version last = destroyed ? record->version() : Version{};
  if (message->tried.incarnation > last.incarnation) {
    park(message, Parked::waiting);  // it refers to an incarnation that this home does not know yet
    return;
  }
  if (message->demand == Demand::member) {
    if (destroyed || unwanted(*message)) {
      dead_letter(message);
    } else {
      park(message, Parked::waiting);
    }
    return;
  }
  const bool revives =
      message->demand == Demand::none && destroyed && dead_letters() == DeadLetters::recreate;
  if (message->demand == Demand::home || revives) {
    grant(index, Version{last.incarnation + 1, 1});
    arrive_later(message);
  } else if (message->demand == Demand::none) {
    if (!destroyed || dead_letters() == DeadLetters::wait) {
      park(message, Parked::waiting);
    } else {
      dead_letter(message);
    }
  } else if (message->asker == pe_.id()) {
    park(message, Parked::pending);
    grant(index, Version{last.incarnation + 1, 1});
  } else {
    message->ask = true;
    message->tried = last;  // so that a hint to the former incarnation is not followed
    pe_.send(message->asker, message);
  }
}

template <class Index>
void ArrayOf<Index>::dead_letter(CallMessage* message) {
  pe_.statistics().dead_letters += drop_message(pe_, *message);
  discard(message);
}

template <class Index>
void ArrayOf<Index>::drop_unwanted() {
  if (n_purposeful_ == 0) return;
  n_purposeful_ = 0;
  std::vector<Index> indices;
  for (const auto& [index, messages] : waiting_) {
    for (const auto* one : messages)
      if (may_be_unwanted(*one)) ++n_purposeful_;
    if (std::any_of(messages.begin(), messages.end(),
                    [this](const auto* one) { return unwanted(*one); }))
      indices.push_back(index);
  }
  // The others are parked again.
  for (const Index& index : indices) {
    reroute(unpark(index, Parked::waiting));
    table_.tidy(index);
  }
}

template <class Index>
void ArrayOf<Index>::ask(CallMessage* message) {
  const Index index = message->index;
  message->ask = false;
  park(message, Parked::pending);
  send_to_collection<&request_arrives, Traffic::location>(*this, home(index),
                                                          Request{index, pe_.id()});
}

template <class Index>
void ArrayOf<Index>::on_request(const Request& request) {
  const auto reply = [&](const Place& place) {
    send_to_collection<&location_update_arrives, Traffic::location>(
        *this, request.from, LocationUpdate{request.index, place});
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

/// Creates the element on this PE: with the first constructor call that waits for it, or by the
/// default constructor.
template <class Index>
void ArrayOf<Index>::grant(const Index& granted, Version version) {
  const Index index = granted;
  // Messages stay parked until the constructor has returned: if it throws, nothing is lost.
  CallMessage* insert = nullptr;
  Record& record = table_.at(index);
  record.set_unknown();
  if (record.parks(Parked::pending)) {
    for (CallMessage* message : pending_.at(index)) {
      const bool inserts =
          message->demand == Demand::insert || message->demand == Demand::insert_if_absent;
      if (insert == nullptr && inserts) insert = message;
    }
  }
  if (insert == nullptr) {
    construct(index, version, [this] { return construct_default(); });
  } else {
    const EpochId before = pe_.context().epoch;
    pe_.context().epoch = insert->epoch;
    const auto make = [insert] {
      return static_cast<Indexed*>(
          static_cast<const ElementAction<Index>&>(*insert->action).construct(*insert));
    };
    construct(index, version, make, insert->led_by);
    pe_.context().epoch = before;
  }
  std::vector<CallMessage*> messages = unpark(index, Parked::pending);
  if (insert != nullptr) {
    std::erase(messages, insert);
    const Counted counted(pe_.completion(), insert->epoch);
    discard(insert);
  }
  reroute(std::move(messages));
  reroute(unpark(index, Parked::waiting));
}

template <class Index>
void ArrayOf<Index>::on_location_update(const LocationUpdate& update) {
  learn(update.index, update.place);
  reroute(unpark(update.index, Parked::pending));
  table_.tidy(update.index);
}

template <class Index>
void ArrayOf<Index>::describe_waiting(std::vector<std::string>& lines) const {
  Collection::describe_waiting(lines);
  const auto say = [&](const Index& index, const std::vector<CallMessage*>& messages,
                       const char* what) {
    if (messages.empty()) return;
    const Action& action = *messages.front()->action;
    const std::string first = action.traffic == Traffic::control
                                  ? "of the runtime, as for a section with it"
                                  : plain_name(action.name());
    lines.push_back(text(messages.size(), messages.size() == 1 ? " message" : " messages", " (",
                         first, ") on ", pe_.id(), " to ", name(), index_text(index), ", ", what));
  };
  for (const auto& [index, messages] : waiting_) say(index, messages, "which does not exist");
  for (const auto& [index, messages] : pending_)
    say(index, messages, "whose creation was not answered");
  for (const auto& [index, messages] : destroyed_)
    say(index, messages, "whose destruction was not confirmed");
}

}  // namespace tess::detail
