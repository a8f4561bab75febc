// All PEs flood one another with messages, some of them only when there is room. The memory for
// messages between processes is drawn from the seed, down to one message. The oracle: every message
// arrives; a process holds no more of one sender's messages than the budget allows; a producer that
// waits for room has at most one more message waiting; epochs wait for messages that are held back.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct Deluge {
  Trial& trial;
  int n_messages = 0, most_numbers = 0;
  bool asks_for_room = false;
  std::uint64_t seed = 0;
  std::atomic<int> n_arrived{0};
  std::mutex mutex{};
  std::vector<std::uint64_t> held{};  // bytes unpacked and not yet run: sender × process

  void holds(PeId sender, ProcessId process, std::uint64_t n_bytes, bool more) {
    const std::lock_guard lock(mutex);
    const Machine& machine = tess::machine();
    held.resize(static_cast<std::size_t>(machine.n_pes() * machine.n_processes()));
    std::uint64_t& now =
        held[static_cast<std::size_t>(sender.value * machine.n_processes() + process.value)];
    now = more ? now + n_bytes : now - n_bytes;
    const std::uint64_t limit =
        trial.message_memory() / 2 / static_cast<std::uint64_t>(machine.pes_per_process()) + 16;
    const std::uint64_t largest = static_cast<std::uint64_t>(most_numbers) * sizeof(double) + 200;
    trial.expect(now < limit + largest, process, " holds ", now, " bytes of ", sender);
  }
};
Deluge* deluge = nullptr;

struct Freight {
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
      deluge->holds(sender, tess::machine().process_of(tess::my_pe()), n_bytes(), true);
    }
  }
};

class Basin : public Group<Basin> {
 public:
  Task pour() {
    Random random(mix(deluge->seed + static_cast<std::uint64_t>(pe().value)));
    const auto n_pes = static_cast<std::uint64_t>(tess::n_pes());
    const PeId fixed{static_cast<std::int32_t>(random.below(n_pes))};
    for (int i = 0; i < deluge->n_messages; ++i) {
      const PeId to =
          random.chance(0.5) ? fixed : PeId{static_cast<std::int32_t>(random.below(n_pes))};
      if (deluge->asks_for_room) {
        co_await room(group()[to]);
        deluge->trial.expect(has_room(to), "a producer goes on without room");
      }
      Freight freight{pe(), {}};
      freight.values.assign(random.below(static_cast<std::uint64_t>(deluge->most_numbers)), 2.5);
      group()[to].send<&Basin::fall>(std::move(freight));
    }
  }
  void fall(Freight freight) {
    (void)charge(std::chrono::milliseconds(1));  // slower than the messages arrive
    if (freight.packed)
      deluge->holds(freight.sender, tess::machine().process_of(pe()), freight.n_bytes(), false);
    for (const double value : freight.values)
      deluge->trial.expect(value == 2.5, "a value was garbled on its way");
    ++deluge->n_arrived;
  }
};

Task flood_twice(Deluge& here) {
  GroupProxy<Basin> basins;
  // A message to a group that is not known yet counts as run for the memory budget, so create the
  // group first.
  co_await epoch([&] { basins = create_group<Basin>(); });
  const int each = here.n_messages * here.trial.n_pes();
  for (int round = 1; round <= 2; ++round) {
    co_await epoch([&] { basins.broadcast<&Basin::pour>(); });
    here.trial.expect(here.n_arrived == round * each, "an epoch ended after ",
                      here.n_arrived.load(), " of ", round * each, " messages");
  }
}

}  // namespace

void floods(Trial& trial) {
  Deluge here{trial, trial.draw(0, 40), trial.draw(1, 100), trial.draw(0, 1) != 0,
              trial.random()()};
  deluge = &here;
  trial.run_clean([&here] { return flood_twice(here); });
}

}  // namespace tess::fuzz
