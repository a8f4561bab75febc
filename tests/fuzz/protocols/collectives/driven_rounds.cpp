// Rounds of an array that another array drives without waiting: all rounds are open at once, calls
// overtake each other, and elements are inserted meanwhile, by an element, by a driver, by a member
// of a group on the way to an element, or at the start. Each names the round in which it joins. Some
// end after their last round. Everything migrates.
//
// The oracle: which elements are in which round is drawn before. A result has exactly their values,
// all of one round, and there is one for each round. It needs no common memory.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <set>

namespace tess::fuzz {
namespace {

enum class InsertedBy : std::uint8_t { start, element_first, element_last, driver, group };

/// An element is in the rounds from `joins` to before `ends`. It is inserted before, or while, its
/// parent is called for `call`.
struct DrivenLife {
  int parent = -1, family = 0;
  int joins = 0, ends = 0;
  int call = -1;
  InsertedBy by = InsertedBy::start;
  [[nodiscard]] bool in(int round) const { return joins <= round && round < ends; }
};

/// What the seed says; the same on all processes.
struct DrivenSchedule {
  std::uint64_t seed = 0;
  int n_first = 0, n_rounds = 0;
  PeId judge{};
  double move_chance = 0;
  std::vector<DrivenLife> lives{};

  [[nodiscard]] Random draws(int element, int round, int what) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>((element * 997 + round) * 8 + what))));
  }
  /// The children that are inserted so when `parent` is called for `call`.
  template <class Visit>
  void children(int parent, int call, InsertedBy by, const Visit& visit) const {
    for (int i = n_first; i < static_cast<int>(lives.size()); ++i) {
      const DrivenLife& life = lives[static_cast<std::size_t>(i)];
      if (life.parent == parent && life.call == call && life.by == by) visit(i);
    }
  }
};
const DrivenSchedule* driven = nullptr;

struct DrivenTally {
  int least = 0, most = 0;  // rounds
  std::vector<int> members;
};
struct AddDrivenTallies {
  DrivenTally operator()(DrivenTally a, const DrivenTally& b) const {
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    return {std::min(a.least, b.least), std::max(a.most, b.most), std::move(a.members)};
  }
};

class RoundJudge;
struct DrivenCall {
  int round = 0;
  GroupProxy<RoundJudge> judges;
};

class DrivenCell : public Chare<DrivenCell, Index1> {
 public:
  void give(const DrivenCall& call);
  void serialize(auto& ar) { ar(n_given_); }

 private:
  int n_given_ = 0;
};

void insert_driven_children(const ArrayProxy<DrivenCell>& cells, int parent, int call,
                            InsertedBy by) {
  driven->children(parent, call, by, [&](int child) {
    const tess::RoundId joins{driven->lives[static_cast<std::size_t>(child)].joins};
    Random random = driven->draws(child, call, 1);
    if (random.chance(0.5)) {
      cells[{child}].insert(joins);
    } else {
      cells[{child}].insert_on(any_pe(random), joins);
    }
  });
}

/// One member judges the results; each may insert elements and call their parent then.
class RoundJudge : public Group<RoundJudge> {
 public:
  struct PassedCall {
    DrivenCall call;
    int parent = 0;
  };
  void pass_on(ArrayProxy<DrivenCell> cells, const PassedCall& passed) {
    insert_driven_children(cells, passed.parent, passed.call.round, InsertedBy::group);
    cells[{passed.parent}].send<&DrivenCell::give>(passed.call);
  }

  void gathered(const std::vector<std::pair<Index1, int>>& values) {
    DrivenTally tally{values.front().second, values.front().second, {}};
    for (const auto& [index, round] : values)
      tally = AddDrivenTallies()(std::move(tally), {round, round, {index.x}});
    judge(std::move(tally));
  }
  void judge(DrivenTally tally) {
    const int round = tally.least;
    std::vector<int> expected;
    for (std::size_t i = 0; i < driven->lives.size(); ++i)
      if (driven->lives[i].in(round)) expected.push_back(static_cast<int>(i));
    std::sort(tally.members.begin(), tally.members.end());
    expect(round == tally.most, "one result has values of rounds ", round, " … ", tally.most);
    expect(tally.members == expected, "round ", round, " has ", tally.members.size(),
           " values, not those of its ", expected.size(), " elements");
    expect(judged_.insert(round).second, "two results of round ", round);
  }
  void finish() {
    expect(static_cast<int>(judged_.size()) == driven->n_rounds, judged_.size(), " results of ",
           driven->n_rounds);
  }

 private:
  std::set<int> judged_;
};

void DrivenCell::give(const DrivenCall& call) {
  const int me = index().x, round = call.round;
  insert_driven_children(array(), me, round, InsertedBy::element_first);
  const auto judge = call.judges[driven->judge];
  if (round % 2 == 0) {
    contribute(tess::RoundId{round}, AddDrivenTallies{}, DrivenTally{round, round, {me}},
               judge.target<&RoundJudge::judge>());
  } else {
    contribute(tess::RoundId{round}, gather, round, judge.target<&RoundJudge::gathered>());
  }
  insert_driven_children(array(), me, round, InsertedBy::element_last);
  const DrivenLife& life = driven->lives[static_cast<std::size_t>(me)];
  Random random = driven->draws(me, round, 0);
  if (++n_given_ == life.ends - life.joins && life.ends < driven->n_rounds) {
    destroy();
  } else if (random.chance(driven->move_chance)) {
    migrate_to(any_pe(random));
  }
}

/// Calls the elements of its family for all their rounds, without waiting.
class CellDriver : public Chare<CellDriver, Index1> {
 public:
  void run(ArrayProxy<DrivenCell> cells, GroupProxy<RoundJudge> judges) {
    for (int round = 0; round < driven->n_rounds; ++round) {
      for (int i = 0; i < static_cast<int>(driven->lives.size()); ++i) {
        const DrivenLife& life = driven->lives[static_cast<std::size_t>(i)];
        if (life.family != index().x || !life.in(round)) continue;
        const DrivenCall call{round, judges};
        insert_driven_children(cells, i, round, InsertedBy::driver);
        bool passes = false;
        driven->children(i, round, InsertedBy::group, [&](int /*child*/) { passes = true; });
        if (passes) {
          Random random = driven->draws(i, round, 2);
          judges[any_pe(random)].send<&RoundJudge::pass_on>(cells, RoundJudge::PassedCall{call, i});
        } else {
          cells[{i}].send<&DrivenCell::give>(call);
        }
      }
    }
  }
};

void draw_driven_lives(Case& test, DrivenSchedule& here) {
  const auto draw_end = [&](int first) {
    return test.draw(0, 2) == 0 ? test.draw(first + 1, here.n_rounds) : here.n_rounds;
  };
  for (int i = 0; i < here.n_first; ++i) here.lives.push_back({-1, i, 0, draw_end(0)});
  here.lives.front().ends = here.n_rounds;  // no round is without values
  for (int n = test.draw(0, 10); n > 0; --n) {
    const int parent = test.draw(0, static_cast<int>(here.lives.size()) - 1);
    const DrivenLife& its = here.lives[static_cast<std::size_t>(parent)];
    const int call = test.draw(its.joins, its.ends - 1);
    const int joins = test.draw(call, here.n_rounds - 1);
    const auto by = static_cast<InsertedBy>(test.draw(0, 4));
    here.lives.push_back({parent, its.family, joins, draw_end(joins), call, by});
  }
}

}  // namespace

void driven_rounds(Case& test) {
  const bool is_long = test.seed % 50 == 0;
  DrivenSchedule here{test.random(), test.draw(1, 6), is_long ? 60 : test.draw(1, 14)};
  here.judge = PeId{test.draw(0, test.machine.pes - 1)};
  here.move_chance = test.draw(0, 2) * 0.3;
  draw_driven_lives(test, here);
  driven = &here;
  test.run_clean([]() -> Task {
    const auto cells = tess::create<DrivenCell>(range(driven->n_first));
    const auto judges = create<RoundJudge>(each_pe);
    const auto drivers = tess::create<CellDriver>(range(driven->n_first));
    co_await epoch([&] {
      for (int i = 0; i < static_cast<int>(driven->lives.size()); ++i)
        for (int call = 0; call < driven->n_rounds; ++call)
          insert_driven_children(cells, i, call, InsertedBy::start);
      drivers.broadcast<&CellDriver::run>(cells, judges);
    });
    judges[driven->judge].send<&RoundJudge::finish>();
  });
}

}  // namespace tess::fuzz
