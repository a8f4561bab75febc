// The scenario all_at_once: an element that uses all means of control. In each step of a phase it
// draws one of them: it asks others, uses a section of its own, opens an epoch, sets timers or
// sends tokens; between two steps it may migrate. It checks each reply against what the function
// would return, and counts the tokens that reach it.
#pragma once

#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/all_at_once/collections.hpp"

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace tess::fuzz::all_kinds {

struct Table {
  std::vector<std::uint64_t> each;
};
struct Work {
  std::int32_t phase = 0;
  std::int32_t n_left = 0;  // steps
  std::int32_t n_elements = 0;
  ArrayProxy<SectionMember> elements;
  ArrayProxy<OnDemand> on_demand;
  ChareProxy<Single> single;
  GroupProxy<PerPe> per_pe;
  ProcessGroupProxy<PerProcess> per_process;
  ReadOnly<Table> table;
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

class Caller : public Chare<Caller, Index1>, public Addable {
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
      co_await any(random).ask<&Caller::pass_on>(other, depth - 1);
    } else if (refuses(question)) {
      fail(ErrorCode::bad_value, "refused ", question);
    }
  }
  void hop(Hop hop) {
    locked([&] { ++record->hops[hop.epoch]; });
    Random random(mix(hop.epoch ^ static_cast<std::uint64_t>(hop.n_left)));
    if (random.chance(record->move_chance)) migrate_to(any_pe(random));
    if (--hop.n_left == 0) return;
    switch (random.below(3)) {
      case 0:
        any(random).send<&Caller::hop>(hop);
        break;
      case 1:
        any(random).with(expedited).send<&Caller::hop>(hop);
        break;
      default:
        any(random).send_after<&Caller::hop>(delay(random), hop);
    }
  }
  /// A result of a section that has ended meanwhile, or not.
  void heard(SectionResult given) {
    for (const auto& [index, nth] : given)
      expect(nth == given.front().second, "a late result of a section has mixed contributions");
  }

  /// One step, then a message to itself with the next: between them it may migrate.
  Task step(Work work) {
    Random random(mix(record->seed ^ static_cast<std::uint64_t>(
                                         (work.phase * 100 + work.n_left) * 1000 + index().x)));
    if (work.n_left == record->n_steps) {
      contribute(in_order(concatenate), std::vector<std::int32_t>{index().x}, work.began);
      contribute(exclusive_scan(sum, std::int64_t{work.phase}), std::int64_t{index().x},
                 self().target<&Caller::ranked>());
      phase_ = work.phase;
      const Note note{work.phase, token(random)};
      array()[{(index().x + 1) % record->n_callers}].send<&Caller::receive>(note);
    }
    if (work.n_left == 0) {
      const Note note = co_await notes_.take(work.phase);
      add(note.token);
      co_return;
    }
    switch (random.below(10)) {
      case 0:
        co_await ask_others(random);
        break;
      case 7:
        co_await call_interface(work, random);
        break;
      case 1:
        co_await ask_coroutines(random);
        break;
      case 2:
        co_await ask_several(random);
        break;
      case 3:
        co_await ask_destroyable(work, random);
        break;
      case 4:
        co_await use_section(work, random);
        break;
      case 5:
        co_await open_epoch(random);
        break;
      case 6:
        set_timers(random);
        break;
      default:
        send_tokens(work, random);
    }
    if (random.chance(record->move_chance)) migrate_to(any_pe(random));
    --work.n_left;
    if (random.chance(0.2)) {
      self().with(Priority{draw(random, 9) - 4}).send<&Caller::step>(work);
    } else {
      self().send<&Caller::step>(work);
    }
  }
  /// The scan at the start of a phase.
  void ranked(std::int64_t before) {
    const std::int64_t me = index().x;
    expect(before == phase_ + me * (me - 1) / 2, "element ", me, " gets ", before,
           " from the scan of phase ", phase_);
    ++record->n_ranked;
  }
  void report(Callback<Count> target) { contribute(sum, count_, target); }

  using EntryAttributes = Attributes<EntryMethod<&Caller::add_soon, Priority{-5}>,
                                     EntryMethod<&Caller::add_inline, inline_when_local>>;
  void serialize(auto& ar) { ar(count_, notes_, phase_); }

 private:
  [[nodiscard]] ElementProxy<Caller> any(Random& random) const {
    return array()[{draw(random, record->n_callers)}];
  }
  /// A caller, or a member of sections that does not end.
  [[nodiscard]] InterfaceProxy<Addable> any_addable(const Work& work, Random& random) const {
    if (random.chance(0.5)) return any(random);
    return work.elements[{3 * draw(random, (work.n_elements + 2) / 3)}];
  }

  Task ask_others(Random& random) {
    const std::uint64_t question = token(random);
    const int to = draw(random, record->n_callers);
    const bool hurries = random.chance(0.5);
    const Time limit = delay(random);
    std::uint64_t answer = 0;
    std::string error;
    try {
      auto ask = array()[{to}].ask<&Caller::value>(question);
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
      co_await any(random).ask<&Caller::pass_on>(question, depth);
    } catch (const Error& error) {
      refused = error.code() == ErrorCode::bad_value;
    }
    expect(refused == refuses(last), "a coroutine's error is lost or invented");
  }
  Task ask_several(Random& random) {
    const std::uint64_t first = token(random), second = token(random);
    const int a = draw(random, record->n_callers), b = draw(random, record->n_callers);
    bool refused = false;
    if (random.chance(0.5)) {
      try {
        const auto [of_a, of_b] = co_await when_all(array()[{a}].ask<&Caller::value>(first),
                                                    array()[{b}].ask<&Caller::value>(second));
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
    (void)array()[{b}].ask<&Caller::value>(second);  // given up
    std::size_t which = 0;
    try {
      const auto one = co_await when_any(array()[{a}].ask<&Caller::value>(first), sleep(limit));
      which = one.index();
      if (which == 0)
        expect(std::get<0>(one) == answer_of(first, a), "when_any gives another value");
    } catch (const Error&) {
      refused = true;
    }
    expect(which == 0 || now() >= began + limit, "when_any's time is over too early");
    expect(which != 0 || refused == refuses(first), "when_any loses an error");
  }
  Task ask_destroyable(Work& work, Random& random) {
    const int to = draw(random, work.n_elements);
    const std::uint64_t question = random();
    bool was_dead = false;
    for (int i = 0; i < 2; ++i) {
      bool is_dead = false;
      std::uint64_t answer = 0;
      try {
        if (i == 0 && SectionMember::may_end(to) && random.chance(record->end_chance))
          co_await work.elements[{to}].ask<&SectionMember::end>();
        answer = co_await work.elements[{to}].ask<&SectionMember::age>(question);
      } catch (const Error& error) {
        is_dead = std::string(error.what()).find("was destroyed") != std::string::npos;
      }
      expect(is_dead ? SectionMember::may_end(to) : !was_dead && answer == answer_of(question, to),
             "an element is neither asked nor destroyed, or is there again");
      was_dead = is_dead;
    }
  }
  Task call_interface(Work& work, Random& random) {
    const InterfaceProxy<Addable> one = any_addable(work, random);
    one.send<&Addable::add>(token(random));
    any_addable(work, random).with(expedited).send<&Addable::add>(token(random));
    any_addable(work, random).send_after<&Addable::add>(delay(random), token(random));
    if (random.chance(0.3))
      InterfaceArray<Addable>(array()).broadcast<&Addable::add>(token(random, record->n_callers));
    const std::uint64_t question = random();
    const std::uint64_t answer = co_await one.ask<&Addable::age>(question);
    expect(answer == answer_of(question, one.index().x), "an interface gives another answer");
  }
  /// A section of its own.
  Task use_section(Work& work, Random& random) {
    std::vector<Index1> listed{{0}};
    for (int index = 1; index < work.n_elements; ++index)
      if (random.chance(0.4)) listed.push_back({index});
    const auto section = create_section(work.elements, listed);
    const int n = 1 + draw(random, 4);
    if (random.chance(0.3)) {  // it ends in mid-use
      ++record->n_cut;
      const Multicast multicast{section, self().target<&Caller::heard>()};
      for (int i = 0; i < n; ++i) section.broadcast<&SectionMember::give>(multicast);
      if (random.chance(0.5)) co_await sleep(delay(random));
    } else {
      std::vector<Future<SectionResult>> results(static_cast<std::size_t>(n));
      for (const auto& result : results)
        section.broadcast<&SectionMember::give>(Multicast{section, result.callback()});
      const std::vector<SectionResult> all_given = co_await when_all(std::move(results));
      check_results(all_given, listed);
    }
    section.destroy();
  }
  Task open_epoch(Random& random) {
    const Hop hop{random(), 1 + draw(random, 6)};
    const ElementProxy<Caller> to = any(random);
    co_await epoch([&] { to.send<&Caller::hop>(hop); });
    const std::lock_guard lock(oracle);
    expect(record->hops[hop.epoch] == hop.n_left, "an epoch ends after ", record->hops[hop.epoch],
           " of ", hop.n_left, " messages");
  }
  void set_timers(Random& random) {
    any(random).send_after<&Caller::add>(delay(random), token(random));
    after(delay(random), any(random).target<&Caller::add>(), token(random));
    // Cancelled before it can have run, since this code does not wait.
    any(random).send_after<&Caller::add>(delay(random), random()).cancel();
  }
  void send_tokens(Work& work, Random& random) {
    const ElementProxy<Caller> to = any(random);
    switch (random.below(4)) {
      case 0:
        to.send<&Caller::add>(token(random));
        break;
      case 1:
        to.with(Priority{draw(random, 9) - 4}).send<&Caller::add>(token(random));
        break;
      case 2:
        to.with(expedited).send<&Caller::add>(token(random));
        break;
      default:
        to.send<&Caller::add_soon>(token(random));
    }
    any(random).send<&Caller::add_inline>(token(random));
    const auto spot = work.on_demand[text("spot ", draw(random, 12))];
    if (random.chance(0.5)) {
      spot.send_or_create_here<&OnDemand::add>(token(random));
    } else {
      spot.with(expedited).send_or_create_home<&OnDemand::add>(token(random));
    }
    work.single.send<&Single::add>(token(random));
    work.per_pe[any_pe(random)].send<&PerPe::add>(token(random));
    const std::uint64_t drawn = token(random);
    work.per_process.write([drawn](PerProcess& its) { its.add(drawn); });
    const ProcessId process{draw(random, machine().n_processes())};
    work.per_process[process].send<&PerProcess::add>(token(random));
    const auto at = static_cast<std::size_t>(draw(random, 10));
    expect(work.table->each.at(at) == mix(at), "read-only data is wrong");
    if (random.chance(record->move_chance)) work.single.migrate_to(any_pe(random));
  }

  Count count_;
  Mailbox<&Note::phase> notes_;
  std::int32_t phase_ = 0;
};

}  // namespace tess::fuzz::all_kinds
