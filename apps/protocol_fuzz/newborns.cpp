// Elements that are born while rounds of broadcast and reduction go on, most of them with no epoch
// around. An element that is born after a result was awaited meets only later broadcasts and
// contributes only to later reductions; where elements refine in the middle of a step, parent and
// child meet in one step or the next, but never one ahead or behind. The oracle: the members of
// each result are the elements that gave to it, all of the same round; an element that is born
// takes part in every round from its first one on.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <algorithm>
#include <set>

namespace tess::fuzz {
namespace {

/// What one element gives to a reduction of a round, and what the whole of it is.
struct Share {
  std::int32_t first_round = 0, last_round = 0;
  std::int32_t first_part = 0, last_part = 0;
  std::vector<std::int32_t> members;
};
struct JoinShares {
  Share operator()(Share a, const Share& b) const {
    a.first_round = std::min(a.first_round, b.first_round);
    a.last_round = std::max(a.last_round, b.last_round);
    a.first_part = std::min(a.first_part, b.first_part);
    a.last_part = std::max(a.last_part, b.last_part);
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    return a;
  }
};

/// How a contribution comes about.
enum class Way : std::uint8_t { at_once, coroutine, own_message, by_another };

struct Nursery {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_rounds = 0;
  int n_parts = 1;  // reductions of a round
  int most_born = 0;
  bool in_epochs = false, self_driven = false, has_ways = false;
  double birth_chance = 0, death_chance = 0, move_chance = 0, remark_chance = 0;
  std::mutex mutex{};
  int n_born = 0;                                   // indices 0 … n_born − 1
  std::set<int> alive{};                            // born and not told to end
  std::set<int> took_part{};                        // met a round, and not told to end
  std::vector<std::vector<std::set<int>>> given{};  // by round and part
  int n_results = 0;

  [[nodiscard]] Random draws(int round, int index, int what) const {
    return Random(mix(seed ^ mix(static_cast<std::uint64_t>(round * 1000003 + index * 7 + what))));
  }
  /// The index of an element to be born; −1: there are enough.
  int next_born() {
    const std::lock_guard lock(mutex);
    if (n_born >= most_born) return -1;
    alive.insert(n_born);
    return n_born++;
  }
  /// False if it has been told to end before.
  bool ends(int index) {
    const std::lock_guard lock(mutex);
    took_part.erase(index);
    return alive.erase(index) == 1;
  }
  void meets(int index) {
    const std::lock_guard lock(mutex);
    if (alive.contains(index)) took_part.insert(index);
  }
  void give(int round, int part, int index) {
    const std::lock_guard lock(mutex);
    auto& givers = given[static_cast<std::size_t>(round)][static_cast<std::size_t>(part)];
    trial.expect(givers.insert(index).second, "element ", index, " gives twice to ", round);
  }
  /// A whole result, against who gave to it and who had to.
  void judge(int round, int part, const Share& share, const std::set<int>& due) {
    const std::lock_guard lock(mutex);
    ++n_results;
    const auto& givers = given[static_cast<std::size_t>(round)][static_cast<std::size_t>(part)];
    std::vector<int> members = share.members;
    std::sort(members.begin(), members.end());
    trial.expect(members == std::vector<int>(givers.begin(), givers.end()),
                 "round ",
                 round,
                 " part ",
                 part,
                 ": ",
                 members.size(),
                 " members, ",
                 givers.size(),
                 " gave");
    trial.expect(share.first_round == round && share.last_round == round &&
                     share.first_part == part && share.last_part == part,
                 "round ",
                 round,
                 " part ",
                 part,
                 " has contributions of rounds ",
                 share.first_round,
                 " … ",
                 share.last_round,
                 ", parts ",
                 share.first_part,
                 " … ",
                 share.last_part);
    for (const int index : due)
      trial.expect(givers.contains(index) || !alive.contains(index),
                   "round ",
                   round,
                   " is complete without element ",
                   index);
  }
};
Nursery* nursery = nullptr;

PeId draw_pe(Random& random) {
  return PeId{
      static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(current_pe().n_pes())))};
}

struct Order {
  std::int32_t round = 0;
  std::vector<Callback<Share>> targets;  // by part; empty: the whole array is told
};
struct Wake {
  std::int32_t key = 0;
};

class Cell : public Chare<Cell, Index1> {
 public:
  Cell() = default;
  explicit Cell(int floor) : born_(true), floor_(floor) {}

  /// The first message of what was created on demand: it does not end before.
  void born(int floor) {
    born_ = true;
    floor_ = std::max(floor_, floor);
  }

  Task step(Order order);
  /// A result that is also the next step's order.
  void stepped(const Share& share) {
    if (index().x == 0) nursery->judge(share.first_round, 0, share, {});
    if (share.first_round + 1 < nursery->n_rounds) (void)step(Order{share.first_round + 1, {}});
  }
  /// A broadcast that asks for nothing.
  void remark(int /*round*/) {}
  void wake(Wake wake) { waits_.put(wake); }
  void give_later(Order order) { give_all(order); }
  /// Has another element give, by a message.
  void pass_on(Order order, int to) { array()[{to}].send<&Cell::give_later>(std::move(order)); }
  /// A reduction without a broadcast.
  void say_here(Callback<Share> target) {
    const int me = index().x;
    contribute(JoinShares{}, Share{-1, -1, 0, 0, {me}}, std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(born_, floor_, last_round_, waits_);
  }

 private:
  void give_all(const Order& order);
  void bear(Random& random, int floor);
  void move(Random& random) {
    if (random.chance(nursery->move_chance)) migrate_to(draw_pe(random));
  }

  bool born_ = false;
  int floor_ = 0;
  int last_round_ = -1;
  Mailbox<&Wake::key> waits_;
};

/// Has an element be born, in one of the ways there are.
void insert_cell(const ArrayProxy<Cell>& cells, Random& random, int floor) {
  const int index = nursery->next_born();
  if (index < 0) return;
  switch (random.below(5)) {
    case 0:
      cells[{index}].insert(floor);
      break;
    case 1:
    case 2:
      cells[{index}].insert_on(draw_pe(random), floor);
      break;
    case 3:
      cells[{index}].send_or_create_here<&Cell::born>(floor);
      break;
    default:
      cells[{index}].send_or_create_home<&Cell::born>(floor);
  }
}

Task Cell::step(Order order) {
  const int me = index().x, round = order.round;
  nursery->trial.expect(last_round_ < 0 || last_round_ + 1 == round,
                        "element ",
                        me,
                        " meets round ",
                        round,
                        " after ",
                        last_round_);
  nursery->trial.expect(round >= floor_,
                        "element ",
                        me,
                        " meets round ",
                        round,
                        ", whose result was awaited before it was born in round ",
                        floor_);
  last_round_ = round;
  if (born_) nursery->meets(me);
  Random random = nursery->draws(round, me, 0);
  if (random.chance(nursery->birth_chance)) insert_cell(array(), random, round);
  const bool dies = me != 0 && born_ && random.chance(nursery->death_chance) && nursery->ends(me);
  if (dies) {
    destroy();
    if (random.chance(0.5)) co_return;
  } else {
    move(random);
  }
  switch (nursery->has_ways && !dies ? static_cast<Way>(random.below(4)) : Way::at_once) {
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
      array()[{0}].send<&Cell::pass_on>(std::move(order), me);
      break;
  }
  if (!dies && random.chance(nursery->birth_chance)) insert_cell(array(), random, round);
}

void Cell::give_all(const Order& order) {
  const int me = index().x;
  for (int part = 0; part < nursery->n_parts; ++part) {
    nursery->give(order.round, part, me);
    contribute(JoinShares{},
               Share{order.round, order.round, part, part, {me}},
               order.targets.empty() ? array().target<&Cell::stepped>()
                                     : order.targets[static_cast<std::size_t>(part)]);
  }
  Random random = nursery->draws(order.round, me, 1);
  move(random);
}

/// Drives the rounds from the PE it is on, and inserts from there or from another.
class Governor : public Group<Governor> {
 public:
  struct Birth {
    int round = 0;
    std::uint64_t seed = 0;
  };
  void insert(ArrayProxy<Cell> cells, Birth birth) {
    Random random(birth.seed);
    insert_cell(cells, random, birth.round);
  }
  Task run(ArrayProxy<Cell> cells);

 private:
  void populate(const ArrayProxy<Cell>& cells, int round, Random& random);
  void depopulate(const ArrayProxy<Cell>& cells, Random& random);
};

void Governor::populate(const ArrayProxy<Cell>& cells, int round, Random& random) {
  for (std::uint64_t n = random.below(3); n > 0; --n) {
    if (random.chance(0.5)) {
      insert_cell(cells, random, round);
    } else {
      group()[draw_pe(random)].send<&Governor::insert>(cells, Birth{round, random()});
    }
  }
}

void Governor::depopulate(const ArrayProxy<Cell>& cells, Random& random) {
  if (!random.chance(nursery->death_chance)) return;
  int index = 0;
  {
    // Its first message may be under way yet: what has taken part in a round is there to end.
    const std::lock_guard lock(nursery->mutex);
    for (const int one : nursery->took_part)
      if (one != 0 && random.chance(0.3)) index = one;
  }
  if (index != 0 && nursery->ends(index)) cells[{index}].destroy();
}

Task Governor::run(ArrayProxy<Cell> cells) {
  Random random(mix(nursery->seed + 1));
  for (int round = 0; round < nursery->n_rounds; ++round) {
    if (nursery->in_epochs) {
      co_await epoch([&] { populate(cells, round, random); });
    } else {
      populate(cells, round, random);
    }
    depopulate(cells, random);
    std::set<int> due;
    {
      const std::lock_guard lock(nursery->mutex);
      due = nursery->in_epochs ? nursery->alive : nursery->took_part;
    }
    std::array<Future<Share>, 3> futures;
    Order order{round, {}};
    for (int part = 0; part < nursery->n_parts; ++part)
      order.targets.push_back(futures[static_cast<std::size_t>(part)].callback());
    if (random.chance(nursery->remark_chance)) cells.broadcast<&Cell::remark>(round);
    const auto begin = [&] {
      cells.broadcast<&Cell::step>(order);
      if (random.chance(nursery->remark_chance)) cells.broadcast<&Cell::remark>(round);
    };
    if (nursery->in_epochs) {
      co_await epoch(begin);
    } else {
      begin();
    }
    for (int part = 0; part < nursery->n_parts; ++part) {
      Future<Share>& whole = futures[static_cast<std::size_t>(part)];
      const Share share = co_await whole;
      nursery->judge(round, part, share, due);
    }
    if (!nursery->in_epochs || !random.chance(0.3)) continue;
    // Nothing is under way: a reduction by messages is of exactly those who are alive, and of those
    // who are born now.
    co_await epoch([&] { populate(cells, round + 1, random); });
    Future<Share> here;
    std::set<int> alive;
    {
      const std::lock_guard lock(nursery->mutex);
      alive = nursery->alive;
    }
    for (const int index : alive) cells[{index}].send<&Cell::say_here>(here.callback());
    Share share = co_await here;
    std::sort(share.members.begin(), share.members.end());
    nursery->trial.expect(share.members == std::vector<int>(alive.begin(), alive.end()),
                          "after round ",
                          round,
                          ": ",
                          share.members.size(),
                          " of ",
                          alive.size(),
                          " elements in a reduction by messages");
  }
}

void run_nursery(Trial& trial, Nursery& here) {
  nursery = &here;
  here.given.resize(static_cast<std::size_t>(here.n_rounds),
                    std::vector<std::set<int>>(static_cast<std::size_t>(here.n_parts)));
  const PeId seat{trial.draw(0, trial.n_pes() - 1)};
  const Ending ending = trial.run([&]() -> Task {
    const auto cells = tess::create<Cell>(sparse);
    const auto governors = create_group<Governor>();
    co_await epoch([&] { cells[{nursery->next_born()}].insert(0); });
    if (nursery->self_driven) {
      cells.broadcast<&Cell::step>(Order{0, {}});
    } else {
      governors[seat].send<&Governor::run>(cells);
    }
  });
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, "; ", ending.report);
  // An element that is destroyed in the middle of a step may leave messages to itself.
  trial.expect(ending.report.empty() ||
                   (here.death_chance > 0 && ending.report.find("destroyed") != std::string::npos),
               "report: ",
               ending.report);
  trial.expect(here.n_results == here.n_rounds * here.n_parts,
               here.n_results,
               " results of ",
               here.n_rounds * here.n_parts);
}

}  // namespace

void newborns(Trial& trial) {
  Nursery here{trial, trial.random()(), trial.draw(4, 20)};
  here.most_born = 60;
  here.in_epochs = trial.draw(0, 1) == 1;
  if (trial.draw(0, 1) == 0) trial.forbid_forced_migration();
  run_nursery(trial, here);
}

void refinement(Trial& trial) {
  Nursery here{trial, trial.random()(), trial.draw(4, 20)};
  here.most_born = 40;
  here.self_driven = trial.draw(0, 3) == 0;
  here.in_epochs = !here.self_driven && trial.draw(0, 3) == 0;
  here.has_ways = trial.draw(0, 2) != 0;
  here.n_parts = here.self_driven ? 1 : trial.draw(1, 3);
  here.birth_chance = trial.random().unit() * 0.4;
  here.death_chance = trial.draw(0, 1) * trial.random().unit() * 0.2;
  here.move_chance = trial.draw(0, 1) * 0.3;
  here.remark_chance = trial.draw(0, 1) * 0.5;
  if (trial.draw(0, 1) == 0) trial.forbid_forced_migration();
  run_nursery(trial, here);
}

}  // namespace tess::fuzz
