// Priorities. Two programs, each with an exact oracle:
//
//   gathered   all elements move to one PE. It stays busy while all PEs send them messages, many by
//              way of the elements' former PEs, until all of these are in its queue. They run in the
//              order of their priorities. With forced migrations only their number is compared.
//   local      each PE sends messages to its own member. In real time they run in the order of
//              (priority, send), and nothing else comes between; under adversarial order all run.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <algorithm>

namespace tess::fuzz {
namespace {

struct Rush {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_elements = 0, n_messages = 0, n_priorities = 0;
  std::vector<std::int64_t> ran{};  // on the busy PE, which alone writes it
  bool receives = false;            // the busy PE receives messages for other PEs of its process
  std::atomic<int> n_ran{0};
  std::atomic<int> n_members{0};  // of this process, that sent to themselves
};
Rush* rush = nullptr;

/// Small ones, the least and the greatest, and 0, which is none.
std::int64_t draw_priority(Random& random, int n_priorities) {
  if (random.chance(0.1)) return expedited.value;
  if (random.chance(0.05)) return std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(n_priorities))) -
         n_priorities / 2;
}

class Sprinter : public Chare<Sprinter> {
 public:
  void run(std::int64_t priority, PeId busy) {
    ++rush->n_ran;
    if (busy.value < 0) return;  // the first messages
    was_moved_ = was_moved_ || tess::my_pe() != busy;
    if (!was_moved_) rush->ran.push_back(priority);
  }
  void run_tagged(std::int64_t priority, PeId busy) { run(priority, busy); }
  void move(PeId to) { migrate_to(to); }
  using EntryAttributes = Attributes<EntryMethod<&Sprinter::run_tagged, Priority{3}>>;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(was_moved_);
  }

 private:
  bool was_moved_ = false;
};

struct Round {
  ArrayProxy<Sprinter> sprinters;
  PeId busy{};
};

class Marshal : public Group<Marshal> {
 public:
  /// On the busy PE: all others send, and their messages arrive while this one works.
  void begin(Round round) {
    for (int at = 0; at < tess::n_pes(); ++at)
      if (PeId{at} != pe()) group()[PeId{at}].send<&Marshal::shout>(round);
    shout(round);
    const Machine& machine = tess::machine();
    rush->receives = machine.n_processes() > 1 && machine.pes_per_process() > 1 &&
                     machine.is_first_of_process(pe());
    (void)charge(std::chrono::hours(1));
  }
  void shout(Round round) {
    Random random(mix(rush->seed ^ static_cast<std::uint64_t>(pe().value + 1)));
    for (int i = 0; i < rush->n_messages; ++i) {
      const auto to = round.sprinters[{
          static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(rush->n_elements)))}];
      const std::int64_t priority = draw_priority(random, rush->n_priorities);
      if (priority == 3) {
        to.send<&Sprinter::run_tagged>(priority, round.busy);
      } else if (priority == 0 && random.chance(0.5)) {
        to.send<&Sprinter::run>(priority, round.busy);
      } else {
        to.with(Priority{priority}).send<&Sprinter::run>(priority, round.busy);
      }
    }
  }

  // The local program.

  void rush_here() {
    ++rush->n_members;
    Random random(mix(rush->seed ^ static_cast<std::uint64_t>(pe().value + 1000)));
    for (int i = 0; i < rush->n_messages; ++i)
      expected_.push_back({draw_priority(random, rush->n_priorities), i});
    for (const auto& [priority, number] : expected_)
      group()[pe()].with(Priority{priority}).send<&Marshal::note>(priority, number);
    std::sort(expected_.begin(), expected_.end());
  }
  void note(std::int64_t priority, int number) {
    seen_.push_back({priority, number});
    if (seen_.size() < expected_.size()) return;
    if (seen_.size() > expected_.size()) return rush->trial.expect(false, "a message runs twice");
    if (virtual_time()) std::sort(seen_.begin(), seen_.end());
    for (std::size_t i = 0; i < seen_.size(); ++i)
      rush->trial.expect(seen_[i] == expected_[i], "message ", i, " that ran has priority ",
                         seen_[i].first, ", not ", expected_[i].first);
    ++rush->n_ran;
  }

 private:
  [[nodiscard]] static bool virtual_time() { return tess::machine().virtual_time(); }

  std::vector<std::pair<std::int64_t, int>> expected_, seen_;
};

Task gather_and_rush(PeId busy) {
  const auto marshals = create_group<Marshal>();
  const auto sprinters = create<Sprinter>(range(rush->n_elements));
  // The first runs only teach the senders where the elements were.
  co_await epoch([&] { marshals.broadcast<&Marshal::shout>(Round{sprinters, PeId{-1}}); });
  co_await epoch([&] { sprinters.broadcast<&Sprinter::move>(busy); });
  co_await epoch([&] { marshals[busy].send<&Marshal::begin>(Round{sprinters, busy}); });
}

Task rush_everywhere() {
  const auto marshals = create_group<Marshal>();
  co_await epoch([&] { marshals.broadcast<&Marshal::rush_here>(); });
}

void check_gathered(Trial& trial, bool may_move) {
  const int n_all = 2 * trial.n_pes() * rush->n_messages;
  trial.expect(rush->n_ran == n_all, rush->n_ran.load(), " of ", n_all, " messages ran");
  if (trial.on_threads()) return;  // the busy PE is not busy there
  // Without forced migrations all messages of the second time run on the busy PE.
  const auto n_seen = static_cast<int>(rush->ran.size());
  trial.expect(may_move || n_seen == n_all / 2, n_seen, " of ", n_all / 2,
               " messages are compared");
  if (may_move) return;        // messages that are forwarded late come back after others
  if (rush->receives) return;  // while it works, messages by way of those PEs wait
  for (std::size_t i = 1; i < rush->ran.size(); ++i)
    trial.expect(rush->ran[i - 1] <= rush->ran[i], "priority ", rush->ran[i], " ran after ",
                 rush->ran[i - 1], ", as message ", i, " of ", rush->ran.size());
}

}  // namespace

void priorities(Trial& trial) {
  Rush here{trial, trial.seed()};
  rush = &here;
  here.n_elements = trial.draw(1, 20);
  here.n_messages = trial.draw(1, 40);
  here.n_priorities = trial.draw(1, 12);
  const PeId busy{trial.draw(0, trial.n_pes() - 1)};
  trial.give_memory();
  if (!trial.in_job()) {
    const bool may_move = trial.draw(0, 2) == 0;
    if (!may_move) trial.forbid_forced_migration();
    trial.run_clean([&] { return gather_and_rush(busy); });
    check_gathered(trial, may_move);
    here.n_ran = 0;
  }
  trial.run_clean([] { return rush_everywhere(); });
  trial.expect(here.n_members > 0 && here.n_ran == here.n_members, here.n_ran.load(), " of ",
               here.n_members.load(), " members saw all their messages");
}

}  // namespace tess::fuzz
