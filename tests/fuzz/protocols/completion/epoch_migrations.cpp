// Migrations, insertions and destructions inside an epoch. The oracle: when the epoch's await
// returns, every element is where it was sent, and destroyed elements are gone, also if a coroutine
// delayed them.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <map>

namespace tess::fuzz {
namespace {

struct Places {
  std::uint64_t seed = 0;
  int n_elements = 0;
  std::map<int, PeId> wanted{};  // where each element is to be
  std::map<int, PeId> seen{};
};
Places* places = nullptr;

class Mover : public Chare<Mover, Index1> {
 public:
  /// Goes to a drawn PE, by one of several ways.
  void go(int round) {
    Random random(mix(places->seed ^ static_cast<std::uint64_t>(round * 4096 + index().x)));
    const PeId to = any_pe(random);
    locked([&] { places->wanted[index().x] = to; });
    switch (random.below(3)) {
      case 0:
        migrate_to(to);
        break;
      case 1:
        array()[index()].migrate_to(to);
        break;
      default:
        array()[{(index().x + 1) % places->n_elements}].send<&Mover::push>(index().x, to);
    }
  }
  void push(int other, PeId to) { array()[{other}].migrate_to(to); }

  void end() { destroy(); }

  void serialize(auto& /*ar*/) {}
};

void check_places() {
  const std::lock_guard lock(oracle);
  for (const auto& [index, pe] : places->wanted) {
    const auto at = places->seen.find(index);
    expect(at != places->seen.end() && at->second == pe, "element ", index, " was sent to ", pe,
           " but is ", at == places->seen.end() ? text("nowhere") : text("on ", at->second));
  }
  expect(places->seen.size() == places->wanted.size(), "not as many elements as were sent");
  places->seen.clear();
}

/// Says which elements are on its PE.
class Watcher : public Group<Watcher> {
 public:
  void look(ArrayProxy<Mover> array) {
    for (int i = 0; i < places->n_elements; ++i) {
      if (array.here().find({i}) == nullptr) continue;
      const std::lock_guard lock(oracle);
      expect(places->seen.emplace(i, pe()).second, "two of ", i);
    }
  }
};

Task drive(int n_rounds) {
  const auto array = tess::create<Mover>(range(places->n_elements));
  const auto watchers = create<Watcher>(each_pe);
  for (int round = 0; round < n_rounds; ++round) {
    co_await epoch([&] { array.broadcast<&Mover::go>(round); });
    co_await epoch([&] { watchers.broadcast<&Watcher::look>(array); });
    check_places();
  }
  co_await epoch([&] { array.broadcast<&Mover::end>(); });
  co_await epoch([&] { watchers.broadcast<&Watcher::look>(array); });
  expect(places->seen.empty(), places->seen.size(), " elements outlive their end");
}

}  // namespace

void epoch_migrations(Case& test) {
  Places here{test.random(), test.draw(1, 16)};
  places = &here;
  test.machine.migration = 0;
  const int n_rounds = test.draw(1, 6);
  test.run_clean([&]() -> Task { return drive(n_rounds); });
}

}  // namespace tess::fuzz
