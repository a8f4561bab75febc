// The end of a run in the middle of work: messages, migrations, broadcasts, reductions, open
// epochs, waiting coroutines. The oracle: the exit code is the greatest that any PE passed; a PE
// that passed one runs no more user code; no memory is leaked.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct Flood {
  Trial& trial;
  int n_elements = 0;
  double exit_chance = 0;
  std::mutex mutex{};
  int greatest_code = -1;
  std::vector<char> exited{};  // by PE
  std::atomic<int> n_alive{0};
  std::atomic<bool> ripples{false};  // until the result is known: elements are created meanwhile

  /// The program runs on a PE.
  void runs(PeId pe) {
    const std::lock_guard lock(mutex);
    trial.expect(!exited[static_cast<std::size_t>(pe.value)], "code runs after exit() on ", pe);
  }
  void exit_here(PeId pe, int code) {
    {
      const std::lock_guard lock(mutex);
      greatest_code = std::max(greatest_code, code);
      exited[static_cast<std::size_t>(pe.value)] = 1;
    }
    tess::exit(code);
  }
};
Flood* flood = nullptr;

/// Something that must not leak.
struct Drop {
  Drop() { ++flood->n_alive; }
  Drop(const Drop& other) : seed(other.seed) { ++flood->n_alive; }
  Drop(Drop&& other) noexcept : seed(other.seed) { ++flood->n_alive; }
  Drop& operator=(const Drop&) = default;
  ~Drop() { --flood->n_alive; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(seed);
  }
  std::uint64_t seed = 0;
};
struct Parcel {
  int key = 0;
  Drop drop{};
};

class Wave : public Chare<Wave, Index1> {
 public:
  void splash(Drop drop) {
    flood->runs(tess::my_pe());
    Random random(drop.seed);
    if (random.chance(flood->exit_chance)) {
      flood->exit_here(tess::my_pe(), static_cast<int>(random.below(100)));
      return;
    }
    if (random.chance(0.2)) migrate_to(any_pe(random));
    Drop next;
    next.seed = random();
    const Index to{
        static_cast<int>(random.below(static_cast<std::uint64_t>(2 * flood->n_elements)))};
    switch (random.below(12)) {
      case 0:
        if (!flood->ripples.exchange(true)) array().broadcast<&Wave::ripple>(next);
        break;
      case 1:
        array()[index()].send<&Wave::wait>(next);
        break;
      case 2:
        array()[{to.x + 1000}].send<&Wave::splash>(
            next);  // there is no such element: the message waits
        array()[index()].send<&Wave::splash>(next);
        return;
      case 3:
        array()[index()].send<&Wave::nest>(next);  // continues inside an epoch
        return;
      case 4:
        array()[{to.x + 100}].send_or_create_here<&Wave::splash>(next);
        return;
      default:
        break;
    }
    array()[to].send_or_create_home<&Wave::splash>(next);
  }
  void ripple(Drop drop) {
    flood->runs(tess::my_pe());
    contribute(concatenate, std::vector<Drop>{drop}, array()[{0}].target<&Wave::gathered>());
  }
  void gathered(std::vector<Drop> /*drops*/) {
    flood->runs(tess::my_pe());
    flood->ripples = false;
  }
  Task wait(Drop drop) {
    const Parcel parcel = co_await parcels_.take(static_cast<int>(drop.seed % 3));
    flood->runs(tess::my_pe());
    (void)co_await parcels_.take(parcel.key + 1);
  }
  Task nest(Drop drop) {
    flood->runs(tess::my_pe());
    co_await inner(drop);
    flood->runs(tess::my_pe());
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(drop_, parcels_);
  }

 private:
  Task inner(Drop drop) {
    parcels_.put(Parcel{static_cast<int>(drop.seed % 2), drop});
    co_await epoch([&] { array()[index()].send<&Wave::splash>(drop); });
  }

  Drop drop_;
  Mailbox<&Parcel::key> parcels_;
};

}  // namespace

void flood_exit(Trial& trial) {
  Flood here{trial, trial.draw(1, 20), 1.0 / trial.draw(1, 400)};
  here.exited.assign(static_cast<std::size_t>(trial.n_pes()), 0);
  flood = &here;
  const int n_drops = trial.draw(1, 30);
  const std::uint64_t seed = trial.random()();
  const Ending ending = trial.run([&] {
    const auto array = tess::create<Wave>(range(here.n_elements));
    for (int i = 0; i < n_drops; ++i) {
      Drop drop;
      drop.seed = mix(seed + static_cast<unsigned>(i));
      array[{i % here.n_elements}].send<&Wave::splash>(drop);
    }
  });
  if (here.greatest_code >= 0) {
    trial.expect(ending.exit_code == here.greatest_code, "exit code ", ending.exit_code,
                 ", the greatest given is ", here.greatest_code);
    trial.expect(ending.report.empty(), ending.report);
  } else {
    trial.expect(ending.exit_code == 1, "no exit, no deadlock, but ", ending.exit_code);
  }
  trial.expect(here.n_alive == 0, here.n_alive.load(), " drops are left");
}

}  // namespace tess::fuzz
