// Elements that are created while rounds of broadcast and reduction run, most of them outside of
// epochs. An element that is created after a result was awaited receives only later broadcasts and
// contributes only to later reductions. If elements refine in the middle of a step, parent and
// child meet in one step or in the next, but never one ahead or behind.
//
// The oracle is one member of a group, the judge. It uses only the results and what is drawn
// from the seed, so that the scenarios also run on several processes. An element is in every result
// from the first round that it received to its end, and in none twice; an element that was created
// in an epoch is in the very next result; at the end all are there.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>

namespace tess::fuzz {
namespace {

using Name = std::uint64_t;  // of an element; the first is 0

/// What the seed says; the same on all processes.
struct Schedule {
  std::uint64_t seed = 0;
  int n_rounds = 0;
  int n_parts = 1;  // reductions of a round
  bool in_epochs = false, self_driven = false, has_ways = false;
  double create_chance = 0, destroy_chance = 0, move_chance = 0, remark_chance = 0;

  [[nodiscard]] Random draws(int round, Name name, int what) const {
    return Random(mix(seed ^ mix(name * 1000003 + static_cast<std::uint64_t>(round * 16 + what))));
  }
  [[nodiscard]] Name child_of(Name parent, int round, int k) const {
    return mix(seed ^ mix(parent + static_cast<std::uint64_t>(round * 16 + k + 1))) | 1U;
  }
  enum class Fate : std::uint8_t { lives, gives_and_ends, ends };
  [[nodiscard]] Fate fate(int round, Name name, bool may_end) const {
    Random random = draws(round, name, 1);
    if (name == 0 || !may_end || !random.chance(destroy_chance)) return Fate::lives;
    return random.chance(0.5) ? Fate::gives_and_ends : Fate::ends;
  }
};
const Schedule* schedule = nullptr;

/// What one element gives to a round.
struct Entry {
  Name name = 0;
  std::int32_t first_round = 0;  // that it met
  std::int32_t floor = 0;        // the round before which it was inserted
  bool may_end = false;          // in the next round
  std::vector<Name> children;    // inserted in this round
};
/// To a reduction of a round, and the whole of it.
struct Share {
  std::int32_t first_round = 0, last_round = 0;
  std::int32_t first_part = 0, last_part = 0;
  std::vector<Entry> entries;
};
struct JoinShares {
  Share operator()(Share a, const Share& b) const {
    a.first_round = std::min(a.first_round, b.first_round);
    a.last_round = std::max(a.last_round, b.last_round);
    a.first_part = std::min(a.first_part, b.first_part);
    a.last_part = std::max(a.last_part, b.last_part);
    a.entries.insert(a.entries.end(), b.entries.begin(), b.entries.end());
    return a;
  }
};

class InsertingJudge;

struct Order {
  std::int32_t round = 0;
  GroupProxy<InsertingJudge> judges;
  std::vector<Callback<Share>> targets;  // by part; empty: all elements are told the result
};
struct Wake {
  std::int32_t key = 0;
};

class Cell : public Chare<Cell, Name> {
 public:
  Cell() = default;
  explicit Cell(int floor) : created_(true), floor_(floor) {}

  /// The first message of an element created on demand: the element does not end before it.
  void create(int floor) {
    created_ = true;
    floor_ = std::max(floor_, floor);
  }
  /// The target to which the first element sends results that are also orders.
  void report_to(Callback<Share> judge) { judge_ = std::move(judge); }

  Task step(Order order);
  /// A result that is also the next step's order.
  void stepped(const Share& share) {
    if (index() == 0) judge_(Share(share));
    if (share.first_round + 1 < schedule->n_rounds)
      (void)step(Order{share.first_round + 1, {}, {}});
  }
  /// A broadcast that asks for nothing.
  void remark(int /*round*/) {}
  void wake(Wake wake) { waits_.put(wake); }
  void give_later(Order order) { give_all(order); }
  /// Has another element give, by a message.
  void pass_on(Order order, Name to) { array()[to].send<&Cell::give_later>(std::move(order)); }
  /// A reduction without a broadcast.
  void say_here(Callback<Share> target) {
    contribute(JoinShares{}, Share{0, 0, 0, 0, {Entry{index(), 0, 0, false, {}}}}, target);
  }

  void serialize(auto& ar) {
    ar(created_, may_end_, floor_, first_round_, last_round_, children_, judge_, waits_);
  }

 private:
  /// How a contribution comes about.
  enum class Way : std::uint8_t { at_once, coroutine, own_message, by_another, by_timer, by_judge };

  void give_all(const Order& order);
  void pass_to_judge(Order order);
  void move(Random& random) {
    if (random.chance(schedule->move_chance)) migrate_to(any_pe(random));
  }

  bool created_ = false, may_end_ = false;
  int floor_ = 0;
  int first_round_ = -1, last_round_ = -1;
  std::vector<Name> children_;
  Callback<Share> judge_;
  Mailbox<&Wake::key> waits_;
};

/// Creates an element in one of the possible ways.
void insert_cell(const ArrayProxy<Cell>& cells, Name name, int floor) {
  Random random = schedule->draws(floor, name, 2);
  switch (random.below(5)) {
    case 0:
      cells[name].insert(floor);
      break;
    case 1:
    case 2:
      cells[name].insert_on(any_pe(random), floor);
      break;
    case 3:
      cells[name].send_or_create_here<&Cell::create>(floor);
      break;
    default:
      cells[name].send_or_create_home<&Cell::create>(floor);
  }
}

Task Cell::step(Order order) {
  const int round = order.round;
  expect(last_round_ < 0 || last_round_ + 1 == round, "element ", index(), " meets round ", round,
         " after ", last_round_);
  if (first_round_ < 0) first_round_ = round;
  const auto fate = schedule->fate(round, index(), may_end_);
  last_round_ = round;
  if (fate == Schedule::Fate::ends) {
    destroy();
    co_return;
  }
  children_.clear();
  Random random = schedule->draws(round, index(), 3);
  for (int k = 0; k < 2; ++k)
    if (round + 1 < schedule->n_rounds && random.chance(schedule->create_chance))
      children_.push_back(schedule->child_of(index(), round, k));
  const bool inserts_first = random.chance(0.5);
  if (inserts_first)
    for (const Name child : children_) insert_cell(array(), child, round);
  const std::vector<Name> later = inserts_first ? std::vector<Name>() : children_;
  // By a judge's message only if the first element's own message says what led to the round.
  const bool may_ask = index() != 0 && !order.targets.empty();
  Way way = schedule->has_ways ? static_cast<Way>(random.below(may_ask ? 6 : 5)) : Way::at_once;
  if (fate == Schedule::Fate::gives_and_ends) {
    way = Way::at_once;
    destroy();
  } else {
    move(random);
  }
  switch (way) {
    case Way::at_once:
      give_all(order);
      break;
    case Way::coroutine:
      array()[index()].send<&Cell::wake>(Wake{round});
      (void)co_await waits_.take(round);
      give_all(order);
      break;
    case Way::own_message:
      array()[index()].send<&Cell::give_later>(std::move(order));
      break;
    case Way::by_another:
      array()[0].send<&Cell::pass_on>(std::move(order), index());
      break;
    case Way::by_timer:
      self().send_after<&Cell::give_later>(std::chrono::microseconds(random.below(20)),
                                           std::move(order));
      break;
    case Way::by_judge:
      pass_to_judge(std::move(order));
      break;
  }
  for (const Name child : later) insert_cell(array(), child, round);
}

void Cell::give_all(const Order& order) {
  may_end_ = created_;
  const Entry entry{index(), first_round_, floor_, may_end_, children_};
  for (int part = 0; part < schedule->n_parts; ++part)
    contribute(JoinShares{}, Share{order.round, order.round, part, part, {entry}},
               order.targets.empty() ? array().target<&Cell::stepped>()
                                     : order.targets[static_cast<std::size_t>(part)]);
  Random random = schedule->draws(order.round, index(), 4);
  move(random);
}

/// One member drives the rounds, has elements inserted from its PE and from others, and judges the
/// results.
class InsertingJudge : public Group<InsertingJudge> {
 public:
  InsertingJudge() { known_[0].due = true; }
  struct Creation {
    Name name = 0;
    int round = 0;
  };
  void insert(ArrayProxy<Cell> cells, Creation creation) {
    insert_cell(cells, creation.name, creation.round);
  }
  struct Passed {
    Order order;
    Name to = 0;
  };
  /// Has an element give by a message of another collection.
  void pass_on(ArrayProxy<Cell> cells, Passed passed) {
    cells[passed.to].send<&Cell::give_later>(std::move(passed.order));
  }
  /// Results of steps that drive themselves; one may overtake another.
  void hear(Share share) {
    const int round = share.first_round;
    heard_.emplace(round, std::move(share));
    for (auto at = heard_.begin(); at != heard_.end() && at->first == n_judged_;
         at = heard_.erase(at))
      judge(at->first, 0, at->second);
  }
  Task run(ArrayProxy<Cell> cells);
  /// After the rounds, when nothing is under way: a last round, in which all are there.
  Task finish(ArrayProxy<Cell> cells);

 private:
  void populate(const ArrayProxy<Cell>& cells, int round, Random& random);
  void depopulate(const ArrayProxy<Cell>& cells, Random& random);
  Task play(ArrayProxy<Cell> cells, int round);
  Task call_by_name(ArrayProxy<Cell> cells, int round);
  void judge(int round, int part, const Share& share);
  void judge_new(int round, const Entry& entry);

  struct Known {
    int first_round = -1;  // −1: in no result yet
    bool may_end = false;
    bool told_to_end = false;
    bool due = false;  // in the next result
  };
  std::map<Name, Known> known_;  // created, and not ended
  std::map<int, Share> heard_;
  int n_judged_ = 0;
};

void Cell::pass_to_judge(Order order) {
  const GroupProxy<InsertingJudge> judges = order.judges;
  Random random = schedule->draws(order.round, index(), 6);
  judges[any_pe(random)].send<&InsertingJudge::pass_on>(
      array(), InsertingJudge::Passed{std::move(order), index()});
}

void InsertingJudge::populate(const ArrayProxy<Cell>& cells, int round, Random& random) {
  for (std::uint64_t n = random.below(3); n > 0; --n) {
    const Name name = schedule->child_of(random(), round, 2);
    known_[name].due = schedule->in_epochs;
    if (random.chance(0.5)) {
      insert_cell(cells, name, round);
    } else {
      group()[any_pe(random)].send<&InsertingJudge::insert>(cells, Creation{name, round});
    }
  }
}

void InsertingJudge::depopulate(const ArrayProxy<Cell>& cells, Random& random) {
  if (!random.chance(schedule->destroy_chance)) return;
  for (auto& [name, known] : known_) {
    // Not before its first message: that would create it again.
    if (name == 0 || !known.may_end || known.told_to_end) continue;
    if (!random.chance(0.3)) continue;
    known.told_to_end = true;
    cells[name].destroy();
    return;
  }
}

void InsertingJudge::judge_new(int round, const Entry& entry) {
  expect(entry.first_round == round, "element ", entry.name, " met round ", entry.first_round,
         " first and is in no result before ", round);
  expect(entry.floor <= round, "element ", entry.name, " meets round ", round,
         ", whose result was awaited before it was created in ", entry.floor);
}

void InsertingJudge::judge(int round, int part, const Share& share) {
  expect(share.first_round == round && share.last_round == round && share.first_part == part &&
             share.last_part == part,
         "round ", round, " part ", part, " has contributions of rounds ", share.first_round, " … ",
         share.last_round, ", parts ", share.first_part, " … ", share.last_part);
  std::set<Name> members;
  for (const Entry& entry : share.entries) {
    expect(members.insert(entry.name).second, entry.name, " gives twice to ", round);
    const auto at = known_.find(entry.name);
    if (at == known_.end() || at->second.first_round < 0) judge_new(round, entry);
  }
  for (const auto& [name, known] : known_) {
    const bool ends = schedule->fate(round, name, known.may_end) == Schedule::Fate::ends;
    const bool expected = (known.first_round >= 0 || known.due) && !ends && !known.told_to_end;
    expect(!expected || members.contains(name), "round ", round, " part ", part,
           " is complete without element ", name, ", which met round ", known.first_round,
           " first");
    expect(!ends || !members.contains(name), name, " gives after its end in ", round);
  }
  if (part + 1 < schedule->n_parts) return;
  ++n_judged_;
  std::erase_if(known_, [&](const auto& one) {
    return schedule->fate(round, one.first, one.second.may_end) != Schedule::Fate::lives ||
           (one.second.told_to_end && !members.contains(one.first));
  });
  for (const Entry& entry : share.entries) {
    for (const Name child : entry.children) known_[child].due |= schedule->in_epochs;
    const bool is_known = known_.contains(entry.name);
    if (!is_known && entry.first_round != round) continue;  // it has ended
    Known& known = known_[entry.name];
    known.first_round = entry.first_round;
    known.may_end = entry.may_end;
  }
}

Task InsertingJudge::play(ArrayProxy<Cell> cells, int round) {
  Random random = schedule->draws(round, 0, 5);
  std::array<Future<Share>, 3> futures;
  Order order{round, group(), {}};
  for (int part = 0; part < schedule->n_parts; ++part)
    order.targets.push_back(futures[static_cast<std::size_t>(part)].callback());
  const auto begin = [&] {
    if (random.chance(schedule->remark_chance)) cells.broadcast<&Cell::remark>(round);
    cells.broadcast<&Cell::step>(order);
    if (random.chance(schedule->remark_chance)) cells.broadcast<&Cell::remark>(round);
  };
  if (schedule->in_epochs) {
    co_await epoch(begin);
  } else {
    begin();
  }
  for (int part = 0; part < schedule->n_parts; ++part) {
    Future<Share>& whole = futures[static_cast<std::size_t>(part)];
    const Share share = co_await whole;
    judge(round, part, share);
  }
}

/// Between rounds in epochs nothing is under way: a reduction by messages is of exactly those
/// elements that are alive.
Task InsertingJudge::call_by_name(ArrayProxy<Cell> cells, int round) {
  std::set<Name> alive;
  for (const auto& [name, known] : known_)
    if (!known.told_to_end) alive.insert(name);
  Future<Share> here;
  for (const Name name : alive) cells[name].send<&Cell::say_here>(here.callback());
  const Share share = co_await here;
  std::set<Name> members;
  for (const Entry& entry : share.entries) members.insert(entry.name);
  expect(members == alive && share.entries.size() == alive.size(), "after round ", round, ": ",
         share.entries.size(), " of ", alive.size(), " elements in a reduction by messages");
}

Task InsertingJudge::run(ArrayProxy<Cell> cells) {
  Random random(mix(schedule->seed + 1));
  for (int round = 0; round < schedule->n_rounds; ++round) {
    const auto change = [&] {
      populate(cells, round, random);
      depopulate(cells, random);
    };
    if (schedule->in_epochs) {
      co_await epoch(change);
      if (random.chance(0.3)) co_await call_by_name(cells, round - 1);
    } else {
      change();
    }
    co_await play(cells, round);
  }
}

Task InsertingJudge::finish(ArrayProxy<Cell> cells) {
  for (auto& [name, known] : known_) known.due = true;
  const int round = schedule->n_rounds;
  co_await play(cells, round);
  expect(n_judged_ == round + 1, n_judged_, " results of ", round + 1);
}

void run_schedule(Case& test, const Schedule& here) {
  schedule = &here;
  const PeId seat{test.draw(0, test.machine.pes - 1)};
  const Result result = test.run([seat]() -> Task {
    const auto cells = tess::create<Cell>(sparse);
    const auto judges = create<InsertingJudge>(each_pe);
    co_await epoch([&] {
      cells[0].insert(0);
      cells[0].send<&Cell::report_to>(judges[seat].target<&InsertingJudge::hear>());
    });
    co_await epoch([&] {
      if (schedule->self_driven) {
        cells.broadcast<&Cell::step>(Order{0, {}, {}});
      } else {
        judges[seat].send<&InsertingJudge::run>(cells);
      }
    });
    co_await epoch([&] { judges[seat].send<&InsertingJudge::finish>(cells); });
  });
  expect_exit(result);
  // An element that is told to end in the middle of a step may leave messages to itself.
  expect(result.report.empty() || (here.destroy_chance > 0 && n_not_delivered(result) > 0),
         "report: ", result.failure());
}

}  // namespace

void created_after_results(Case& test) {
  Schedule here{test.random(), test.draw(4, 20)};
  here.in_epochs = test.draw(0, 1) == 1;
  if (test.draw(0, 1) == 0) test.machine.migration = 0;
  run_schedule(test, here);
}

void created_in_steps(Case& test) {
  Schedule here{test.random(), test.draw(4, 16)};
  here.self_driven = test.draw(0, 3) == 0;
  here.in_epochs = !here.self_driven && test.draw(0, 2) == 0;
  here.has_ways = test.draw(0, 2) != 0;
  here.n_parts = here.self_driven ? 1 : test.draw(1, 3);
  here.create_chance = test.random.unit() * 0.12;
  here.destroy_chance = test.draw(0, 1) * test.random.unit() * 0.2;
  here.move_chance = test.draw(0, 1) * 0.3;
  here.remark_chance = test.draw(0, 1) * 0.5;
  if (test.draw(0, 1) == 0) test.machine.migration = 0;
  run_schedule(test, here);
}

}  // namespace tess::fuzz
