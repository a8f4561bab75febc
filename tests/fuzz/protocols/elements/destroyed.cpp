// Arrays that are created, used and destroyed while they are in full use: messages, demands,
// migrations, broadcasts, reductions, coroutines, balance rounds. The oracle: each message is
// delivered once or counted as a dead letter, and none is delivered after the end; every element is
// destroyed; every epoch ends; each PE forgets the array and its balancer.
#include "runtime/balance.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <map>
#include <set>

namespace tess::fuzz {
namespace {

struct EndsRecord {
  std::uint64_t seed = 0;
  double end_chance = 0;  // a message destroys its array
  int n_indices = 1;
  std::vector<int> delivered{};          // by token
  int n_broadcasts = 0;                  // one that is lost counts as a dead letter
  std::map<CollectionId, int> alive{};   // elements by array
  std::map<CollectionId, int> n_made{};  // inserted elements by array
  std::map<CollectionId, bool> over{};   // nothing more may be delivered
  std::set<CollectionId> reduces{};      // the result of a reduction is not known yet
  std::set<CollectionId> periodic{};     // balanced so: its elements must not call at_sync()
  std::map<PeId, std::size_t> n_collections{};

  int token() {
    const std::lock_guard lock(oracle);
    delivered.push_back(0);
    return static_cast<int>(delivered.size()) - 1;
  }
  void deliver(CollectionId array, int token) {
    const std::lock_guard lock(oracle);
    expect(!over[array], "a message is delivered after the end of its array");
    ++delivered[static_cast<std::size_t>(token)];
  }
  int n_alive() {
    const std::lock_guard lock(oracle);
    int n = 0;
    for (const auto& [array, alive_there] : alive) n += alive_there;
    return n;
  }
  /// Each PE knows no collection but the operators.
  bool all_forgotten() {
    const std::lock_guard lock(oracle);
    for (const auto& [pe, n] : n_collections)
      if (n != 1) return false;
    return true;
  }
};
EndsRecord* ends_record = nullptr;

class Operator;

/// A message that is sent on again and again.
struct Chain {
  GroupProxy<Operator> operators;
  int token = 0;
  int n_hops = 0;
};

class EndingTarget : public Chare<EndingTarget, Index1> {
 public:
  EndingTarget() { count(1); }
  explicit EndingTarget(Chain chain) : EndingTarget() {
    ends_record->deliver(array().id(), chain.token);
  }
  EndingTarget(const EndingTarget&) = delete;
  EndingTarget& operator=(const EndingTarget&) = delete;
  ~EndingTarget() override {
    count(-1);
    mark_ = 0;
  }

  void run(Chain chain);
  Task wait(Chain chain);
  void give(GroupProxy<Operator> operators);
  void sync() {
    locked([&] {
      if (ends_record->periodic.contains(array().id())) return;
    });
    if (!waits_) at_sync();
    waits_ = true;
  }
  void resume_from_sync() { waits_ = false; }

  void serialize(auto& ar) { ar(mark_, waits_); }

 private:
  void count(int n) const {
    locked([&] { ends_record->alive[array().id()] += n; });
  }

  int mark_ = 4711;
  bool waits_ = false;
};

/// On each PE: the operations on the arrays from outside.
class Operator : public Group<Operator> {
 public:
  void send_chains(ArrayProxy<EndingTarget> targets, Chain chain);
  void end(ArrayProxy<EndingTarget> targets, int n_hops) {
    if (n_hops == 0) {
      targets.destroy();
    } else {
      const PeId next{(pe().value + 1) % tess::n_pes()};
      group()[next].send<&Operator::end>(targets, n_hops - 1);
    }
  }
  void pass(int n_hops) {
    const PeId next{(pe().value * 3 + 1) % tess::n_pes()};
    if (n_hops != 0) group()[next].send<&Operator::pass>(n_hops - 1);
  }
  void met(std::uint64_t array) {
    const std::lock_guard lock(oracle);
    ends_record->reduces.erase(CollectionId{array});
  }
  void check_end(ArrayProxy<EndingTarget> targets) {
    expect(targets.ended(), "the epoch of the end is done, but ", pe(), " still has the array");
  }
  void count_collections() {
    locked([&] { ends_record->n_collections[pe()] = tess::n_collections(); });
  }
};

void send_chain(const ArrayProxy<EndingTarget>& targets, Chain chain, Random& random) {
  chain.token = ends_record->token();
  const int n = ends_record->n_indices;
  const auto target = targets[{draw(random, n)}];
  switch (random.below(8)) {
    case 0:
      target.send_or_create_here<&EndingTarget::run>(chain);
      break;
    case 1:
      target.send_or_create_home<&EndingTarget::run>(chain);
      break;
    case 2: {
      int made = 0;
      locked([&] { made = ends_record->n_made[targets.id()]++; });
      const PeId where = any_pe(random);
      targets[{1000 + made}].insert_on(where, chain);
      break;
    }
    case 3:
      target.send<&EndingTarget::wait>(chain);
      break;
    default:
      target.send<&EndingTarget::run>(chain);
  }
}

/// One at a time: elements are created meanwhile.
void start_reduction(const ArrayProxy<EndingTarget>& targets, GroupProxy<Operator> operators) {
  {
    const std::lock_guard lock(oracle);
    if (!ends_record->reduces.insert(targets.id()).second) return;
    ++ends_record->n_broadcasts;
  }
  targets.broadcast<&EndingTarget::give>(operators);
}

void EndingTarget::run(Chain chain) {
  ends_record->deliver(array().id(), chain.token);
  Random random(mix(static_cast<std::uint64_t>(chain.token) ^ mix(ends_record->seed)));
  if (random.chance(ends_record->end_chance)) array().destroy();
  if (random.chance(0.3)) migrate_to(any_pe(random));
  if (random.chance(0.05)) destroy();
  if (random.chance(0.05)) start_reduction(array(), chain.operators);
  if (random.chance(0.2)) sync();
  if (chain.n_hops == 0) return;
  --chain.n_hops;
  send_chain(array(), chain, random);
  if (random.chance(0.1)) send_chain(array(), chain, random);
}

Task EndingTarget::wait(Chain chain) {
  const CollectionId array_id = array().id();
  ends_record->deliver(array_id, chain.token);
  const PeId other{(chain.token * 7 + 1) % tess::n_pes()};
  co_await epoch([&] { chain.operators[other].send<&Operator::pass>(chain.token % 5); });
  expect(mark_ == 4711, "a coroutine goes on in an element that was destroyed");
  if (chain.token % 3 == 0 && array().ended()) give(chain.operators);  // nothing waits for a result
  if (chain.token % 4 == 0) sync();
  if (chain.token % 5 == 0) start_reduction(array(), chain.operators);
  if (chain.n_hops == 0) co_return;
  --chain.n_hops;
  Random random(mix(static_cast<std::uint64_t>(chain.token) ^ mix(ends_record->seed)));
  send_chain(array(), chain, random);
}

void EndingTarget::give(GroupProxy<Operator> operators) {
  contribute(max, array().id().value, operators[PeId{0}].target<&Operator::met>());
}

void Operator::send_chains(ArrayProxy<EndingTarget> targets, Chain chain) {
  Random random(mix(static_cast<std::uint64_t>(chain.token * 64 + pe().value)));
  const auto n = random.below(8);
  for (std::uint64_t i = 0; i < n; ++i) send_chain(targets, chain, random);
  if (random.chance(0.5)) start_reduction(targets, group());
}

/// True if it has a balancer.
bool balance(const ArrayProxy<EndingTarget>& targets, Random& random) {
  BalanceOptions options;
  options.lines = RoundLines::none;
  switch (random.below(6)) {
    case 0:
      options.strategy = "rotate";
      break;
    case 1:
      options.strategy = "none";
      break;
    case 2:
      options.strategy = "greedy";
      options.when = BalanceWhen::periodic;
      options.period = std::chrono::microseconds(2);
      break;
    case 3:
      options.strategy = "diffusion";
      options.when = BalanceWhen::periodic;
      options.period = std::chrono::microseconds(2);
      break;
    default:
      return false;
  }
  if (options.when == BalanceWhen::periodic) {
    const std::lock_guard lock(oracle);
    ends_record->periodic.insert(targets.id());
  }
  start_balancing(targets, options);
  return true;
}

Task live_and_end(GroupProxy<Operator> operators, std::uint64_t seed) {
  Random random(seed);
  const PeId other = any_pe(random);
  const Chain chain{operators, draw(random, 1000), draw(random, 12)};
  ArrayProxy<EndingTarget> targets;
  bool is_balanced = false;
  const auto make = [&] {
    targets =
        tess::create<EndingTarget>(random.chance(0.7) ? range(ends_record->n_indices) : sparse);
    is_balanced = balance(targets, random);
  };
  const auto send_chains = [&] { operators.broadcast<&Operator::send_chains>(targets, chain); };
  const auto end = [&] { targets.destroy(); };
  const auto end_elsewhere = [&] {
    operators[other].send<&Operator::end>(targets, chain.token % 4);
  };
  const auto how = random.below(4);
  switch (how) {
    case 0:  // all in one epoch: nothing is left when it is done
      co_await epoch([&] {
        make();
        send_chains();
        end_elsewhere();
      });
      break;
    case 1:  // twice
      make();
      co_await epoch([&] {
        send_chains();
        end_elsewhere();
        end();
      });
      break;
    case 2:  // unused
      co_await epoch([&] {
        make();
        end();
      });
      break;
    default:  // while chains run
      make();
      send_chains();
      co_await epoch(end);
      operators.broadcast<&Operator::check_end>(targets);
      co_return;
  }
  operators.broadcast<&Operator::check_end>(targets);
  const std::lock_guard lock(oracle);
  ends_record->over[targets.id()] = true;
  // A balancer's migrations belong to no epoch of the user: elements may arrive, and end, later.
  expect(is_balanced || ends_record->alive[targets.id()] == 0, ends_record->alive[targets.id()],
         " elements outlive their array, way ", how);
}

Task all_lives(GroupProxy<Operator> operators, int n_lives, std::uint64_t seed) {
  for (int life = 0; life < n_lives; ++life)
    co_await live_and_end(operators, mix(seed + static_cast<unsigned>(life)));
}

Task live_and_end_often(int n_lives, std::uint64_t seed) {
  const auto operators = create<Operator>(each_pe);
  co_await epoch([&] { const Task lives = all_lives(operators, n_lives, seed); });
  constexpr int most_looks = 5000;
  int n_looks = 0;
  do {
    co_await epoch([&] { operators.broadcast<&Operator::count_collections>(); });
  } while (!(ends_record->n_alive() == 0 && ends_record->all_forgotten()) &&
           n_looks++ < most_looks);
  expect(ends_record->n_alive() == 0, ends_record->n_alive(), " elements are left");
  expect(ends_record->all_forgotten(), "a PE still knows a collection that has ended");
  co_await epoch([&] { operators.destroy(); });
  operators.destroy();
}

}  // namespace

void destroyed(Case& test) {
  EndsRecord here{test.seed};
  here.n_indices = test.draw(1, 20);
  here.end_chance = test.draw(0, 2) * 0.01;
  ends_record = &here;
  const int n_lives = test.draw(1, 6);
  const std::uint64_t seed = test.random();
  const Result result = test.run([&]() -> Task { return live_and_end_often(n_lives, seed); });
  expect_exit(result);
  int n_lost = 0;
  for (const int delivered : here.delivered) {
    expect(delivered <= 1, "a message was delivered ", delivered, " times");
    n_lost += delivered == 0 ? 1 : 0;
  }
  const int n_dead = n_not_delivered(result);
  expect(n_dead >= n_lost && n_dead <= n_lost + here.n_broadcasts, n_lost, " messages were lost, ",
         n_dead, " counted, of ", here.n_broadcasts, " broadcasts");
}

}  // namespace tess::fuzz
