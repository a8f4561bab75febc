// All PEs send one another more messages than memory holds, some of them only when there is room. The memory for
// messages between processes is drawn from the seed, down to one message. The oracle: every message
// arrives; a process holds no more of one sender's messages than the budget allows; a producer that
// waits for room has at most one more message waiting; epochs wait for messages that are held back.
#include "runtime/more/room.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct FlowRecord {
  int n_messages = 0, most_numbers = 0;
  bool asks_for_room = false;
  std::uint64_t seed = 0;
  std::uint64_t memory_bytes = 0;  // for messages between processes
  std::atomic<int> n_arrived{0};
  std::vector<std::uint64_t> held{};  // bytes unpacked and not yet run: sender × process

  void holds(PeId sender, ProcessId process, std::uint64_t n_bytes, bool more) {
    const std::lock_guard lock(oracle);
    const Machine& machine = tess::machine();
    held.resize(static_cast<std::size_t>(machine.n_pes() * machine.n_processes()));
    std::uint64_t& now =
        held[static_cast<std::size_t>(sender.value * machine.n_processes() + process.value)];
    now = more ? now + n_bytes : now - n_bytes;
    const std::uint64_t limit =
        memory_bytes / 2 / static_cast<std::uint64_t>(machine.pes_per_process()) + 16;
    const std::uint64_t largest = static_cast<std::uint64_t>(most_numbers) * sizeof(double) + 200;
    expect(now < limit + largest, process, " holds ", now, " bytes of ", sender);
  }
};
FlowRecord* flow_record = nullptr;

struct Load {
  PeId sender{};
  std::vector<double> values;
  bool packed = false;

  [[nodiscard]] std::uint64_t n_bytes() const { return values.size() * sizeof(double); }
  using GivesMembers = void;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(sender, values);
    if constexpr (Ar::is_reading) {
      if (tess::my_pe() == sender) return;  // CHECKS=all: the sender reads what it is about to send
      packed = true;
      flow_record->holds(sender, tess::machine().process_of(tess::my_pe()), n_bytes(), true);
    }
  }
};

class Producer : public Group<Producer> {
 public:
  Task produce() {
    Random random(mix(flow_record->seed + static_cast<std::uint64_t>(pe().value)));
    const auto n_pes = static_cast<std::uint64_t>(tess::n_pes());
    const PeId fixed{static_cast<std::int32_t>(random.below(n_pes))};
    for (int i = 0; i < flow_record->n_messages; ++i) {
      const PeId to =
          random.chance(0.5) ? fixed : PeId{static_cast<std::int32_t>(random.below(n_pes))};
      if (flow_record->asks_for_room) {
        co_await room(group()[to]);
        expect(has_room(to), "a producer goes on without room");
      }
      Load load{pe(), {}};
      load.values.assign(random.below(static_cast<std::uint64_t>(flow_record->most_numbers)), 2.5);
      group()[to].send<&Producer::consume>(std::move(load));
    }
  }
  void consume(Load load) {
    (void)charge(std::chrono::milliseconds(1));  // slower than the messages arrive
    if (load.packed)
      flow_record->holds(load.sender, tess::machine().process_of(pe()), load.n_bytes(), false);
    for (const double value : load.values) expect(value == 2.5, "a value was garbled on its way");
    ++flow_record->n_arrived;
  }
};

Task produce_twice(FlowRecord& here) {
  GroupProxy<Producer> producers;
  // A message to a group that is not known yet counts as run for the memory budget, so create the
  // group first.
  co_await epoch([&] { producers = create<Producer>(each_pe); });
  const int each = here.n_messages * tess::n_pes();
  for (int round = 1; round <= 2; ++round) {
    co_await epoch([&] { producers.broadcast<&Producer::produce>(); });
    expect(here.n_arrived == round * each, "an epoch ended after ", here.n_arrived.load(), " of ",
           round * each, " messages");
  }
}

}  // namespace

void flow_control(Case& test) {
  FlowRecord here{test.draw(0, 40), test.draw(1, 100), test.draw(0, 1) != 0, test.random(),
                  test.machine.options.messages.memory_bytes};
  flow_record = &here;
  test.run_clean([&here] { return produce_twice(here); });
}

}  // namespace tess::fuzz
