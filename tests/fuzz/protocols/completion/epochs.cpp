// Random trees of messages inside nested and concurrent epochs: calls, demand creation, broadcasts,
// reductions, coroutines that wait for messages and for inner epochs, migrations. The oracle counts
// the remaining work of each epoch; it must be zero when the epoch's await returns.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>

namespace tess::fuzz {
namespace {

struct EpochRecord {
  int n_elements = 0;
  double move_chance = 0;
  std::vector<int> due{};     // by epoch: begun and not done
  std::vector<int> parent{};  // by epoch
  int n_returned = 0;

  int open(int outer) {
    const std::lock_guard lock(oracle);
    due.push_back(0);
    parent.push_back(outer);
    return static_cast<int>(due.size()) - 1;
  }
  void add(int epoch, int n) {
    const std::lock_guard lock(oracle);
    for (; epoch >= 0; epoch = parent[static_cast<std::size_t>(epoch)])
      due[static_cast<std::size_t>(epoch)] += n;
  }
  void returned(int epoch) {
    const std::lock_guard lock(oracle);
    ++n_returned;
    const int left = due[static_cast<std::size_t>(epoch)];
    expect(left == 0, "epoch ", epoch, " returned with ", left, " things to do");
  }
};
EpochRecord* epoch_record = nullptr;

/// A node of the tree: its epoch, and the number of nodes that may expand from it.
struct TreeNode {
  int epoch = 0;
  int energy = 0;
  std::uint64_t seed = 0;
};
struct EpochNote {
  int key = 0;
  int epoch = 0;
};

class TreeElement : public Chare<TreeElement, Index1> {
 public:
  void expand(TreeNode node) {
    split(node, 3);
    done(node.epoch);
  }
  /// Waits for a note that another element sends, then grows.
  Task wait(TreeNode node) {
    const int key = static_cast<int>(node.seed % 1000000);
    epoch_record->add(node.epoch, 1);
    array()[{(index().x + 1) % epoch_record->n_elements}].send<&TreeElement::write>(
        EpochNote{key, node.epoch}, index().x);
    Random random(mix(node.seed));
    for (int n_notes = 1 + draw(random, 2); n_notes > 1; --n_notes) {
      epoch_record->add(node.epoch, 1);
      array()[{0}].send<&TreeElement::write>(EpochNote{key, node.epoch}, index().x);
      co_await notes_.take(key);
    }
    co_await notes_.take(key);
    split(node, 2);
    done(node.epoch);
  }
  void write(EpochNote note, int to) {
    epoch_record->add(note.epoch, 1);
    array()[{to}].send<&TreeElement::read>(note);
    done(note.epoch);
  }
  void read(EpochNote note) {
    notes_.put(note);
    done(note.epoch);
  }
  /// An epoch within an epoch.
  Task nest(TreeNode node) {
    const int inner = epoch_record->open(node.epoch);
    co_await inside(inner, node);
    epoch_record->returned(inner);
    split(node, 2);
    done(node.epoch);
  }
  /// A broadcast: all elements give to one reduction, its result is a call of this element again.
  void gather(TreeNode node) {
    contribute(sum, std::array<std::int64_t, 2>{1, node.epoch},
               array()[{0}].target<&TreeElement::gathered>());
    Random random(mix(node.seed ^ static_cast<std::uint64_t>(index().x)));
    move_by_chance(random);
    done(node.epoch);
  }
  void gathered(std::array<std::int64_t, 2> sums) {
    const auto [n, epochs] = sums;
    expect(n == epoch_record->n_elements, "a reduction has ", n, " contributions");
    done(static_cast<int>(epochs / n));
  }

  void serialize(auto& ar) { ar(notes_); }

  /// Work of this epoch was begun or is done. (Not while its children are yet to be counted.)
  static void done(int epoch) { epoch_record->add(epoch, -1); }

 private:
  Task inside(int inner, TreeNode node) {
    co_await epoch([&] { split(TreeNode{inner, node.energy / 2, mix(node.seed)}, 3); });
  }
  void move_by_chance(Random& random) {
    if (random.chance(epoch_record->move_chance)) migrate_to(any_pe(random));
  }
  /// Up to n_most children, which share the energy.
  void split(TreeNode node, int n_most) {
    Random random(mix(node.seed ^ 0x73706c6974U));
    move_by_chance(random);
    const auto n = draw(random, n_most + 1);
    for (int k = 0; k < n && node.energy > 0; ++k) {
      const TreeNode child{node.epoch, (node.energy - 1) / n, random()};
      const Index to{draw(random, epoch_record->n_elements)};
      const auto element = array()[to];
      switch (random.below(10)) {
        case 0:
          epoch_record->add(node.epoch, 1);
          element.send<&TreeElement::wait>(child);
          break;
        case 1:
          epoch_record->add(node.epoch, 1);
          element.send<&TreeElement::nest>(child);
          break;
        case 2:
          epoch_record->add(node.epoch, epoch_record->n_elements + 1);
          array().broadcast<&TreeElement::gather>(child);
          break;
        case 3:
          epoch_record->add(node.epoch, 1);
          element.send_or_create_home<&TreeElement::expand>(child);
          break;
        default:
          epoch_record->add(node.epoch, 1);
          element.send<&TreeElement::expand>(child);
      }
    }
  }

  Mailbox<&EpochNote::key> notes_;
};

/// Several at once: the member on each PE opens one.
class Opener : public Group<Opener> {
 public:
  Task open(ArrayProxy<TreeElement> array, TreeNode node) {
    const std::uint64_t seed = mix(node.seed + static_cast<std::uint64_t>(pe().value));
    for (int k = 0; k < 2; ++k) {
      const int tag = epoch_record->open(node.epoch);
      co_await epoch([&] {
        epoch_record->add(tag, 1);
        array[{static_cast<int>(seed % static_cast<std::uint64_t>(epoch_record->n_elements))}]
            .send<&TreeElement::expand>(
                TreeNode{tag, node.energy, mix(seed + static_cast<unsigned>(k))});
      });
      epoch_record->returned(tag);
    }
  }
};

Task drive(TreeNode root) {
  const auto array = tess::create<TreeElement>(range(epoch_record->n_elements));
  const auto openers = create<Opener>(each_pe);
  const int all = epoch_record->open(-1);
  co_await epoch([] {});
  co_await epoch([&] {
    openers.broadcast<&Opener::open>(array, TreeNode{all, root.energy, root.seed});
  });
  epoch_record->returned(all);
}

}  // namespace

void epochs(Case& test) {
  EpochRecord here{test.draw(1, 12), 0.4 * test.draw(0, 2)};
  epoch_record = &here;
  const TreeNode root{0, test.draw(1, 60), test.random()};
  test.run_clean([&]() -> Task { return drive(root); });
  expect(here.n_returned == static_cast<int>(here.due.size()), here.n_returned, " of ",
         here.due.size(), " epochs returned");
}

}  // namespace tess::fuzz
