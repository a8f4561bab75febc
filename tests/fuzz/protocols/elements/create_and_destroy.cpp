// Elements that come and go: on each PE an agent creates on demand, inserts, destroys and sends,
// all at once and to the same indices. The oracle: an index has at most one element at a time, and
// each message is delivered once, ends an element, or is counted as a dead letter.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <numeric>

namespace tess::fuzz {
namespace {

struct LivesRecord {
  std::uint64_t seed = 0;
  int n_pes = 0;
  std::vector<int> delivered{};  // by token
  std::vector<int> alive{};      // by index
  std::vector<int> found{};
  std::vector<std::uint64_t> dead_letters{};  // by PE
  int n_sent = 0;                             // tokens and destructions
  int n_ended = 0;
  int n_agents_done = 0;

  /// True if all messages of the agents have been delivered or counted.
  bool is_settled() {
    const std::lock_guard lock(oracle);
    return n_agents_done == n_pes &&
           n_sent == n_ended + std::accumulate(delivered.begin(), delivered.end(), 0) +
                         static_cast<int>(std::accumulate(dead_letters.begin(), dead_letters.end(),
                                                          std::uint64_t{0}));
  }
};
LivesRecord* lives_record = nullptr;

/// An element of one of the three kinds of arrays.
template <DeadLetters Mode>
class Target : public Chare<Target<Mode>, Index2> {
 public:
  static constexpr DeadLetters dead_letters = Mode;

  Target() { begin(); }
  explicit Target(int number) {
    begin();
    expect(number == this->index().x, "element ", number, " is created elsewhere");
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;
  ~Target() override {
    const std::lock_guard lock(oracle);
    --lives_record->alive[at()];
    if (ended_) ++lives_record->n_ended;
  }

  /// Hides the base's function: the oracle must tell an end from a migration.
  void destroy() {
    ended_ = true;
    Chare<Target<Mode>, Index2>::destroy();
  }

  void take(int token) {
    Random random(mix(static_cast<std::uint64_t>(token) ^ lives_record->seed));
    if (random.chance(0.3)) this->migrate_to(any_pe(random));
    ++n_taken_;
    const std::lock_guard lock(oracle);
    ++lives_record->delivered[static_cast<std::size_t>(token)];
  }
  void appear() {
    locked([&] { ++lives_record->found[at()]; });
  }

  void serialize(auto& ar) { ar(n_taken_); }

 private:
  [[nodiscard]] std::size_t at() const { return static_cast<std::size_t>(this->index().x); }
  void begin() {
    locked([&] { expect(++lives_record->alive[at()] == 1, "index ", at(), " has two elements"); });
  }

  int n_taken_ = 0;
  bool ended_ = false;
};

struct Orders {
  std::uint64_t seed = 0;
  int n_indices = 0;
  int n_steps = 0;
};

/// On each PE: a chain of messages, each of which does one drawn thing.
template <DeadLetters Mode>
class Agent : public Group<Agent<Mode>> {
 public:
  using Element = Target<Mode>;

  void act(ArrayProxy<Element> array, Orders orders) {
    Random random(
        mix(orders.seed ^ static_cast<std::uint64_t>(orders.n_steps * 64 + this->pe().value)));
    const auto i = draw(random, orders.n_indices);
    const auto element = array[{i, 1}];
    switch (random.below(9)) {
      case 0:
      case 1:
        element.template send_or_create_here<&Element::take>(token());
        break;
      case 2:
      case 3:
        element.template send_or_create_home<&Element::take>(token());
        break;
      case 4:
        element.template send<&Element::take>(token());
        break;
      case 5:
        element.insert_if_absent(i);
        break;
      default:
        element.destroy();
        count_destruction();
    }
    if (orders.n_steps == 0) {
      const std::lock_guard lock(oracle);
      ++lives_record->n_agents_done;
      return;
    }
    --orders.n_steps;
    if (random.chance(0.4)) {
      act(array, orders);
    } else {
      this->group()[this->pe()].template send<&Agent::act>(array, orders);
    }
  }

  /// Creates missing elements, so that each index has one; records the number of dead letters.
  void fill_up(ArrayProxy<Element> array, int n_indices) {
    const std::int32_t n_pes = tess::n_pes();
    for (int i = 0; i < n_indices; ++i)
      if (i % n_pes == this->pe().value) array[{i, 1}].insert_if_absent(i);
    const std::lock_guard lock(oracle);
    lives_record->dead_letters[static_cast<std::size_t>(this->pe().value)] =
        statistics().dead_letters;
  }

 private:
  static int token() {
    const std::lock_guard lock(oracle);
    ++lives_record->n_sent;
    lives_record->delivered.push_back(0);
    return static_cast<int>(lives_record->delivered.size()) - 1;
  }
  static void count_destruction() {
    locked([&] { ++lives_record->n_sent; });
  }
};

template <DeadLetters Mode>
Task drive(Orders orders) {
  const auto array = tess::create<Target<Mode>>(sparse);
  const auto agents = create<Agent<Mode>>(each_pe);
  agents.template broadcast<&Agent<Mode>::act>(array, orders);
  const auto fill_up = [&] {
    agents.template broadcast<&Agent<Mode>::fill_up>(array, orders.n_indices);
  };
  constexpr int most_fills = 5000;
  int n_fills = 0;
  while (!lives_record->is_settled() && n_fills++ < most_fills) co_await epoch(fill_up);
  expect(lives_record->is_settled(), "messages are lost");
  co_await epoch(fill_up);
  array.template broadcast<&Target<Mode>::appear>();
}

template <DeadLetters Mode>
Result run(Case& test, Orders orders) {
  return test.run([orders]() -> Task { return drive<Mode>(orders); });
}

}  // namespace

void create_and_destroy(Case& test) {
  const Orders orders{test.random(), test.draw(1, 12), test.draw(5, 60)};
  const auto n = static_cast<std::size_t>(orders.n_indices);
  LivesRecord here{test.seed, test.machine.pes};
  here.alive.assign(n, 0);
  here.found.assign(n, 0);
  here.dead_letters.assign(static_cast<std::size_t>(test.machine.pes), 0);
  lives_record = &here;
  const int mode = test.draw(0, 2);
  const Result result = mode == 0   ? run<DeadLetters::report>(test, orders)
                        : mode == 1 ? run<DeadLetters::recreate>(test, orders)
                                    : run<DeadLetters::wait>(test, orders);
  expect_exit(result);
  const auto n_dead =
      std::accumulate(here.dead_letters.begin(), here.dead_letters.end(), std::uint64_t{0});
  expect(result.report.size() == (n_dead == 0 ? 0 : 1) &&
             static_cast<std::uint64_t>(n_not_delivered(result)) == n_dead,
         "the report is not that of ", n_dead, ": ", result.failure());
  expect(mode == 0 || n_dead == 0, "dead letters in an array that has none: ", n_dead);
  for (const int delivered : here.delivered)
    expect(delivered <= 1, "a message was delivered ", delivered, " times");
  for (std::size_t i = 0; i < n; ++i)
    expect(here.found[i] == 1, "index ", i, " has ", here.found[i], " elements at the end");
}

}  // namespace tess::fuzz
