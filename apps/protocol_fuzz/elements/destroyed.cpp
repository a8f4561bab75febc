// Arrays that are created, used and destroyed while they are in full use: messages, demands,
// migrations, broadcasts, reductions, coroutines, balance rounds. The oracle: each message is
// delivered once or counted as a dead letter, and none is delivered after the end; every element is
// destroyed; every epoch ends; each PE forgets the array and its balancer.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/balance.hpp"

#include <map>
#include <set>

namespace tess::fuzz {
namespace {

struct Remains {
  Trial& trial;
  double end_chance = 0;  // a message destroys its array
  int n_indices = 1;
  std::mutex mutex{};
  std::vector<int> delivered{};          // by token
  int n_broadcasts = 0;                  // one that is lost counts as a dead letter
  std::map<CollectionId, int> alive{};   // elements by array
  std::map<CollectionId, int> n_made{};  // inserted elements by array
  std::map<CollectionId, bool> over{};   // nothing more may be delivered
  std::set<CollectionId> meets{};        // the result of a meeting is not known yet
  std::set<CollectionId> periodic{};     // balanced so: its elements must not call at_sync()
  std::map<PeId, std::size_t> n_collections{};

  int token() {
    const std::lock_guard lock(mutex);
    delivered.push_back(0);
    return static_cast<int>(delivered.size()) - 1;
  }
  void deliver(CollectionId array, int token) {
    const std::lock_guard lock(mutex);
    trial.expect(!over[array], "a message is delivered after the end of its array");
    ++delivered[static_cast<std::size_t>(token)];
  }
  int n_alive() {
    const std::lock_guard lock(mutex);
    int n = 0;
    for (const auto& [array, alive_there] : alive) n += alive_there;
    return n;
  }
  /// Each PE knows no collection but the clerks.
  bool all_forgotten() {
    const std::lock_guard lock(mutex);
    for (const auto& [pe, n] : n_collections)
      if (n != 1) return false;
    return true;
  }
};
Remains* remains = nullptr;

class Clerk;

/// A message that is sent on again and again.
struct Errand {
  GroupProxy<Clerk> clerks;
  int token = 0;
  int n_hops = 0;
};

class Mayfly : public Chare<Mayfly, Index1> {
 public:
  Mayfly() { count(1); }
  explicit Mayfly(Errand errand) : Mayfly() { remains->deliver(array().id(), errand.token); }
  Mayfly(const Mayfly&) = delete;
  Mayfly& operator=(const Mayfly&) = delete;
  ~Mayfly() override {
    count(-1);
    canary_ = 0;
  }

  void run(Errand errand);
  Task wait(Errand errand);
  void meet(GroupProxy<Clerk> clerks);
  void sync() {
    {
      const std::lock_guard lock(remains->mutex);
      if (remains->periodic.contains(array().id())) return;
    }
    if (!waits_) at_sync();
    waits_ = true;
  }
  void resume_from_sync() { waits_ = false; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(canary_, waits_);
  }

 private:
  void count(int n) const {
    const std::lock_guard lock(remains->mutex);
    remains->alive[array().id()] += n;
  }

  int canary_ = 4711;
  bool waits_ = false;
};

/// On each PE: the operations on the arrays from outside.
class Clerk : public Group<Clerk> {
 public:
  void flood(ArrayProxy<Mayfly> flies, Errand errand);
  void end(ArrayProxy<Mayfly> flies, int n_hops) {
    if (n_hops == 0) {
      flies.destroy();
    } else {
      const PeId next{(pe().value + 1) % tess::n_pes()};
      group()[next].send<&Clerk::end>(flies, n_hops - 1);
    }
  }
  void pass(int n_hops) {
    const PeId next{(pe().value * 3 + 1) % tess::n_pes()};
    if (n_hops != 0) group()[next].send<&Clerk::pass>(n_hops - 1);
  }
  void met(std::uint64_t array) {
    const std::lock_guard lock(remains->mutex);
    remains->meets.erase(CollectionId{array});
  }
  void check_end(ArrayProxy<Mayfly> flies) {
    remains->trial.expect(flies.ended(), "the epoch of the end is done, but ", pe(),
                          " still has the array");
  }
  void count_collections() {
    const std::lock_guard lock(remains->mutex);
    remains->n_collections[pe()] = tess::n_collections();
  }
};

void send_errand(const ArrayProxy<Mayfly>& flies, Errand errand, Random& random) {
  errand.token = remains->token();
  const int n = remains->n_indices;
  const auto fly = flies[{static_cast<int>(random.below(static_cast<std::uint64_t>(n)))}];
  switch (random.below(8)) {
    case 0:
      fly.send_or_create_here<&Mayfly::run>(errand);
      break;
    case 1:
      fly.send_or_create_home<&Mayfly::run>(errand);
      break;
    case 2: {
      int made = 0;
      {
        const std::lock_guard lock(remains->mutex);
        made = remains->n_made[flies.id()]++;
      }
      const PeId where = any_pe(random);
      flies[{1000 + made}].insert_on(where, errand);
      break;
    }
    case 3:
      fly.send<&Mayfly::wait>(errand);
      break;
    default:
      fly.send<&Mayfly::run>(errand);
  }
}

/// One at a time: elements are created meanwhile.
void start_meeting(const ArrayProxy<Mayfly>& flies, GroupProxy<Clerk> clerks) {
  {
    const std::lock_guard lock(remains->mutex);
    if (!remains->meets.insert(flies.id()).second) return;
    ++remains->n_broadcasts;
  }
  flies.broadcast<&Mayfly::meet>(clerks);
}

void Mayfly::run(Errand errand) {
  remains->deliver(array().id(), errand.token);
  Random random(mix(static_cast<std::uint64_t>(errand.token) ^ mix(remains->trial.seed())));
  if (random.chance(remains->end_chance)) array().destroy();
  if (random.chance(0.3)) migrate_to(any_pe(random));
  if (random.chance(0.05)) destroy();
  if (random.chance(0.05)) start_meeting(array(), errand.clerks);
  if (random.chance(0.2)) sync();
  if (errand.n_hops == 0) return;
  --errand.n_hops;
  send_errand(array(), errand, random);
  if (random.chance(0.1)) send_errand(array(), errand, random);
}

Task Mayfly::wait(Errand errand) {
  const CollectionId array_id = array().id();
  remains->deliver(array_id, errand.token);
  const PeId other{(errand.token * 7 + 1) % tess::n_pes()};
  co_await epoch([&] { errand.clerks[other].send<&Clerk::pass>(errand.token % 5); });
  remains->trial.expect(canary_ == 4711, "a coroutine goes on in an element that was destroyed");
  if (errand.token % 3 == 0 && array().ended()) meet(errand.clerks);  // nothing waits for a result
  if (errand.token % 4 == 0) sync();
  if (errand.token % 5 == 0) start_meeting(array(), errand.clerks);
  if (errand.n_hops == 0) co_return;
  --errand.n_hops;
  Random random(mix(static_cast<std::uint64_t>(errand.token) ^ mix(remains->trial.seed())));
  send_errand(array(), errand, random);
}

void Mayfly::meet(GroupProxy<Clerk> clerks) {
  contribute(max, array().id().value, clerks[PeId{0}].target<&Clerk::met>());
}

void Clerk::flood(ArrayProxy<Mayfly> flies, Errand errand) {
  Random random(mix(static_cast<std::uint64_t>(errand.token * 64 + pe().value)));
  const auto n = random.below(8);
  for (std::uint64_t i = 0; i < n; ++i) send_errand(flies, errand, random);
  if (random.chance(0.5)) start_meeting(flies, group());
}

/// True if it has a balancer.
bool balance(const ArrayProxy<Mayfly>& flies, Random& random) {
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
    const std::lock_guard lock(remains->mutex);
    remains->periodic.insert(flies.id());
  }
  start_balancing(flies, options);
  return true;
}

Task live_and_end(GroupProxy<Clerk> clerks, std::uint64_t seed) {
  Random random(seed);
  const PeId other = any_pe(random);
  const Errand errand{clerks, static_cast<int>(random.below(1000)),
                      static_cast<int>(random.below(12))};
  ArrayProxy<Mayfly> flies;
  bool is_balanced = false;
  const auto make = [&] {
    flies = tess::create<Mayfly>(random.chance(0.7) ? range(remains->n_indices) : sparse);
    is_balanced = balance(flies, random);
  };
  const auto flood = [&] { clerks.broadcast<&Clerk::flood>(flies, errand); };
  const auto end = [&] { flies.destroy(); };
  const auto end_elsewhere = [&] { clerks[other].send<&Clerk::end>(flies, errand.token % 4); };
  const auto how = random.below(4);
  switch (how) {
    case 0:  // all in one epoch: nothing is left when it is done
      co_await epoch([&] {
        make();
        flood();
        end_elsewhere();
      });
      break;
    case 1:  // twice
      make();
      co_await epoch([&] {
        flood();
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
    default:  // in mid flood
      make();
      flood();
      co_await epoch(end);
      clerks.broadcast<&Clerk::check_end>(flies);
      co_return;
  }
  clerks.broadcast<&Clerk::check_end>(flies);
  const std::lock_guard lock(remains->mutex);
  remains->over[flies.id()] = true;
  // A balancer's migrations belong to no epoch of the user: elements may arrive, and end, later.
  remains->trial.expect(is_balanced || remains->alive[flies.id()] == 0, remains->alive[flies.id()],
                        " elements outlive their array, way ", how);
}

Task all_lives(GroupProxy<Clerk> clerks, int n_lives, std::uint64_t seed) {
  for (int life = 0; life < n_lives; ++life)
    co_await live_and_end(clerks, mix(seed + static_cast<unsigned>(life)));
}

Task live_and_end_often(int n_lives, std::uint64_t seed) {
  const auto clerks = create_group<Clerk>();
  co_await epoch([&] { const Task lives = all_lives(clerks, n_lives, seed); });
  constexpr int most_looks = 5000;
  int n_looks = 0;
  do {
    co_await epoch([&] { clerks.broadcast<&Clerk::count_collections>(); });
  } while (!(remains->n_alive() == 0 && remains->all_forgotten()) && n_looks++ < most_looks);
  remains->trial.expect(remains->n_alive() == 0, remains->n_alive(), " elements are left");
  remains->trial.expect(remains->all_forgotten(), "a PE still knows a collection that has ended");
  co_await epoch([&] { clerks.destroy(); });
  clerks.destroy();
}

}  // namespace

void destroyed(Trial& trial) {
  Remains here{trial};
  here.n_indices = trial.draw(1, 20);
  here.end_chance = trial.draw(0, 2) * 0.01;
  remains = &here;
  const int n_lives = trial.draw(1, 6);
  const std::uint64_t seed = trial.random()();
  const Ending ending = trial.run([&]() -> Task { return live_and_end_often(n_lives, seed); });
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, ": ", ending.report);
  int n_lost = 0, n_dead = 0;
  for (const int delivered : here.delivered) {
    trial.expect(delivered <= 1, "a message was delivered ", delivered, " times");
    n_lost += delivered == 0 ? 1 : 0;
  }
  if (const std::size_t at = ending.report.find("tessera: "); at != std::string::npos)
    n_dead = std::atoi(ending.report.c_str() + at + 9);
  trial.expect(n_dead >= n_lost && n_dead <= n_lost + here.n_broadcasts, n_lost,
               " messages were lost, ", n_dead, " counted, of ", here.n_broadcasts, " broadcasts");
}

}  // namespace tess::fuzz
