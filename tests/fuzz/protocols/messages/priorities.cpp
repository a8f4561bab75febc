// Priorities. Two programs, each with an exact oracle:
//
//   gathered   all elements move to one PE. It stays busy while all PEs send them messages, many by
//              way of the elements' former PEs, until all of these are in its queue. They run in the
//              order of their priorities. With forced migrations only their number is compared.
//   local      each PE sends messages to its own member. In real time they run in the order of
//              (priority, send), and nothing else comes between; under adversarial order all run.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>

namespace tess::fuzz {
namespace {

struct PriorityRecord {
  std::uint64_t seed = 0;
  int n_elements = 0, n_messages = 0, n_priorities = 0;
  std::vector<std::int64_t> ran{};  // on the busy PE, which alone writes it
  bool receives = false;            // the busy PE receives messages for other PEs of its process
  std::atomic<int> n_ran{0};
  std::atomic<int> n_members{0};  // of this process, that sent to themselves
};
PriorityRecord* priority_record = nullptr;

/// Small ones, the least and the greatest, and 0, which is none.
std::int64_t draw_priority(Random& random, int n_priorities) {
  if (random.chance(0.1)) return expedited.value;
  if (random.chance(0.05)) return std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(n_priorities))) -
         n_priorities / 2;
}

class GatheredElement : public Chare<GatheredElement> {
 public:
  void run(std::int64_t priority, PeId busy) {
    ++priority_record->n_ran;
    if (busy.value < 0) return;  // the first messages
    was_moved_ = was_moved_ || tess::my_pe() != busy;
    if (!was_moved_) priority_record->ran.push_back(priority);
  }
  void run_tagged(std::int64_t priority, PeId busy) { run(priority, busy); }
  void move(PeId to) { migrate_to(to); }
  using EntryAttributes = Attributes<EntryMethod<&GatheredElement::run_tagged, Priority{3}>>;

  void serialize(auto& ar) { ar(was_moved_); }

 private:
  bool was_moved_ = false;
};

struct SendOrder {
  ArrayProxy<GatheredElement> elements;
  PeId busy{};
};

class PriorityMember : public Group<PriorityMember> {
 public:
  /// On the busy PE: all others send, and their messages arrive while this one works.
  void begin(SendOrder order) {
    for (int at = 0; at < tess::n_pes(); ++at)
      if (PeId{at} != pe()) group()[PeId{at}].send<&PriorityMember::send_all>(order);
    send_all(order);
    const Machine& machine = tess::machine();
    priority_record->receives = machine.n_processes() > 1 && machine.pes_per_process() > 1 &&
                                machine.is_first_of_process(pe());
    (void)charge(std::chrono::hours(1));
  }
  void send_all(SendOrder order) {
    Random random(mix(priority_record->seed ^ static_cast<std::uint64_t>(pe().value + 1)));
    for (int i = 0; i < priority_record->n_messages; ++i) {
      const auto to = order.elements[{draw(random, priority_record->n_elements)}];
      const std::int64_t priority = draw_priority(random, priority_record->n_priorities);
      if (priority == 3) {
        to.send<&GatheredElement::run_tagged>(priority, order.busy);
      } else if (priority == 0 && random.chance(0.5)) {
        to.send<&GatheredElement::run>(priority, order.busy);
      } else {
        to.with(Priority{priority}).send<&GatheredElement::run>(priority, order.busy);
      }
    }
  }

  // The local program.

  void send_local() {
    ++priority_record->n_members;
    Random random(mix(priority_record->seed ^ static_cast<std::uint64_t>(pe().value + 1000)));
    for (int i = 0; i < priority_record->n_messages; ++i)
      expected_.push_back({draw_priority(random, priority_record->n_priorities), i});
    for (const auto& [priority, number] : expected_)
      group()[pe()].with(Priority{priority}).send<&PriorityMember::note>(priority, number);
    std::sort(expected_.begin(), expected_.end());
  }
  void note(std::int64_t priority, int number) {
    seen_.push_back({priority, number});
    if (seen_.size() < expected_.size()) return;
    if (seen_.size() > expected_.size()) return expect(false, "a message runs twice");
    if (virtual_time()) std::sort(seen_.begin(), seen_.end());
    for (std::size_t i = 0; i < seen_.size(); ++i)
      expect(seen_[i] == expected_[i], "message ", i, " that ran has priority ", seen_[i].first,
             ", not ", expected_[i].first);
    ++priority_record->n_ran;
  }

 private:
  [[nodiscard]] static bool virtual_time() { return tess::machine().virtual_time(); }

  std::vector<std::pair<std::int64_t, int>> expected_, seen_;
};

Task run_gathered(PeId busy) {
  const auto members = create<PriorityMember>(each_pe);
  const auto elements = create<GatheredElement>(range(priority_record->n_elements));
  // The first runs only teach the senders where the elements were.
  co_await epoch([&] {
    members.broadcast<&PriorityMember::send_all>(SendOrder{elements, PeId{-1}});
  });
  co_await epoch([&] { elements.broadcast<&GatheredElement::move>(busy); });
  co_await epoch([&] { members[busy].send<&PriorityMember::begin>(SendOrder{elements, busy}); });
}

Task run_local() {
  const auto members = create<PriorityMember>(each_pe);
  co_await epoch([&] { members.broadcast<&PriorityMember::send_local>(); });
}

void check_gathered(Case& test, bool may_move) {
  const int n_all = 2 * test.machine.pes * priority_record->n_messages;
  expect(priority_record->n_ran == n_all, priority_record->n_ran.load(), " of ", n_all,
         " messages ran");
  if (test.on == On::threads) return;  // the busy PE is not busy there
  // Without forced migrations all messages of the second time run on the busy PE.
  const auto n_seen = static_cast<int>(priority_record->ran.size());
  expect(may_move || n_seen == n_all / 2, n_seen, " of ", n_all / 2, " messages are compared");
  if (may_move) return;                   // messages that are forwarded late come back after others
  if (priority_record->receives) return;  // while it works, messages by way of those PEs wait
  for (std::size_t i = 1; i < priority_record->ran.size(); ++i)
    expect(priority_record->ran[i - 1] <= priority_record->ran[i], "priority ",
           priority_record->ran[i], " ran after ", priority_record->ran[i - 1], ", as message ", i,
           " of ", priority_record->ran.size());
}

}  // namespace

void priorities(Case& test) {
  PriorityRecord here{test.seed};
  priority_record = &here;
  here.n_elements = test.draw(1, 20);
  here.n_messages = test.draw(1, 40);
  here.n_priorities = test.draw(1, 12);
  const PeId busy{test.draw(0, test.machine.pes - 1)};
  test.machine.options.messages.memory_bytes = 32U << 20U;
  if (test.on != On::job) {
    const bool may_move = test.draw(0, 2) == 0;
    if (!may_move) test.machine.migration = 0;
    test.run_clean([&] { return run_gathered(busy); });
    check_gathered(test, may_move);
    here.n_ran = 0;
  }
  test.run_clean([] { return run_local(); });
  expect(here.n_members > 0 && here.n_ran == here.n_members, here.n_ran.load(), " of ",
         here.n_members.load(), " members saw all their messages");
}

}  // namespace tess::fuzz
