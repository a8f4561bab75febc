// Elements that call destroy(), or are destroyed by others, and wait after that: for messages in
// their mailbox (one, two, or one within a time), for replies and for epochs. Until its coroutine is
// done such a guest lives: it gets messages, array broadcasts (some after a migration, which it
// began before) and multicasts, contributes and replies. Broadcasts have any priority.
//
// The oracle: a guest receives each letter once, a reduction has a contribution of every element,
// and after the epoch of the round the indices of the guests are free for the next ones. It needs no
// common memory.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/when.hpp"

#include <utility>

namespace tess::fuzz {
namespace {

/// What the seed says; the same on all processes.
struct Inn {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_hosts = 0, n_guests = 0, n_rounds = 0;
  double move_chance = 0;

  [[nodiscard]] Random draws(int round, int index) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(round * 1000 + index))));
  }
  [[nodiscard]] std::uint64_t text(int round, int number) const {
    return mix(seed + mix(static_cast<std::uint64_t>(round * 1000 + number)));
  }
  [[nodiscard]] int n_elements() const { return n_hosts + n_guests; }
  /// True if a guest gets a letter that moves it, about when it leaves.
  [[nodiscard]] bool travels(int round, int guest) const {
    return draws(round, 500 + guest).chance(move_chance);
  }
};
const Inn* inn = nullptr;

struct GuestLetter {
  std::int32_t round = 0;
  std::uint64_t text = 0;
};
/// A letter that a guest asks a host for.
struct Request {
  std::int32_t guest = 0;
  GuestLetter letter;
};

class Lodger;

struct Stay {
  std::int32_t round = 0;
  std::int32_t n_news = 0, n_calls = 0;  // that each guest, and each member, receives
  SectionProxy<Lodger> choir;
  Callback<std::int32_t> left;  // each guest says so once
};

class Lodger : public Chare<Lodger, Index1> {
 public:
  void receive(GuestLetter letter) {
    if (is_guest()) letters_.put(letter);
  }
  void receive_and_move(GuestLetter letter, PeId pe) {
    receive(letter);
    migrate_to(pe);
  }
  /// A broadcast.
  void hear(GuestLetter news, Callback<std::int32_t> n_heard) {
    receive(news);
    contribute(sum, 1, std::move(n_heard));
    move(news);
  }
  /// A multicast.
  void sing(SectionProxy<Lodger> choir, GuestLetter call, Callback<std::int32_t> n_heard) {
    receive(call);
    contribute(choir, sum, 1, std::move(n_heard));
    move(call);
  }
  [[nodiscard]] std::uint64_t mood(std::uint64_t question) const {
    return mix(question + static_cast<std::uint64_t>(index().x));
  }

  // Of hosts.

  void write(Request request) {
    array()[{request.guest}].send<&Lodger::receive>(request.letter);
    move(request.letter);
  }
  Task write_after_reply(Request request) {
    const auto guest = array()[{request.guest}];
    const std::uint64_t mood = co_await guest.ask<&Lodger::mood>(request.letter.text);
    inn->trial.expect(mood == mix(request.letter.text + static_cast<std::uint64_t>(request.guest)),
                      "guest ", request.guest, " has another mood");
    guest.send<&Lodger::receive>(request.letter);
  }
  /// Destroys the guest, which waits for this letter.
  Task write_after_end(Request request) {
    const auto guest = array()[{request.guest}];
    co_await epoch([&] { guest.destroy(); });
    guest.send<&Lodger::receive>(request.letter);
  }

  /// A guest's: it ends with it.
  Task leave(Stay stay) {
    if (!is_guest()) co_return;
    Random random = inn->draws(stay.round, index().x);
    const auto end = random.below(3);
    if (end == 0) destroy();
    std::uint64_t want = 0;
    for (int n = 0; n < stay.n_news; ++n) want += inn->text(stay.round, n);
    int n_left = stay.n_news;
    if (stay.n_calls > 0 && sings(stay.round, index().x)) {
      for (int n = 0; n < stay.n_calls; ++n) want += inn->text(stay.round, 100 + n);
      n_left += stay.n_calls;
    }
    if (inn->travels(stay.round, index().x)) {
      want += inn->text(stay.round, 200 + index().x);
      ++n_left;
    }
    const int n_own = static_cast<int>(random.below(4)) + (end == 1 ? 1 : 0);
    for (int n = 0; n < n_own; ++n, ++n_left) {
      const Request request{index().x, {stay.round, random()}};
      want += request.letter.text;
      if (end == 1 && n == 0) {
        host(random).send<&Lodger::write_after_end>(request);
      } else if (random.chance(0.5)) {
        host(random).send<&Lodger::write_after_reply>(request);
      } else {
        host(random).send<&Lodger::write>(request);
      }
    }
    if (random.chance(inn->move_chance))
      migrate_to(any_pe(random));  // it is not done before its end
    std::uint64_t got = 0;
    while (n_left > 0) {
      switch (random.below(5)) {
        case 0:
          if (n_left > 1) {
            const auto [first, second] =
                co_await when_all(letters_.take(stay.round), letters_.take(stay.round));
            got += first.text + second.text;
            n_left -= 2;
            break;
          }
          [[fallthrough]];
        case 1: {
          const GuestLetter letter = co_await letters_.take(stay.round);
          got += letter.text;
          --n_left;
          break;
        }
        case 2: {
          const Time limit(static_cast<std::int64_t>(random.below(5000)));
          const auto letter = co_await when_any(letters_.take(stay.round), sleep(limit));
          if (letter.index() == 1) break;
          got += std::get<0>(letter).text;
          --n_left;
          break;
        }
        case 3: {
          const auto to = host(random);
          const std::uint64_t question = random();
          const std::uint64_t mood = co_await to.ask<&Lodger::mood>(question);
          inn->trial.expect(mood == mix(question + static_cast<std::uint64_t>(to.index().x)),
                            "a host has another mood");
          break;
        }
        default:
          co_await epoch([&] { host(random).send<&Lodger::receive>(GuestLetter{}); });
      }
      if (end == 2) destroy();
    }
    if (end == 2) destroy();
    inn->trial.expect(got == want, "guest ", index().x, " has other letters than were written");
    inn->trial.expect(letters_.size() == 0, "guest ", index().x, " has a letter too many");
    stay.left(1);
  }

  [[nodiscard]] static bool sings(int round, int index) {
    return index == 0 || (inn->text(round, index) & 1U) != 0;
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(letters_);
  }

 private:
  [[nodiscard]] bool is_guest() const { return index().x >= inn->n_hosts; }
  [[nodiscard]] ElementProxy<Lodger> host(Random& random) const {
    return array()[{static_cast<int>(random.below(static_cast<std::uint64_t>(inn->n_hosts)))}];
  }
  void move(const GuestLetter& why) {
    Random random(mix(why.text + static_cast<std::uint64_t>(index().x)));
    if (random.chance(inn->move_chance)) migrate_to(any_pe(random));
  }

  Mailbox<&GuestLetter::round> letters_;
};

/// Counts the guests that have left.
class Porter : public Group<Porter> {
 public:
  void left(std::int32_t n) { n_left_ += n; }
  [[nodiscard]] std::int32_t n_left() const { return n_left_; }

 private:
  std::int32_t n_left_ = 0;
};

Task stay_and_leave() {
  const auto lodgers = tess::create<Lodger>(range(inn->n_elements()));
  const auto porters = create_group<Porter>();
  for (int round = 0; round < inn->n_rounds; ++round) {
    Random random = inn->draws(round, -1);
    Stay stay{round, static_cast<int>(random.below(4)), static_cast<int>(random.below(4)), {}, {}};
    stay.left = porters[any_pe(random)].target<&Porter::left>();
    std::vector<Index1> singers;
    for (int x = 0; x < inn->n_elements(); ++x)
      if (Lodger::sings(round, x)) singers.push_back({x});
    co_await epoch([&] { stay.choir = create_section(lodgers, singers); });
    std::vector<Future<std::int32_t>> of_all, of_choir;
    co_await epoch([&] {
      for (int x = inn->n_hosts; x < inn->n_elements(); ++x)
        if (inn->travels(round, x))
          lodgers[{x}].send<&Lodger::receive_and_move>(
              GuestLetter{round, inn->text(round, 200 + x)}, any_pe(random));
      const bool leaves_first = random.chance(0.5);
      if (leaves_first) lodgers.broadcast<&Lodger::leave>(stay);
      for (int n = 0; n < stay.n_news; ++n) {
        const GuestLetter news{round, inn->text(round, n)};
        const auto priority = static_cast<std::int64_t>(random.below(3));
        of_all.push_back(priority == 0
                             ? lodgers.reduce<&Lodger::hear>(news)
                             : lodgers.with(Priority{priority - 2}).reduce<&Lodger::hear>(news));
      }
      for (int n = 0; n < stay.n_calls; ++n) {
        const GuestLetter call{round, inn->text(round, 100 + n)};
        of_choir.push_back(stay.choir.reduce<&Lodger::sing>(stay.choir, call));
      }
      if (!leaves_first) lodgers.with(expedited).broadcast<&Lodger::leave>(stay);
    });
    for (Future<std::int32_t>& n_heard : of_all) {
      const std::int32_t n = co_await n_heard;
      inn->trial.expect(n == inn->n_elements(), n, " of ", inn->n_elements(), " hear the news");
    }
    for (Future<std::int32_t>& n_heard : of_choir) {
      const std::int32_t n = co_await n_heard;
      inn->trial.expect(n == std::ssize(singers), n, " of ", singers.size(), " sing");
    }
    std::int32_t n_left = 0;
    for (std::int32_t pe = 0; pe < tess::n_pes(); ++pe) {
      const std::int32_t of_pe = co_await porters[PeId{pe}].ask<&Porter::n_left>();
      n_left += of_pe;
    }
    inn->trial.expect(n_left == (round + 1) * inn->n_guests, n_left, " guests have left after ",
                      round + 1, " rounds of ", inn->n_guests);
    co_await epoch([&] {
      stay.choir.destroy();
      for (int x = inn->n_hosts; x < inn->n_elements(); ++x)
        lodgers[{x}].insert_on(any_pe(random));  // ends the run if the index is not free
    });
  }
}

}  // namespace

void farewells(Trial& trial) {
  const std::uint64_t seed = trial.random()();
  const Inn here{
      trial, seed, trial.draw(1, 5), trial.draw(1, 12), trial.draw(1, 6), 0.3 * trial.draw(0, 2)};
  inn = &here;
  trial.run_clean([] { return stay_and_leave(); });
}

}  // namespace tess::fuzz
