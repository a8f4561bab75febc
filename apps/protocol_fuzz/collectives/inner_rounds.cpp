// reduce() called inside of elements and members of groups, by many of them at once: over their own
// array and a group, where several rounds are under way at a time; over an array of each caller's
// own, in which elements are born and end from round to round and in the middle of one; and over
// sections of that array, some of whose members end. Everything migrates.
//
// The oracle: each result has the contributions to its own question, one of each element that has to
// be there, and none of an element that had ended before. It needs no common memory.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/interface.hpp"
#include "runtime/when.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace tess::fuzz {
namespace {

/// What the seed says; the same on all processes.
struct Fair {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_askers = 0, n_steps = 0;
  double move_chance = 0;
};
const Fair* fair = nullptr;

/// What all give to a question: the number, sum and extremes of what depends on both.
struct RoundSum {
  std::int64_t n = 0;
  std::uint64_t sum = 0, least = 0, greatest = 0;
  friend bool operator==(const RoundSum&, const RoundSum&) = default;
};
struct AddRoundSums {
  RoundSum operator()(RoundSum a, const RoundSum& b) const {
    return {a.n + b.n, a.sum + b.sum, std::min(a.least, b.least), std::max(a.greatest, b.greatest)};
  }
};
RoundSum sum_of(std::uint64_t question, int x) {
  const std::uint64_t value = mix(question ^ static_cast<std::uint64_t>(x));
  return {1, value, value, value};
}
/// Of n elements, as a serial program has it.
RoundSum sum_of_all(std::uint64_t question, int n) {
  RoundSum all = sum_of(question, 0);
  for (int x = 1; x < n; ++x) all = AddRoundSums{}(all, sum_of(question, x));
  return all;
}

using Voices = std::vector<std::pair<Index1, std::uint64_t>>;  // (element, question)

class Performer {
 public:
  virtual ~Performer() = default;
  virtual void play(std::uint64_t question, Callback<Voices> target) = 0;
};
/// Of an array that one asker has for itself.
class Soloist : public Chare<Soloist, Index1>, public Performer {
 public:
  void play(std::uint64_t question, Callback<Voices> target) override {
    contribute(gather, question, std::move(target));
    move(question);
  }
  void sing(SectionProxy<Soloist> choir, std::uint64_t question, Callback<Voices> target) {
    contribute(choir, gather, question, std::move(target));
    move(question);
  }
  template <class Ar>
  void serialize(Ar& /*ar*/) {}

 private:
  void move(std::uint64_t question) {
    Random random(mix(question + static_cast<std::uint64_t>(index().x)));
    if (random.chance(fair->move_chance)) migrate_to(any_pe(random));
  }
};

class Usher;

struct AskerWork {
  std::int32_t n_left = 0;
  GroupProxy<Usher> clerks;
};

class Asker : public Chare<Asker, Index1> {
 public:
  /// Called by several at once.
  void count(std::uint64_t question, Callback<RoundSum> target) {
    contribute(AddRoundSums{}, sum_of(question, index().x), std::move(target));
    Random random(mix(question + static_cast<std::uint64_t>(index().x)));
    if (random.chance(fair->move_chance)) migrate_to(any_pe(random));
  }
  /// One step, then a message to itself with the next: between them it may migrate.
  Task work(AskerWork work);
  void report(Callback<int> target) { contribute(sum, n_done_, std::move(target)); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(players_, alive_, n_born_, n_done_);
  }

 private:
  Task ask_all(AskerWork work, Random& random);
  Task ask_players(Random& random);
  Task ask_choir(Random& random);
  void bear(Random& random) { players_[{n_born_++}].insert_on(any_pe(random)); }
  /// Destroys one of the players, but not the first, and returns it; -1 if there is no other.
  int end_one(Random& random) {
    if (alive_.size() == 1) return -1;
    const auto nth = 1 + random.below(static_cast<std::uint64_t>(alive_.size() - 1));
    const auto at = std::next(alive_.begin(), static_cast<std::ptrdiff_t>(nth));
    const int ends = *at;
    alive_.erase(at);
    players_[{ends}].destroy();
    return ends;
  }
  /// The result has all of `must` and none but those of `may`.
  static void check(const Voices& voices, std::uint64_t question, const std::set<int>& must,
                    const std::set<int>& may) {
    std::set<int> given;
    bool one_question = true;
    for (const auto& [index, of] : voices) {
      one_question = one_question && of == question;
      fair->trial.expect(given.insert(index.x).second, "element ", index.x,
                         " is twice in a result");
    }
    fair->trial.expect(one_question, "a result has contributions to another question");
    fair->trial.expect(std::ranges::includes(given, must), "a result of ", given.size(),
                       " elements lacks one of ", must.size());
    fair->trial.expect(std::ranges::includes(may, given), "a result of ", given.size(),
                       " elements has one that is not there");
  }

  ArrayProxy<Soloist> players_;
  std::set<int> alive_;  // players; the first one never ends, so that each round has a result
  std::int32_t n_born_ = 0;
  int n_done_ = 0;
};

class Usher : public Group<Usher> {
 public:
  void count(std::uint64_t question, Callback<RoundSum> target) {
    contribute(AddRoundSums{}, sum_of(question, pe().value), std::move(target));
  }
  /// Members ask, too.
  Task work(ArrayProxy<Asker> askers, int n_left) {
    for (; n_left > 0; --n_left) {
      const std::uint64_t question =
          mix(fair->seed + static_cast<std::uint64_t>(n_left * 1000 + pe().value));
      auto of_clerks = group().reduce<&Usher::count>(question);
      auto of_askers = askers.reduce<&Asker::count>(question);
      const auto [clerks, all] = co_await when_all(of_clerks, of_askers);
      fair->trial.expect(clerks == sum_of_all(question, tess::n_pes()) &&
                             all == sum_of_all(question, fair->n_askers),
                         "a member gets another result");
    }
  }
};

Task Asker::work(AskerWork work) {
  Random random(mix(fair->seed ^ mix(static_cast<std::uint64_t>(work.n_left * 1000 + index().x))));
  if (players_ == ArrayProxy<Soloist>()) {
    n_born_ = 1 + static_cast<std::int32_t>(random.below(6));
    for (int x = 0; x < n_born_; ++x) alive_.insert(x);
    const int n = n_born_;
    co_await epoch([&] { players_ = tess::create<Soloist>(range(n)); });
  }
  if (work.n_left == 0) {
    co_await epoch([&] { players_.destroy(); });
    ++n_done_;
    co_return;
  }
  switch (random.below(3)) {
    case 0:
      co_await ask_all(work, random);
      break;
    case 1:
      co_await ask_players(random);
      break;
    default:
      co_await ask_choir(random);
  }
  if (random.chance(fair->move_chance)) migrate_to(any_pe(random));
  --work.n_left;
  self().send<&Asker::work>(work);
}

/// Several rounds of one array, awaited in any order; others are under way from other elements.
Task Asker::ask_all(AskerWork work, Random& random) {
  const std::uint64_t first = random(), second = random(), third = random();
  auto one = array().reduce<&Asker::count>(first);
  auto of_clerks = work.clerks.reduce<&Usher::count>(second);
  auto other = array().with(Priority{-1}).reduce<&Asker::count>(third);
  const RoundSum of_third = co_await other;
  const RoundSum of_first = co_await one;
  const RoundSum of_second = co_await of_clerks;
  fair->trial.expect(of_first == sum_of_all(first, fair->n_askers) &&
                         of_third == sum_of_all(third, fair->n_askers),
                     "an element gets another result of its array");
  fair->trial.expect(of_second == sum_of_all(second, tess::n_pes()),
                     "an element gets another result of a group");
}

/// One round at a time, since elements are born meanwhile.
Task Asker::ask_players(Random& random) {
  const std::int32_t n_before = n_born_;
  co_await epoch([&] {
    for (auto n = random.below(3); n > 0; --n) bear(random);
    if (random.chance(0.3)) end_one(random);
  });
  for (std::int32_t x = n_before; x < n_born_; ++x) alive_.insert(x);
  const std::uint64_t question = random();
  std::set<int> may = alive_, born;
  const auto bear_one = [&] {
    if (!random.chance(0.5)) return;
    born.insert(n_born_);
    bear(random);
  };
  Future<Voices> result;
  co_await epoch([&] {
    bear_one();
    if (random.chance(0.3)) end_one(random);
    result = random.chance(0.5)
                 ? players_.reduce<&Soloist::play>(question)
                 : InterfaceArray<Performer>(players_).reduce<&Performer::play>(question);
    bear_one();
  });
  const Voices voices = co_await result;
  may.insert(born.begin(), born.end());
  check(voices, question, alive_, may);
  alive_.insert(born.begin(), born.end());
}

/// Two rounds of a section at once.
Task Asker::ask_choir(Random& random) {
  std::set<int> members{0};
  for (const int x : alive_)
    if (random.chance(0.6)) members.insert(x);
  const std::uint64_t first = random(), second = random();
  SectionProxy<Soloist> choir;
  Future<Voices> one, other;
  const bool waits_for_birth = random.chance(0.3);
  if (waits_for_birth) {
    members.insert(n_born_);
    alive_.insert(n_born_);
    co_await epoch([&] {
      choir = create_section(players_, std::vector<Index1>(members.begin(), members.end()));
      one = choir.reduce<&Soloist::sing>(choir, first);
      bear(random);
      other = choir.reduce<&Soloist::sing>(choir, second);
    });
  } else {
    co_await epoch([&] {
      choir = create_section(players_, std::vector<Index1>(members.begin(), members.end()));
    });
    co_await epoch([&] {
      if (random.chance(0.5)) members.erase(end_one(random));
    });
    co_await epoch([&] {
      one = choir.reduce<&Soloist::sing>(choir, first);
      if (random.chance(0.5)) end_one(random);
      other = choir.reduce<&Soloist::sing>(choir, second);
    });
  }
  std::set<int> must;
  std::ranges::set_intersection(members, alive_, std::inserter(must, must.end()));
  const auto [of_first, of_second] = co_await when_all(one, other);
  check(of_first, first, must, members);
  check(of_second, second, must, members);
  co_await epoch([&] { choir.destroy(); });
}

Task hold_fair() {
  const auto askers = tess::create<Asker>(range(fair->n_askers));
  const auto clerks = create_group<Usher>();
  co_await epoch([&] {
    askers.broadcast<&Asker::work>(AskerWork{fair->n_steps, clerks});
    clerks.broadcast<&Usher::work>(askers, fair->n_steps);
  });
  const int n_done = co_await askers.reduce<&Asker::report>();
  fair->trial.expect(n_done == fair->n_askers, n_done, " of ", fair->n_askers,
                     " elements have asked");
}

}  // namespace

void inner_rounds(Trial& trial) {
  const std::uint64_t seed = trial.random()();
  const Fair here{trial, seed, trial.draw(1, 8), trial.draw(1, 8), 0.3 * trial.draw(0, 2)};
  fair = &here;
  trial.run_clean([] { return hold_fair(); });
}

}  // namespace tess::fuzz
