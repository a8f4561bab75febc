// Random trees of messages inside nested and concurrent epochs: calls, demand creation, broadcasts,
// reductions, coroutines that wait for messages and for inner epochs, migrations. The oracle counts
// the remaining work of each epoch; it must be zero when the epoch's await returns.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <array>

namespace tess::fuzz {
namespace {

struct Ledger {
  Trial& trial;
  int n_elements = 0;
  double move_chance = 0;
  std::mutex mutex{};
  std::vector<int> due{};     // by epoch: begun and not done
  std::vector<int> parent{};  // by epoch
  int n_returned = 0;

  int open(int outer) {
    const std::lock_guard lock(mutex);
    due.push_back(0);
    parent.push_back(outer);
    return static_cast<int>(due.size()) - 1;
  }
  void add(int epoch, int n) {
    const std::lock_guard lock(mutex);
    for (; epoch >= 0; epoch = parent[static_cast<std::size_t>(epoch)])
      due[static_cast<std::size_t>(epoch)] += n;
  }
  void returned(int epoch) {
    const std::lock_guard lock(mutex);
    ++n_returned;
    const int left = due[static_cast<std::size_t>(epoch)];
    trial.expect(left == 0, "epoch ", epoch, " returned with ", left, " things to do");
  }
};
Ledger* ledger = nullptr;

/// A node of the tree: its epoch, and the number of nodes that may grow from it.
struct Twig {
  int epoch = 0;
  int energy = 0;
  std::uint64_t seed = 0;
};
struct Note {
  int key = 0;
  int epoch = 0;
};

class Branch : public Chare<Branch, Index1> {
 public:
  void grow(Twig twig) {
    split(twig, 3);
    done(twig.epoch);
  }
  /// Waits for a note that another element sends, then grows.
  Task wait(Twig twig) {
    const int key = static_cast<int>(twig.seed % 1000000);
    ledger->add(twig.epoch, 1);
    array()[{(index().x + 1) % ledger->n_elements}].send<&Branch::write>(Note{key, twig.epoch},
                                                                         index().x);
    Random random(mix(twig.seed));
    for (int n_notes = 1 + static_cast<int>(random.below(2)); n_notes > 1; --n_notes) {
      ledger->add(twig.epoch, 1);
      array()[{0}].send<&Branch::write>(Note{key, twig.epoch}, index().x);
      co_await notes_.take(key);
    }
    co_await notes_.take(key);
    split(twig, 2);
    done(twig.epoch);
  }
  void write(Note note, int to) {
    ledger->add(note.epoch, 1);
    array()[{to}].send<&Branch::read>(note);
    done(note.epoch);
  }
  void read(Note note) {
    notes_.put(note);
    done(note.epoch);
  }
  /// An epoch within an epoch.
  Task nest(Twig twig) {
    const int inner = ledger->open(twig.epoch);
    co_await inside(inner, twig);
    ledger->returned(inner);
    split(twig, 2);
    done(twig.epoch);
  }
  /// A broadcast: all elements give to one reduction, its result is a call of this element again.
  void gather(Twig twig) {
    contribute(sum, std::array<std::int64_t, 2>{1, twig.epoch},
               array()[{0}].target<&Branch::gathered>());
    Random random(mix(twig.seed ^ static_cast<std::uint64_t>(index().x)));
    wander(random);
    done(twig.epoch);
  }
  void gathered(std::array<std::int64_t, 2> sums) {
    const auto [n, epochs] = sums;
    ledger->trial.expect(n == ledger->n_elements, "a reduction has ", n, " contributions");
    done(static_cast<int>(epochs / n));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(notes_);
  }

  /// Work of this epoch was begun or is done. (Not while its children are yet to be counted.)
  static void done(int epoch) { ledger->add(epoch, -1); }

 private:
  Task inside(int inner, Twig twig) {
    co_await epoch([&] { split(Twig{inner, twig.energy / 2, mix(twig.seed)}, 3); });
  }
  void wander(Random& random) {
    if (random.chance(ledger->move_chance)) migrate_to(any_pe(random));
  }
  /// Up to n_most children, which share the energy.
  void split(Twig twig, int n_most) {
    Random random(mix(twig.seed ^ 0x73706c6974U));
    wander(random);
    const auto n = static_cast<int>(random.below(static_cast<std::uint64_t>(n_most + 1)));
    for (int k = 0; k < n && twig.energy > 0; ++k) {
      const Twig child{twig.epoch, (twig.energy - 1) / n, random()};
      const Index to{
          static_cast<int>(random.below(static_cast<std::uint64_t>(ledger->n_elements)))};
      const auto element = array()[to];
      switch (random.below(10)) {
        case 0:
          ledger->add(twig.epoch, 1);
          element.send<&Branch::wait>(child);
          break;
        case 1:
          ledger->add(twig.epoch, 1);
          element.send<&Branch::nest>(child);
          break;
        case 2:
          ledger->add(twig.epoch, ledger->n_elements + 1);
          array().broadcast<&Branch::gather>(child);
          break;
        case 3:
          ledger->add(twig.epoch, 1);
          element.send_or_create_home<&Branch::grow>(child);
          break;
        default:
          ledger->add(twig.epoch, 1);
          element.send<&Branch::grow>(child);
      }
    }
  }

  Mailbox<&Note::key> notes_;
};

/// Several at once: the member on each PE opens one.
class Opener : public Group<Opener> {
 public:
  Task open(ArrayProxy<Branch> array, Twig twig) {
    const std::uint64_t seed = mix(twig.seed + static_cast<std::uint64_t>(pe().value));
    for (int k = 0; k < 2; ++k) {
      const int tag = ledger->open(twig.epoch);
      co_await epoch([&] {
        ledger->add(tag, 1);
        array[{static_cast<int>(seed % static_cast<std::uint64_t>(ledger->n_elements))}]
            .send<&Branch::grow>(Twig{tag, twig.energy, mix(seed + static_cast<unsigned>(k))});
      });
      ledger->returned(tag);
    }
  }
};

Task drive(Twig root) {
  const auto array = tess::create<Branch>(range(ledger->n_elements));
  const auto openers = create_group<Opener>();
  const int all = ledger->open(-1);
  co_await epoch([] {});
  co_await epoch([&] {
    openers.broadcast<&Opener::open>(array, Twig{all, root.energy, root.seed});
  });
  ledger->returned(all);
}

}  // namespace

void epochs(Trial& trial) {
  Ledger here{trial, trial.draw(1, 12), 0.4 * trial.draw(0, 2)};
  ledger = &here;
  const Twig root{0, trial.draw(1, 60), trial.random()()};
  trial.run_clean([&]() -> Task { return drive(root); });
  trial.expect(here.n_returned == static_cast<int>(here.due.size()), here.n_returned, " of ",
               here.due.size(), " epochs returned");
}

}  // namespace tess::fuzz
