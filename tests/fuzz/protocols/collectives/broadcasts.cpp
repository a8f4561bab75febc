// Broadcasts from all PEs to elements that move, come and go. The oracle: all elements receive the
// broadcasts of their life in one order, each once; an element that lives throughout receives all.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>

namespace tess::fuzz {
namespace {

constexpr int most_created = 100;

struct Heard {
  std::uint64_t seed = 0;
  int n_first = 0;
  double create_chance = 0, destroy_chance = 0, move_chance = 0;
  int n_created = 0;
  std::vector<std::pair<int, std::vector<int>>> lists{};  // index, broadcasts met
  std::vector<int> ended{};                               // indices

  void add(int index, const std::vector<int>& met) {
    locked([&] { lists.emplace_back(index, met); });
  }
};
Heard* heard = nullptr;

class Listener : public Chare<Listener, Index1> {
 public:
  Listener() = default;
  explicit Listener(bool created) : created_(created) {}

  /// An element created for this message must not end before it: it would be created again.
  void create() { created_ = true; }

  void hear(int id) {
    met_.push_back(id);
    Random random(mix(heard->seed ^ mix(static_cast<std::uint64_t>(id * 4096 + index().x))));
    if (random.chance(heard->create_chance)) create_child(random);
    if (random.chance(heard->move_chance)) move(random);
    if (index().x != 0 && created_ && random.chance(heard->destroy_chance)) {
      heard->add(index().x, met_);
      const std::lock_guard lock(oracle);
      heard->ended.push_back(index().x);
      destroy();
    }
  }
  /// The last of all broadcasts.
  void tell() { heard->add(index().x, met_); }

  void serialize(auto& ar) { ar(created_, met_); }

 private:
  void move(Random& random) {
    if (heard->destroy_chance > 0 || random.chance(0.5)) {  // otherwise it would be a dead letter
      migrate_to(any_pe(random));
    } else {
      array()[index()].migrate_to(any_pe(random));
    }
  }
  void create_child(Random& random) {
    int index = 0;
    {
      const std::lock_guard lock(oracle);
      if (heard->n_created >= most_created) return;
      index = heard->n_first + heard->n_created++;
    }
    if (random.chance(0.3)) {
      array()[{index}].insert_on(any_pe(random), true);
    } else if (random.chance(0.5)) {
      array()[{index}].send_or_create_here<&Listener::create>();
    } else {
      array()[{index}].send_or_create_home<&Listener::create>();
    }
  }

  bool created_ = false;
  std::vector<int> met_;
};

/// On each PE: a chain of messages that broadcast now and then.
class Speaker : public Group<Speaker> {
 public:
  void speak(ArrayProxy<Listener> array, int n_left) {
    if (n_left == 0) return;
    array.broadcast<&Listener::hear>(pe().value * 1000 + n_left);
    group()[pe()].send<&Speaker::speak>(array, n_left - 1);
  }
};

Task drive(Range first, int n_each) {
  const auto array = tess::create<Listener>(first, true);
  const auto speakers = create<Speaker>(each_pe);
  co_await epoch([&] { speakers.broadcast<&Speaker::speak>(array, n_each); });
  array.broadcast<&Listener::tell>();
}

}  // namespace

void broadcasts(Case& test) {
  Heard here{test.random(), test.draw(1, 24)};
  heard = &here;
  const bool long_run = test.seed % 50 == 0;
  const int n_each = long_run ? 500 / test.machine.pes : test.draw(1, 12);
  // In a long run few elements are created per element that ends, so that the population stays
  // small.
  here.create_chance = long_run ? 0.002 : 0.1 * test.random.unit();
  here.destroy_chance = long_run ? 0.01 : test.draw(0, 1) * 0.1 * test.random.unit();
  here.move_chance = test.random.unit() * 0.6;
  test.run_clean([&]() -> Task { return drive(range(here.n_first), n_each); });

  const auto at_end = [&](int index) {
    return std::find(here.ended.begin(), here.ended.end(), index) == here.ended.end();
  };
  const auto first = std::find_if(here.lists.begin(), here.lists.end(),
                                  [](const auto& one) { return one.first == 0; });
  if (first == here.lists.end()) return expect(false, "element 0 told nothing");
  const std::vector<int> all = first->second;
  expect(all.size() == static_cast<std::size_t>(n_each * test.machine.pes), "element 0 met ",
         all.size(), " of ", n_each * test.machine.pes, " broadcasts");
  for (const auto& [index, met] : here.lists) {
    const auto begin = met.empty() ? all.end() : std::find(all.begin(), all.end(), met.front());
    const bool in_order = static_cast<std::size_t>(all.end() - begin) >= met.size() &&
                          std::equal(met.begin(), met.end(), begin);
    expect(in_order, "element ", index, " met broadcasts out of order or twice");
    if (index < here.n_first)
      expect(begin == all.begin(), "element ", index, " missed the first broadcasts");
    if (at_end(index) && in_order)
      expect(static_cast<std::size_t>(all.end() - begin) == met.size(), "element ", index,
             " missed the last broadcasts");
  }
  const auto n_lives = static_cast<std::size_t>(here.n_first + here.n_created);
  expect(here.lists.size() == n_lives, here.lists.size(), " of ", n_lives, " elements told");
}

}  // namespace tess::fuzz
