// reduce() called inside of elements and members of groups, by many of them at once: over their own
// array and a group, where several rounds are under way at a time; over an array of each caller's
// own, in which elements are inserted and end from round to round and in the middle of one; and over
// sections of that array, some of whose members end. Everything migrates.
//
// The oracle: each result has the contributions to its own question, one of each element that has to
// be there, and none of an element that had ended before. It needs no common memory.
#include "runtime/more/interface.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace tess::fuzz {
namespace {

/// What the seed says; the same on all processes.
struct InnerDraws {
  std::uint64_t seed = 0;
  int n_askers = 0, n_steps = 0;
  double move_chance = 0;
};
const InnerDraws* inner_draws = nullptr;

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
/// Gives the result of n elements, as a serial program has it.
RoundSum sum_of_all(std::uint64_t question, int n) {
  RoundSum all = sum_of(question, 0);
  for (int x = 1; x < n; ++x) all = AddRoundSums{}(all, sum_of(question, x));
  return all;
}

using Answers = std::vector<std::pair<Index1, std::uint64_t>>;  // (element, question)

class Contributor {
 public:
  virtual ~Contributor() = default;
  virtual void give(std::uint64_t question, Callback<Answers> target) = 0;
};
/// Of an array that one asker has for itself.
class OwnElement : public Chare<OwnElement, Index1>, public Contributor {
 public:
  void give(std::uint64_t question, Callback<Answers> target) override {
    contribute(gather, question, std::move(target));
    move(question);
  }
  void give_in_section(SectionProxy<OwnElement> section, std::uint64_t question,
                       Callback<Answers> target) {
    contribute(section, gather, question, std::move(target));
    move(question);
  }
  void serialize(auto& /*ar*/) {}

 private:
  void move(std::uint64_t question) {
    Random random(mix(question + static_cast<std::uint64_t>(index().x)));
    if (random.chance(inner_draws->move_chance)) migrate_to(any_pe(random));
  }
};

class AskingMember;

struct AskerWork {
  std::int32_t n_left = 0;
  GroupProxy<AskingMember> members;
};

class Asker : public Chare<Asker, Index1> {
 public:
  /// Called by several at once.
  void count(std::uint64_t question, Callback<RoundSum> target) {
    contribute(AddRoundSums{}, sum_of(question, index().x), std::move(target));
    Random random(mix(question + static_cast<std::uint64_t>(index().x)));
    if (random.chance(inner_draws->move_chance)) migrate_to(any_pe(random));
  }
  /// One step, then a message to itself with the next: between them it may migrate.
  Task work(AskerWork work);
  void report(Callback<int> target) { contribute(sum, n_done_, std::move(target)); }

  void serialize(auto& ar) { ar(own_, alive_, n_inserted_, n_done_); }

 private:
  Task ask_all(AskerWork work, Random& random);
  Task ask_own(Random& random);
  Task ask_section(Random& random);
  void insert_one(Random& random) { own_[{n_inserted_++}].insert_on(any_pe(random)); }
  /// Destroys one of the elements, but not the first, and returns it; -1 if there is no other.
  int end_one(Random& random) {
    if (alive_.size() == 1) return -1;
    const auto nth = 1 + random.below(static_cast<std::uint64_t>(alive_.size() - 1));
    const auto at = std::next(alive_.begin(), static_cast<std::ptrdiff_t>(nth));
    const int ends = *at;
    alive_.erase(at);
    own_[{ends}].destroy();
    return ends;
  }
  /// The result has all of `must` and none but those of `may`.
  static void check(const Answers& result, std::uint64_t question, const std::set<int>& must,
                    const std::set<int>& may) {
    std::set<int> given;
    bool one_question = true;
    for (const auto& [index, of] : result) {
      one_question = one_question && of == question;
      expect(given.insert(index.x).second, "element ", index.x, " is twice in a result");
    }
    expect(one_question, "a result has contributions to another question");
    expect(std::ranges::includes(given, must), "a result of ", given.size(),
           " elements lacks one of ", must.size());
    expect(std::ranges::includes(may, given), "a result of ", given.size(),
           " elements has one that is not there");
  }

  ArrayProxy<OwnElement> own_;
  std::set<int> alive_;  // elements; the first one never ends, so that each round has a result
  std::int32_t n_inserted_ = 0;
  int n_done_ = 0;
};

class AskingMember : public Group<AskingMember> {
 public:
  void count(std::uint64_t question, Callback<RoundSum> target) {
    contribute(AddRoundSums{}, sum_of(question, pe().value), std::move(target));
  }
  /// Members ask, too.
  Task work(ArrayProxy<Asker> askers, int n_left) {
    for (; n_left > 0; --n_left) {
      const std::uint64_t question =
          mix(inner_draws->seed + static_cast<std::uint64_t>(n_left * 1000 + pe().value));
      auto of_members = group().reduce<&AskingMember::count>(question);
      auto of_askers = askers.reduce<&Asker::count>(question);
      const auto [members, all] = co_await when_all(of_members, of_askers);
      expect(members == sum_of_all(question, tess::n_pes()) &&
                 all == sum_of_all(question, inner_draws->n_askers),
             "a member gets another result");
    }
  }
};

Task Asker::work(AskerWork work) {
  Random random(
      mix(inner_draws->seed ^ mix(static_cast<std::uint64_t>(work.n_left * 1000 + index().x))));
  if (own_ == ArrayProxy<OwnElement>()) {
    n_inserted_ = 1 + static_cast<std::int32_t>(random.below(6));
    for (int x = 0; x < n_inserted_; ++x) alive_.insert(x);
    const int n = n_inserted_;
    co_await epoch([&] { own_ = tess::create<OwnElement>(range(n)); });
  }
  if (work.n_left == 0) {
    co_await epoch([&] { own_.destroy(); });
    ++n_done_;
    co_return;
  }
  switch (random.below(3)) {
    case 0:
      co_await ask_all(work, random);
      break;
    case 1:
      co_await ask_own(random);
      break;
    default:
      co_await ask_section(random);
  }
  if (random.chance(inner_draws->move_chance)) migrate_to(any_pe(random));
  --work.n_left;
  self().send<&Asker::work>(work);
}

/// Several rounds of one array, awaited in any order; others are under way from other elements.
Task Asker::ask_all(AskerWork work, Random& random) {
  const std::uint64_t first = random(), second = random(), third = random();
  auto one = array().reduce<&Asker::count>(first);
  auto of_members = work.members.reduce<&AskingMember::count>(second);
  auto other = array().with(Priority{-1}).reduce<&Asker::count>(third);
  const RoundSum of_third = co_await other;
  const RoundSum of_first = co_await one;
  const RoundSum of_second = co_await of_members;
  expect(of_first == sum_of_all(first, inner_draws->n_askers) &&
             of_third == sum_of_all(third, inner_draws->n_askers),
         "an element gets another result of its array");
  expect(of_second == sum_of_all(second, tess::n_pes()),
         "an element gets another result of a group");
}

/// One round at a time, since elements are inserted meanwhile.
Task Asker::ask_own(Random& random) {
  const std::int32_t n_before = n_inserted_;
  co_await epoch([&] {
    for (auto n = random.below(3); n > 0; --n) insert_one(random);
    if (random.chance(0.3)) end_one(random);
  });
  for (std::int32_t x = n_before; x < n_inserted_; ++x) alive_.insert(x);
  const std::uint64_t question = random();
  std::set<int> may = alive_, inserted;
  const auto insert_meanwhile = [&] {
    if (!random.chance(0.5)) return;
    inserted.insert(n_inserted_);
    insert_one(random);
  };
  Future<Answers> future;
  co_await epoch([&] {
    insert_meanwhile();
    if (random.chance(0.3)) end_one(random);
    future = random.chance(0.5)
                 ? own_.reduce<&OwnElement::give>(question)
                 : InterfaceArray<Contributor>(own_).reduce<&Contributor::give>(question);
    insert_meanwhile();
  });
  const Answers result = co_await future;
  may.insert(inserted.begin(), inserted.end());
  check(result, question, alive_, may);
  alive_.insert(inserted.begin(), inserted.end());
}

/// Two rounds of a section at once.
Task Asker::ask_section(Random& random) {
  std::set<int> members{0};
  for (const int x : alive_)
    if (random.chance(0.6)) members.insert(x);
  const std::uint64_t first = random(), second = random();
  SectionProxy<OwnElement> section;
  Future<Answers> one, other;
  const bool waits_for_insertion = random.chance(0.3);
  if (waits_for_insertion) {
    members.insert(n_inserted_);
    alive_.insert(n_inserted_);
    co_await epoch([&] {
      section = create_section(own_, std::vector<Index1>(members.begin(), members.end()));
      one = section.reduce<&OwnElement::give_in_section>(section, first);
      insert_one(random);
      other = section.reduce<&OwnElement::give_in_section>(section, second);
    });
  } else {
    co_await epoch([&] {
      section = create_section(own_, std::vector<Index1>(members.begin(), members.end()));
    });
    co_await epoch([&] {
      if (random.chance(0.5)) members.erase(end_one(random));
    });
    co_await epoch([&] {
      one = section.reduce<&OwnElement::give_in_section>(section, first);
      if (random.chance(0.5)) end_one(random);
      other = section.reduce<&OwnElement::give_in_section>(section, second);
    });
  }
  std::set<int> must;
  std::ranges::set_intersection(members, alive_, std::inserter(must, must.end()));
  const auto [of_first, of_second] = co_await when_all(one, other);
  check(of_first, first, must, members);
  check(of_second, second, must, members);
  co_await epoch([&] { section.destroy(); });
}

Task ask_everywhere() {
  const auto askers = tess::create<Asker>(range(inner_draws->n_askers));
  const auto members = create<AskingMember>(each_pe);
  co_await epoch([&] {
    askers.broadcast<&Asker::work>(AskerWork{inner_draws->n_steps, members});
    members.broadcast<&AskingMember::work>(askers, inner_draws->n_steps);
  });
  const int n_done = co_await askers.reduce<&Asker::report>();
  expect(n_done == inner_draws->n_askers, n_done, " of ", inner_draws->n_askers,
         " elements have asked");
}

}  // namespace

void inner_rounds(Case& test) {
  const std::uint64_t seed = test.random();
  const InnerDraws here{seed, test.draw(1, 8), test.draw(1, 8), 0.3 * test.draw(0, 2)};
  inner_draws = &here;
  test.run_clean([] { return ask_everywhere(); });
}

}  // namespace tess::fuzz
