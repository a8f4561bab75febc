// Elements that come and go: on each PE an agent creates on demand, inserts, destroys and sends,
// all at once and to the same indices. The oracle: an index has at most one element at a time, and
// each message is delivered once, ends an element, or is counted as a dead letter.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <numeric>

namespace tess::fuzz {
namespace {

struct Population {
  Trial& trial;
  std::mutex mutex{};
  std::vector<int> delivered{};  // by token
  std::vector<int> alive{};      // by index
  std::vector<int> found{};
  std::vector<std::uint64_t> dead_letters{};  // by PE
  int n_sent = 0;                             // tokens and destructions
  int n_ended = 0;
  int n_agents_done = 0;

  /// True if all messages of the agents have been delivered or counted.
  bool is_settled() {
    const std::lock_guard lock(mutex);
    return n_agents_done == trial.n_pes() &&
           n_sent == n_ended + std::accumulate(delivered.begin(), delivered.end(), 0) +
                         static_cast<int>(std::accumulate(dead_letters.begin(), dead_letters.end(),
                                                          std::uint64_t{0}));
  }
};
Population* population = nullptr;

/// An element of one of the three kinds of arrays.
template <DeadLetters Mode>
class Mortal : public Chare<Mortal<Mode>, Index2> {
 public:
  static constexpr DeadLetters dead_letters = Mode;

  Mortal() { begin(); }
  explicit Mortal(int number) {
    begin();
    population->trial.expect(number == this->index().x, "element ", number,
                             " is created elsewhere");
  }
  Mortal(const Mortal&) = delete;
  Mortal& operator=(const Mortal&) = delete;
  ~Mortal() override {
    const std::lock_guard lock(population->mutex);
    --population->alive[at()];
    if (ended_) ++population->n_ended;
  }

  /// Hides the base's function: the oracle must tell an end from a migration.
  void destroy() {
    ended_ = true;
    Chare<Mortal<Mode>, Index2>::destroy();
  }

  void take(int token) {
    Random random(mix(static_cast<std::uint64_t>(token) ^ population->trial.seed()));
    if (random.chance(0.3)) this->migrate_to(any_pe(random));
    ++n_taken_;
    const std::lock_guard lock(population->mutex);
    ++population->delivered[static_cast<std::size_t>(token)];
  }
  void appear() {
    const std::lock_guard lock(population->mutex);
    ++population->found[at()];
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_taken_);
  }

 private:
  [[nodiscard]] std::size_t at() const { return static_cast<std::size_t>(this->index().x); }
  void begin() {
    const std::lock_guard lock(population->mutex);
    population->trial.expect(++population->alive[at()] == 1, "index ", at(), " has two elements");
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
  using Element = Mortal<Mode>;

  void act(ArrayProxy<Element> array, Orders orders) {
    Random random(
        mix(orders.seed ^ static_cast<std::uint64_t>(orders.n_steps * 64 + this->pe().value)));
    const auto i = static_cast<int>(random.below(static_cast<std::uint64_t>(orders.n_indices)));
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
      const std::lock_guard lock(population->mutex);
      ++population->n_agents_done;
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
  void mend(ArrayProxy<Element> array, int n_indices) {
    const std::int32_t n_pes = tess::n_pes();
    for (int i = 0; i < n_indices; ++i)
      if (i % n_pes == this->pe().value) array[{i, 1}].insert_if_absent(i);
    const std::lock_guard lock(population->mutex);
    population->dead_letters[static_cast<std::size_t>(this->pe().value)] =
        statistics().dead_letters;
  }

 private:
  static int token() {
    const std::lock_guard lock(population->mutex);
    ++population->n_sent;
    population->delivered.push_back(0);
    return static_cast<int>(population->delivered.size()) - 1;
  }
  static void count_destruction() {
    const std::lock_guard lock(population->mutex);
    ++population->n_sent;
  }
};

template <DeadLetters Mode>
Task drive(Orders orders) {
  const auto array = tess::create<Mortal<Mode>>(sparse);
  const auto agents = create_group<Agent<Mode>>();
  agents.template broadcast<&Agent<Mode>::act>(array, orders);
  const auto mend = [&] { agents.template broadcast<&Agent<Mode>::mend>(array, orders.n_indices); };
  constexpr int most_mends = 5000;
  int n_mends = 0;
  while (!population->is_settled() && n_mends++ < most_mends) co_await epoch(mend);
  population->trial.expect(population->is_settled(), "messages are lost");
  co_await epoch(mend);
  array.template broadcast<&Mortal<Mode>::appear>();
}

template <DeadLetters Mode>
Ending run(Trial& trial, Orders orders) {
  return trial.run([orders]() -> Task { return drive<Mode>(orders); });
}

}  // namespace

void lives(Trial& trial) {
  const Orders orders{trial.random()(), trial.draw(1, 12), trial.draw(5, 60)};
  const auto n = static_cast<std::size_t>(orders.n_indices);
  Population here{trial};
  here.alive.assign(n, 0);
  here.found.assign(n, 0);
  here.dead_letters.assign(static_cast<std::size_t>(trial.n_pes()), 0);
  population = &here;
  const int mode = trial.draw(0, 2);
  const Ending ending = mode == 0   ? run<DeadLetters::report>(trial, orders)
                        : mode == 1 ? run<DeadLetters::recreate>(trial, orders)
                                    : run<DeadLetters::wait>(trial, orders);
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, "; ", ending.report);
  const auto n_dead =
      std::accumulate(here.dead_letters.begin(), here.dead_letters.end(), std::uint64_t{0});
  const std::string dead =
      n_dead == 0   ? ""
      : n_dead == 1 ? "tessera: 1 message to an element that had been destroyed was not delivered\n"
                    : text("tessera: ", n_dead,
                           " messages to elements that had been destroyed were not delivered\n");
  trial.expect(ending.report == dead, "the report is not that of ", n_dead, ": ", ending.report);
  trial.expect(mode == 0 || n_dead == 0, "dead letters in an array that has none: ", n_dead);
  for (const int delivered : here.delivered)
    trial.expect(delivered <= 1, "a message was delivered ", delivered, " times");
  for (std::size_t i = 0; i < n; ++i)
    trial.expect(here.found[i] == 1, "index ", i, " has ", here.found[i], " elements at the end");
}

}  // namespace tess::fuzz
