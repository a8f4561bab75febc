// The end of a run in the middle of work: messages, migrations, broadcasts, reductions, open
// epochs, waiting coroutines. The oracle: the exit code is the greatest that any PE passed; a PE
// that passed one runs no more user code; no memory is leaked.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct ExitRecord {
  int n_elements = 0;
  double exit_chance = 0;
  int greatest_code = -1;
  std::vector<char> exited{};  // by PE
  std::atomic<int> n_alive{0};
  std::atomic<bool> reduces{false};  // until the result is known: elements are created meanwhile

  /// The program runs on a PE.
  void runs(PeId pe) {
    locked([&] {
      expect(!exited[static_cast<std::size_t>(pe.value)], "code runs after exit() on ", pe);
    });
  }
  void exit_here(PeId pe, int code) {
    {
      const std::lock_guard lock(oracle);
      greatest_code = std::max(greatest_code, code);
      exited[static_cast<std::size_t>(pe.value)] = 1;
    }
    tess::exit(code);
  }
};
ExitRecord* exit_record = nullptr;

/// Something that must not leak.
struct Counted {
  Counted() { ++exit_record->n_alive; }
  Counted(const Counted& other) : seed(other.seed) { ++exit_record->n_alive; }
  Counted(Counted&& other) noexcept : seed(other.seed) { ++exit_record->n_alive; }
  Counted& operator=(const Counted&) = default;
  ~Counted() { --exit_record->n_alive; }
  void serialize(auto& ar) { ar(seed); }
  std::uint64_t seed = 0;
};
struct Early {
  int key = 0;
  Counted counted{};
};

class LoadElement : public Chare<LoadElement, Index1> {
 public:
  void pass_on(Counted counted) {
    exit_record->runs(tess::my_pe());
    Random random(counted.seed);
    if (random.chance(exit_record->exit_chance)) {
      exit_record->exit_here(tess::my_pe(), draw(random, 100));
      return;
    }
    if (random.chance(0.2)) migrate_to(any_pe(random));
    Counted next;
    next.seed = random();
    const Index to{draw(random, 2 * exit_record->n_elements)};
    switch (random.below(12)) {
      case 0:
        if (!exit_record->reduces.exchange(true)) array().broadcast<&LoadElement::give>(next);
        break;
      case 1:
        array()[index()].send<&LoadElement::wait>(next);
        break;
      case 2:
        array()[{to.x + 1000}].send<&LoadElement::pass_on>(
            next);  // there is no such element: the message waits
        array()[index()].send<&LoadElement::pass_on>(next);
        return;
      case 3:
        array()[index()].send<&LoadElement::nest>(next);  // continues inside an epoch
        return;
      case 4:
        array()[{to.x + 100}].send_or_create_here<&LoadElement::pass_on>(next);
        return;
      default:
        break;
    }
    array()[to].send_or_create_home<&LoadElement::pass_on>(next);
  }
  void give(Counted counted) {
    exit_record->runs(tess::my_pe());
    contribute(concatenate, std::vector<Counted>{counted},
               array()[{0}].target<&LoadElement::gathered>());
  }
  void gathered(std::vector<Counted> /*objects*/) {
    exit_record->runs(tess::my_pe());
    exit_record->reduces = false;
  }
  Task wait(Counted counted) {
    const Early early = co_await early_.take(static_cast<int>(counted.seed % 3));
    exit_record->runs(tess::my_pe());
    (void)co_await early_.take(early.key + 1);
  }
  Task nest(Counted counted) {
    exit_record->runs(tess::my_pe());
    co_await inner(counted);
    exit_record->runs(tess::my_pe());
  }

  void serialize(auto& ar) { ar(drop_, early_); }

 private:
  Task inner(Counted counted) {
    early_.put(Early{static_cast<int>(counted.seed % 2), counted});
    co_await epoch([&] { array()[index()].send<&LoadElement::pass_on>(counted); });
  }

  Counted drop_;
  Mailbox<&Early::key> early_;
};

}  // namespace

void exit_under_load(Case& test) {
  ExitRecord here{test.draw(1, 20), 1.0 / test.draw(1, 400)};
  here.exited.assign(static_cast<std::size_t>(test.machine.pes), 0);
  exit_record = &here;
  const int n_chains = test.draw(1, 30);
  const std::uint64_t seed = test.random();
  const Result result = test.run([&] {
    const auto array = tess::create<LoadElement>(range(here.n_elements));
    for (int i = 0; i < n_chains; ++i) {
      Counted counted;
      counted.seed = mix(seed + static_cast<unsigned>(i));
      array[{i % here.n_elements}].send<&LoadElement::pass_on>(counted);
    }
  });
  if (here.greatest_code >= 0) {
    expect(result.exit_code == here.greatest_code, "exit code ", result.exit_code,
           ", the greatest given is ", here.greatest_code);
    expect(result.report.empty(), result.failure());
  } else {
    expect(result.exit_code == 1, "no exit, no deadlock, but ", result.exit_code);
  }
  expect(here.n_alive == 0, here.n_alive.load(), " objects are left");
}

}  // namespace tess::fuzz
