// The scenario all_at_once: a citizen, which uses all means of control. In each step of a phase it
// draws one of them: it asks others, conducts a section of its own, opens an epoch, sets timers or
// sends tokens; between two steps it may migrate. It checks each reply against what the function
// would return, and counts the tokens that reach it.
#pragma once

#include "apps/protocol_fuzz/city_life.hpp"
#include "runtime/when.hpp"

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace tess::fuzz::city_life {

struct Prices {
  std::vector<std::uint64_t> each;
};
struct Orders {
  std::int32_t phase = 0;
  std::int32_t n_left = 0;  // steps
  std::int32_t n_singers = 0;
  ArrayProxy<Singer> singers;
  ArrayProxy<Spot> spots;
  ChareProxy<Mayor> mayor;
  GroupProxy<Office> offices;
  ProcessGroupProxy<Treasury> treasuries;
  ReadOnly<Prices> prices;
  Callback<std::vector<std::int32_t>> began;
};
struct Note {
  std::int32_t phase = 0;
  std::uint64_t token = 0;
};
struct Hop {
  std::uint64_t epoch = 0;
  std::int32_t n_left = 0;
};

class Citizen : public Chare<Citizen, Index1>, public Resident {
 public:
  void add(std::uint64_t token) override { count_.note(token); }
  [[nodiscard]] std::uint64_t age(std::uint64_t question) override {
    return answer_of(question, index().x);
  }
  void add_soon(std::uint64_t token) { add(token); }
  void add_inline(std::uint64_t token) { add(token); }
  void receive(Note note) { notes_.put(note); }

  [[nodiscard]] std::uint64_t value(std::uint64_t question) {
    add(question);
    if (refuses(question)) fail(ErrorCode::bad_value, "refused ", question);
    return answer_of(question, index().x);
  }
  /// A coroutine that asks others before it replies.
  Task pass_on(std::uint64_t question, int depth) {
    add(question);
    Random random(mix(question));
    if (depth > 0) {
      const std::uint64_t other = token(random);
      co_await any(random).ask<&Citizen::pass_on>(other, depth - 1);
    } else if (refuses(question)) {
      fail(ErrorCode::bad_value, "refused ", question);
    }
  }
  void hop(Hop hop) {
    {
      const std::lock_guard lock(city->mutex);
      ++city->hops[hop.epoch];
    }
    Random random(mix(hop.epoch ^ static_cast<std::uint64_t>(hop.n_left)));
    if (random.chance(city->move_chance)) migrate_to(any_pe(random));
    if (--hop.n_left == 0) return;
    switch (random.below(3)) {
      case 0:
        any(random).send<&Citizen::hop>(hop);
        break;
      case 1:
        any(random).with(expedited).send<&Citizen::hop>(hop);
        break;
      default:
        any(random).send_after<&Citizen::hop>(delay(random), hop);
    }
  }
  /// A result of a section that has ended meanwhile, or not.
  void heard(Chorus chorus) {
    for (const auto& [index, nth] : chorus)
      expect(nth == chorus.front().second, "a late result of a section has mixed contributions");
  }

  /// One step, then a message to itself with the next: between them it may migrate.
  Task live(Orders orders) {
    Random random(mix(city->seed ^ static_cast<std::uint64_t>(
                                       (orders.phase * 100 + orders.n_left) * 1000 + index().x)));
    if (orders.n_left == city->n_steps) {
      contribute(in_order(concatenate), std::vector<std::int32_t>{index().x}, orders.began);
      contribute(exclusive_scan(sum, std::int64_t{orders.phase}), std::int64_t{index().x},
                 self().target<&Citizen::ranked>());
      phase_ = orders.phase;
      const Note note{orders.phase, token(random)};
      array()[{(index().x + 1) % city->n_citizens}].send<&Citizen::receive>(note);
    }
    if (orders.n_left == 0) {
      const Note note = co_await notes_.take(orders.phase);
      add(note.token);
      co_return;
    }
    switch (random.below(10)) {
      case 0:
        co_await ask_others(random);
        break;
      case 7:
        co_await call_residents(orders, random);
        break;
      case 1:
        co_await ask_coroutines(random);
        break;
      case 2:
        co_await ask_several(random);
        break;
      case 3:
        co_await ask_mortals(orders, random);
        break;
      case 4:
        co_await conduct(orders, random);
        break;
      case 5:
        co_await open_epoch(random);
        break;
      case 6:
        set_timers(random);
        break;
      default:
        send_tokens(orders, random);
    }
    if (random.chance(city->move_chance)) migrate_to(any_pe(random));
    --orders.n_left;
    if (random.chance(0.2)) {
      self().with(Priority{draw(random, 9) - 4}).send<&Citizen::live>(orders);
    } else {
      self().send<&Citizen::live>(orders);
    }
  }
  /// The scan at the start of a phase.
  void ranked(std::int64_t before) {
    const std::int64_t me = index().x;
    expect(before == phase_ + me * (me - 1) / 2, "citizen ", me, " gets ", before,
           " from the scan of phase ", phase_);
    ++city->n_ranked;
  }
  void report(Callback<Count> target) { contribute(sum, count_, target); }

  using EntryAttributes = Attributes<EntryMethod<&Citizen::add_soon, Priority{-5}>,
                                     EntryMethod<&Citizen::add_inline, inline_when_local>>;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(count_, notes_, phase_);
  }

 private:
  [[nodiscard]] ElementProxy<Citizen> any(Random& random) const {
    return array()[{draw(random, city->n_citizens)}];
  }
  /// A citizen, or a singer that does not end.
  [[nodiscard]] InterfaceProxy<Resident> any_resident(const Orders& orders, Random& random) const {
    if (random.chance(0.5)) return any(random);
    return orders.singers[{3 * draw(random, (orders.n_singers + 2) / 3)}];
  }

  Task ask_others(Random& random) {
    const std::uint64_t question = token(random);
    const int to = draw(random, city->n_citizens);
    const bool hurries = random.chance(0.5);
    const Time limit = delay(random);
    std::uint64_t answer = 0;
    std::string error;
    try {
      auto ask = array()[{to}].ask<&Citizen::value>(question);
      if (hurries) {
        answer = co_await std::move(ask).within(limit);
      } else {
        answer = co_await ask;
      }
    } catch (const Error& thrown) {
      error = thrown.what();
    }
    const bool late = hurries && error.find("did not come within") != std::string::npos;
    expect(late || (refuses(question) ? error == text("refused ", question)
                                      : answer == answer_of(question, to)),
           "a reply is wrong; ", error);
  }
  Task ask_coroutines(Random& random) {
    const std::uint64_t question = token(random);
    const int depth = draw(random, 3);
    std::uint64_t last = question;
    for (int i = 0; i < depth; ++i) last = Random(mix(last))();
    bool refused = false;
    try {
      co_await any(random).ask<&Citizen::pass_on>(question, depth);
    } catch (const Error& error) {
      refused = error.code() == ErrorCode::bad_value;
    }
    expect(refused == refuses(last), "a coroutine's error is lost or invented");
  }
  Task ask_several(Random& random) {
    const std::uint64_t first = token(random), second = token(random);
    const int a = draw(random, city->n_citizens), b = draw(random, city->n_citizens);
    bool refused = false;
    if (random.chance(0.5)) {
      try {
        const auto [of_a, of_b] = co_await when_all(array()[{a}].ask<&Citizen::value>(first),
                                                    array()[{b}].ask<&Citizen::value>(second));
        expect(of_a == answer_of(first, a) && of_b == answer_of(second, b),
               "when_all gives the values of other asks");
      } catch (const Error&) {
        refused = true;
      }
      expect(refused == (refuses(first) || refuses(second)), "when_all loses an error");
      co_return;
    }
    const Time limit = delay(random);
    const Time began = now();
    (void)array()[{b}].ask<&Citizen::value>(second);  // given up
    std::size_t which = 0;
    try {
      const auto one = co_await when_any(array()[{a}].ask<&Citizen::value>(first), sleep(limit));
      which = one.index();
      if (which == 0)
        expect(std::get<0>(one) == answer_of(first, a), "when_any gives another value");
    } catch (const Error&) {
      refused = true;
    }
    expect(which == 0 || now() >= began + limit, "when_any's time is over too early");
    expect(which != 0 || refused == refuses(first), "when_any loses an error");
  }
  Task ask_mortals(Orders& orders, Random& random) {
    const int to = draw(random, orders.n_singers);
    const std::uint64_t question = random();
    bool was_dead = false;
    for (int i = 0; i < 2; ++i) {
      bool is_dead = false;
      std::uint64_t answer = 0;
      try {
        if (i == 0 && Singer::is_mortal(to) && random.chance(city->end_chance))
          co_await orders.singers[{to}].ask<&Singer::end>();
        answer = co_await orders.singers[{to}].ask<&Singer::age>(question);
      } catch (const Error& error) {
        is_dead = std::string(error.what()).find("was destroyed") != std::string::npos;
      }
      expect(is_dead ? Singer::is_mortal(to) : !was_dead && answer == answer_of(question, to),
             "an element is neither asked nor dead, or lives again");
      was_dead = is_dead;
    }
  }
  Task call_residents(Orders& orders, Random& random) {
    const InterfaceProxy<Resident> one = any_resident(orders, random);
    one.send<&Resident::add>(token(random));
    any_resident(orders, random).with(expedited).send<&Resident::add>(token(random));
    any_resident(orders, random).send_after<&Resident::add>(delay(random), token(random));
    if (random.chance(0.3))
      InterfaceArray<Resident>(array()).broadcast<&Resident::add>(token(random, city->n_citizens));
    const std::uint64_t question = random();
    const std::uint64_t answer = co_await one.ask<&Resident::age>(question);
    expect(answer == answer_of(question, one.index().x), "an interface gives another answer");
  }
  /// A section of its own.
  Task conduct(Orders& orders, Random& random) {
    std::vector<Index1> members{{0}};
    for (int index = 1; index < orders.n_singers; ++index)
      if (random.chance(0.4)) members.push_back({index});
    const auto section = create_section(orders.singers, members);
    const int n = 1 + draw(random, 4);
    if (random.chance(0.3)) {  // it ends in mid-use
      ++city->n_cut;
      const Cue cue{section, self().target<&Citizen::heard>()};
      for (int i = 0; i < n; ++i) section.broadcast<&Singer::sing>(cue);
      if (random.chance(0.5)) co_await sleep(delay(random));
    } else {
      std::vector<Future<Chorus>> results(static_cast<std::size_t>(n));
      for (const auto& result : results)
        section.broadcast<&Singer::sing>(Cue{section, result.callback()});
      const std::vector<Chorus> choruses = co_await when_all(std::move(results));
      check_choruses(choruses, members);
    }
    section.destroy();
  }
  Task open_epoch(Random& random) {
    const Hop hop{random(), 1 + draw(random, 6)};
    const ElementProxy<Citizen> to = any(random);
    co_await epoch([&] { to.send<&Citizen::hop>(hop); });
    const std::lock_guard lock(city->mutex);
    expect(city->hops[hop.epoch] == hop.n_left, "an epoch ends after ", city->hops[hop.epoch],
           " of ", hop.n_left, " messages");
  }
  void set_timers(Random& random) {
    any(random).send_after<&Citizen::add>(delay(random), token(random));
    after(delay(random), any(random).target<&Citizen::add>(), token(random));
    // Cancelled before it can have run, since this code does not wait.
    any(random).send_after<&Citizen::add>(delay(random), random()).cancel();
  }
  void send_tokens(Orders& orders, Random& random) {
    const ElementProxy<Citizen> to = any(random);
    switch (random.below(4)) {
      case 0:
        to.send<&Citizen::add>(token(random));
        break;
      case 1:
        to.with(Priority{draw(random, 9) - 4}).send<&Citizen::add>(token(random));
        break;
      case 2:
        to.with(expedited).send<&Citizen::add>(token(random));
        break;
      default:
        to.send<&Citizen::add_soon>(token(random));
    }
    any(random).send<&Citizen::add_inline>(token(random));
    const auto spot = orders.spots[text("spot ", draw(random, 12))];
    if (random.chance(0.5)) {
      spot.send_or_create_here<&Spot::add>(token(random));
    } else {
      spot.with(expedited).send_or_create_home<&Spot::add>(token(random));
    }
    orders.mayor.send<&Mayor::add>(token(random));
    orders.offices[any_pe(random)].send<&Office::add>(token(random));
    const std::uint64_t coin = token(random);
    orders.treasuries.write([coin](Treasury& treasury) { treasury.add(coin); });
    const ProcessId process{draw(random, machine().n_processes())};
    orders.treasuries[process].send<&Treasury::add>(token(random));
    const auto at = static_cast<std::size_t>(draw(random, 10));
    expect(orders.prices->each.at(at) == mix(at), "read-only data is wrong");
    if (random.chance(city->move_chance)) orders.mayor.migrate_to(any_pe(random));
  }

  Count count_;
  Mailbox<&Note::phase> notes_;
  std::int32_t phase_ = 0;
};

}  // namespace tess::fuzz::city_life
