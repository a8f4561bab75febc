// Elements that call destroy(), or are destroyed by others, and wait after that: for messages in
// their mailbox (one, two, or one within a time), for replies and for epochs. Until its coroutine is
// done such a leaver lives: it gets messages, array broadcasts (some after a migration, which it
// began before) and multicasts, contributes and replies. Broadcasts have any priority.
//
// The oracle: a leaver receives each note once, a reduction has a contribution of every element,
// and after the epoch of the round the indices of the leavers are free for the next ones. It needs no
// common memory.
#include "runtime/more/section.hpp"
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <utility>

namespace tess::fuzz {
namespace {

/// What the seed says; the same on all processes.
struct WaitDraws {
  std::uint64_t seed = 0;
  int n_partners = 0, n_leavers = 0, n_rounds = 0;
  double move_chance = 0;

  [[nodiscard]] Random draws(int round, int index) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(round * 1000 + index))));
  }
  [[nodiscard]] std::uint64_t text(int round, int number) const {
    return mix(seed + mix(static_cast<std::uint64_t>(round * 1000 + number)));
  }
  [[nodiscard]] int n_elements() const { return n_partners + n_leavers; }
  /// True if a leaver gets a note that moves it, about when it leaves.
  [[nodiscard]] bool moves_meanwhile(int round, int leaver) const {
    return draws(round, 500 + leaver).chance(move_chance);
  }
};
const WaitDraws* wait_draws = nullptr;

struct Note {
  std::int32_t round = 0;
  std::uint64_t text = 0;
};
/// A note that a leaver asks a partner for.
struct Request {
  std::int32_t leaver = 0;
  Note note;
};

class WaitingElement;

struct Turn {
  std::int32_t round = 0;
  std::int32_t n_announced = 0, n_calls = 0;  // that each leaver, and each member, receives
  SectionProxy<WaitingElement> section;
  Callback<std::int32_t> left;  // each leaver says so once
};

class WaitingElement : public Chare<WaitingElement, Index1> {
 public:
  void receive(Note note) {
    if (is_leaver()) notes_.put(note);
  }
  void receive_and_move(Note note, PeId pe) {
    receive(note);
    migrate_to(pe);
  }
  /// A broadcast.
  void receive_and_count(Note announced, Callback<std::int32_t> n_heard) {
    receive(announced);
    contribute(sum, 1, std::move(n_heard));
    move(announced);
  }
  /// A multicast.
  void receive_in_section(SectionProxy<WaitingElement> section, Note call,
                          Callback<std::int32_t> n_heard) {
    receive(call);
    contribute(section, sum, 1, std::move(n_heard));
    move(call);
  }
  [[nodiscard]] std::uint64_t reply(std::uint64_t question) const {
    return mix(question + static_cast<std::uint64_t>(index().x));
  }

  // Of partners.

  void write(Request request) {
    array()[{request.leaver}].send<&WaitingElement::receive>(request.note);
    move(request.note);
  }
  Task write_after_reply(Request request) {
    const auto leaver = array()[{request.leaver}];
    const std::uint64_t reply = co_await leaver.ask<&WaitingElement::reply>(request.note.text);
    expect(reply == mix(request.note.text + static_cast<std::uint64_t>(request.leaver)), "leaver ",
           request.leaver, " has another reply");
    leaver.send<&WaitingElement::receive>(request.note);
  }
  /// Destroys the leaver, which waits for this note.
  Task write_after_end(Request request) {
    const auto leaver = array()[{request.leaver}];
    co_await epoch([&] { leaver.destroy(); });
    leaver.send<&WaitingElement::receive>(request.note);
  }

  /// A leaver's: it ends with it.
  Task leave(Turn turn) {
    if (!is_leaver()) co_return;
    Random random = wait_draws->draws(turn.round, index().x);
    const auto end = random.below(3);
    if (end == 0) destroy();
    std::uint64_t want = 0;
    for (int n = 0; n < turn.n_announced; ++n) want += wait_draws->text(turn.round, n);
    int n_left = turn.n_announced;
    if (turn.n_calls > 0 && is_member(turn.round, index().x)) {
      for (int n = 0; n < turn.n_calls; ++n) want += wait_draws->text(turn.round, 100 + n);
      n_left += turn.n_calls;
    }
    if (wait_draws->moves_meanwhile(turn.round, index().x)) {
      want += wait_draws->text(turn.round, 200 + index().x);
      ++n_left;
    }
    const int n_own = draw(random, 4) + (end == 1 ? 1 : 0);
    for (int n = 0; n < n_own; ++n, ++n_left) {
      const Request request{index().x, {turn.round, random()}};
      want += request.note.text;
      if (end == 1 && n == 0) {
        partner(random).send<&WaitingElement::write_after_end>(request);
      } else if (random.chance(0.5)) {
        partner(random).send<&WaitingElement::write_after_reply>(request);
      } else {
        partner(random).send<&WaitingElement::write>(request);
      }
    }
    if (random.chance(wait_draws->move_chance))
      migrate_to(any_pe(random));  // it is not done before its end
    std::uint64_t got = 0;
    while (n_left > 0) {
      switch (random.below(5)) {
        case 0:
          if (n_left > 1) {
            const auto [first, second] =
                co_await when_all(notes_.take(turn.round), notes_.take(turn.round));
            got += first.text + second.text;
            n_left -= 2;
            break;
          }
          [[fallthrough]];
        case 1: {
          const Note note = co_await notes_.take(turn.round);
          got += note.text;
          --n_left;
          break;
        }
        case 2: {
          const Time limit = any_time(random, 5000);
          const auto note = co_await when_any(notes_.take(turn.round), sleep(limit));
          if (note.index() == 1) break;
          got += std::get<0>(note).text;
          --n_left;
          break;
        }
        case 3: {
          const auto to = partner(random);
          const std::uint64_t question = random();
          const std::uint64_t reply = co_await to.ask<&WaitingElement::reply>(question);
          expect(reply == mix(question + static_cast<std::uint64_t>(to.index().x)),
                 "a partner has another reply");
          break;
        }
        default:
          co_await epoch([&] { partner(random).send<&WaitingElement::receive>(Note{}); });
      }
      if (end == 2) destroy();
    }
    if (end == 2) destroy();
    expect(got == want, "leaver ", index().x, " has other notes than were written");
    expect(notes_.size() == 0, "leaver ", index().x, " has a note too many");
    turn.left(1);
  }

  [[nodiscard]] static bool is_member(int round, int index) {
    return index == 0 || (wait_draws->text(round, index) & 1U) != 0;
  }

  void serialize(auto& ar) { ar(notes_); }

 private:
  [[nodiscard]] bool is_leaver() const { return index().x >= wait_draws->n_partners; }
  [[nodiscard]] ElementProxy<WaitingElement> partner(Random& random) const {
    return array()[{draw(random, wait_draws->n_partners)}];
  }
  void move(const Note& why) {
    Random random(mix(why.text + static_cast<std::uint64_t>(index().x)));
    if (random.chance(wait_draws->move_chance)) migrate_to(any_pe(random));
  }

  Mailbox<&Note::round> notes_;
};

/// Counts the leavers that have left.
class LeaverCount : public Group<LeaverCount> {
 public:
  void left(std::int32_t n) { n_left_ += n; }
  [[nodiscard]] std::int32_t n_left() const { return n_left_; }

 private:
  std::int32_t n_left_ = 0;
};

Task leave_and_insert() {
  const auto elements = tess::create<WaitingElement>(range(wait_draws->n_elements()));
  const auto counts = create<LeaverCount>(each_pe);
  for (int round = 0; round < wait_draws->n_rounds; ++round) {
    Random random = wait_draws->draws(round, -1);
    Turn turn{round, draw(random, 4), draw(random, 4), {}, {}};
    turn.left = counts[any_pe(random)].target<&LeaverCount::left>();
    std::vector<Index1> members;
    for (int x = 0; x < wait_draws->n_elements(); ++x)
      if (WaitingElement::is_member(round, x)) members.push_back({x});
    co_await epoch([&] { turn.section = create_section(elements, members); });
    std::vector<Future<std::int32_t>> of_all, of_section;
    co_await epoch([&] {
      for (int x = wait_draws->n_partners; x < wait_draws->n_elements(); ++x)
        if (wait_draws->moves_meanwhile(round, x))
          elements[{x}].send<&WaitingElement::receive_and_move>(
              Note{round, wait_draws->text(round, 200 + x)}, any_pe(random));
      const bool leaves_first = random.chance(0.5);
      if (leaves_first) elements.broadcast<&WaitingElement::leave>(turn);
      for (int n = 0; n < turn.n_announced; ++n) {
        const Note announced{round, wait_draws->text(round, n)};
        const auto priority = static_cast<std::int64_t>(random.below(3));
        of_all.push_back(priority == 0
                             ? elements.reduce<&WaitingElement::receive_and_count>(announced)
                             : elements.with(Priority{priority - 2})
                                   .reduce<&WaitingElement::receive_and_count>(announced));
      }
      for (int n = 0; n < turn.n_calls; ++n) {
        const Note call{round, wait_draws->text(round, 100 + n)};
        of_section.push_back(
            turn.section.reduce<&WaitingElement::receive_in_section>(turn.section, call));
      }
      if (!leaves_first) elements.with(expedited).broadcast<&WaitingElement::leave>(turn);
    });
    for (Future<std::int32_t>& n_heard : of_all) {
      const std::int32_t n = co_await n_heard;
      expect(n == wait_draws->n_elements(), n, " of ", wait_draws->n_elements(),
             " receive_and_count the announced");
    }
    for (Future<std::int32_t>& n_heard : of_section) {
      const std::int32_t n = co_await n_heard;
      expect(n == std::ssize(members), n, " of ", members.size(), " receive_in_section");
    }
    std::int32_t n_left = 0;
    for (std::int32_t pe = 0; pe < tess::n_pes(); ++pe) {
      const std::int32_t of_pe = co_await counts[PeId{pe}].ask<&LeaverCount::n_left>();
      n_left += of_pe;
    }
    expect(n_left == (round + 1) * wait_draws->n_leavers, n_left, " leavers have left after ",
           round + 1, " rounds of ", wait_draws->n_leavers);
    co_await epoch([&] {
      turn.section.destroy();
      for (int x = wait_draws->n_partners; x < wait_draws->n_elements(); ++x)
        elements[{x}].insert_on(any_pe(random));  // ends the run if the index is not free
    });
  }
}

}  // namespace

void waits_after_destroy(Case& test) {
  const std::uint64_t seed = test.random();
  const WaitDraws here{seed, test.draw(1, 5), test.draw(1, 12), test.draw(1, 6),
                       0.3 * test.draw(0, 2)};
  wait_draws = &here;
  test.run_clean([] { return leave_and_insert(); });
}

}  // namespace tess::fuzz
