// Rounds of broadcast and reduction while elements are created, end, and migrate before or after
// they contribute. The oracle: each result is the combination of the recorded contributions to its
// number, and every element that lives through the round is among them.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace tess::fuzz {
namespace {

/// What one element gives to a round, and what the whole of it is.
struct Tally {
  std::int64_t n = 0;
  std::int64_t sum = 0;
  std::vector<std::int32_t> members;
};
struct AddTallies {
  Tally operator()(Tally a, const Tally& b) const {
    a.n += b.n;
    a.sum += b.sum;
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    return a;
  }
};

class Judge;

struct Records {
  std::uint64_t seed = 0;
  int n_first = 0, n_rounds = 0;
  double create_chance = 0, destroy_chance = 0, move_chance = 0, late_chance = 0;
  std::vector<std::set<int>> given{};  // by round
  std::map<int, int> ended{};          // index -> round in which it ended
  int n_created = 0;
  int n_results = 0;
  GroupProxy<Judge> judge{};

  void give(int round, int index) {
    const std::lock_guard lock(oracle);
    expect(given[static_cast<std::size_t>(round)].insert(index).second, "element ", index,
           " contributes twice to ", round);
  }
  [[nodiscard]] Random draws(int round, int index, int what) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(round * 1000003 + index * 7 + what))));
  }
  [[nodiscard]] double value(int round, int index) const {
    return 1.0 / (1.0 + round * 31 + index * 17);
  }
};
Records* records = nullptr;

struct Creation {
  int round = 0;
  int parent = 0;
};

class RoundElement : public Chare<RoundElement, Index1> {
 public:
  RoundElement() = default;
  explicit RoundElement(bool created) : created_(created) {}

  void run_round(int round);
  /// The first message of an element that is created within a round: its parent contributes once it
  /// has the answer. The new element contributes in the round that it receives, this one or the
  /// next.
  void create(Creation creation);
  void give(int round);

  void serialize(auto& ar) { ar(created_, last_round_); }

 private:
  void create_child(int round);
  void move(Random& random) { migrate_to(any_pe(random)); }

  bool created_ = false;  // an element created on demand does not end before its first message
  int last_round_ = -1;
};

/// One PE's member is given the results, and calls the next round.
class Judge : public Group<Judge> {
 public:
  void start(ArrayProxy<RoundElement> elements) {
    elements_ = elements;
    elements_.broadcast<&RoundElement::run_round>(0);
  }
  void tally(Tally tally) {
    const auto given = take(round_);
    std::sort(tally.members.begin(), tally.members.end());
    expect(std::vector<int>(given.begin(), given.end()) == tally.members, "round ", round_,
           ": the members of the result are not those that contributed");
    expect(tally.n == static_cast<std::int64_t>(given.size()), "round ", round_);
    next();
  }
  void ordered(std::vector<std::int32_t> members) {
    const auto given = take(round_);
    expect(std::vector<int>(given.begin(), given.end()) == members, "round ", round_,
           ": not the contributions in order, but ", members.size(), " of ", given.size());
    next();
  }
  void summed(double sum) {
    double expected = 0;
    bool first = true;
    for (const int index : take(round_)) {
      const double value = records->value(round_, index);
      expected = std::exchange(first, false) ? value : expected + value;
    }
    expect(sum == expected, "round ", round_, ": sum ", sum, " not ", expected);
    next();
  }
  void extremes(std::array<std::int64_t, 2> greatest) {
    const auto given = take(round_);
    expect(greatest[0] == *given.rbegin() && -greatest[1] == *given.begin(), "round ", round_,
           ": extremes ", -greatest[1], " … ", greatest[0]);
    next();
  }
  void agreed(bool all) {
    (void)take(round_);
    expect(all == (round_ % 12 < 6), "round ", round_, ": agreed on ", all);
    next();
  }
  void lowest(int least) {
    const auto given = take(round_);
    expect(least == *given.begin(), "round ", round_, ": least ", least);
    next();
  }

 private:
  static std::set<int> take(int round) {
    const std::lock_guard lock(oracle);
    ++records->n_results;
    const std::set<int>& given = records->given[static_cast<std::size_t>(round)];
    for (int i = 0; i < records->n_first; ++i) {
      const auto end = records->ended.find(i);
      expect((end != records->ended.end() && end->second <= round) || given.contains(i), "round ",
             round, " is complete without element ", i);
    }
    return given;
  }
  void next() {
    if (++round_ < records->n_rounds) elements_.broadcast<&RoundElement::run_round>(round_);
  }

  ArrayProxy<RoundElement> elements_;
  int round_ = 0;
};

void RoundElement::run_round(int round) {
  expect(last_round_ < 0 || last_round_ + 1 == round, "element ", index().x, " meets round ", round,
         " after ", last_round_);
  last_round_ = round;
  Random random = records->draws(round, index().x, 0);
  if (index().x != 0 && created_ && random.chance(records->destroy_chance)) {
    const bool gives = random.chance(0.5);
    if (gives) give(round);
    locked([&] { records->ended[index().x] = gives ? round + 1 : round; });
    destroy();
    return;
  }
  if (random.chance(records->create_chance)) {
    create_child(round);
    return;
  }
  if (random.chance(records->move_chance)) move(random);
  if (random.chance(records->late_chance)) {
    array()[index()].send<&RoundElement::give>(round);
  } else {
    give(round);
    if (random.chance(records->move_chance)) move(random);
  }
}

void RoundElement::create_child(int round) {
  int child = 0;
  locked([&] { child = records->n_first + records->n_created++; });
  const Creation creation{round, index().x};
  if (records->draws(round, index().x, 1).chance(0.5)) {
    array()[{child}].send_or_create_here<&RoundElement::create>(creation);
  } else {
    array()[{child}].send_or_create_home<&RoundElement::create>(creation);
  }
}

void RoundElement::create(Creation creation) {
  created_ = true;
  array()[{creation.parent}].send<&RoundElement::give>(creation.round);
}

void RoundElement::give(int round) {
  const int me = index().x;
  expect(static_cast<int>(next_reduction()) == round, "element ", me, " is at reduction ",
         next_reduction(), " in round ", round);
  records->give(round, me);
  const auto judge = records->judge[PeId{0}];
  const double value = records->value(round, me);
  switch (round % 6) {
    case 0:
      contribute(AddTallies{}, Tally{1, me, {me}}, judge.target<&Judge::tally>());
      break;
    case 1:
      contribute(in_order(concatenate), std::vector<std::int32_t>{me},
                 judge.target<&Judge::ordered>());
      break;
    case 2:
      contribute(in_order(sum), value, judge.target<&Judge::summed>());
      break;
    case 3:
      contribute(max, std::array<std::int64_t, 2>{me, -me}, judge.target<&Judge::extremes>());
      break;
    case 4:
      contribute(logical_and, round % 12 < 6 || me != 0, judge.target<&Judge::agreed>());
      break;
    default:
      contribute(min, me, judge.target<&Judge::lowest>());
  }
  Random random = records->draws(round, me, 2);
  if (random.chance(records->move_chance)) move(random);
}

}  // namespace

void rounds(Case& test) {
  Records here{test.random(), test.draw(1, 24)};
  records = &here;
  const bool long_run = test.seed % 100 == 0 && test.on != On::threads;
  here.n_rounds = long_run ? 500 : test.draw(1, 14);
  const double creates = long_run ? 0.01 : 0.1;
  here.create_chance = test.draw(0, 1) * creates * test.random.unit();
  here.destroy_chance = test.draw(0, 1) * (long_run ? 0.015 : 0.1) * test.random.unit();
  here.move_chance = test.draw(0, 2) * 0.3;
  here.late_chance = test.draw(0, 2) * 0.4;
  here.given.resize(static_cast<std::size_t>(here.n_rounds));
  test.run_clean([&] {
    here.judge = create<Judge>(each_pe);
    const auto elements = tess::create<RoundElement>(range(here.n_first), true);
    here.judge[PeId{0}].send<&Judge::start>(elements);
  });
  expect(here.n_results == here.n_rounds, here.n_results, " results of ", here.n_rounds);
}

}  // namespace tess::fuzz
