// Process groups and read-only data: every PE changes the object of its process, and those of
// others by messages. The oracle: nothing is lost, all PEs of a process see one object, and the
// table that was sent once to each process is the same everywhere.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/process_group.hpp"

namespace tess::fuzz {
namespace {

struct Ledger {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_each = 0;
};
const Ledger* ledger = nullptr;

class Purse {
 public:
  void add(std::int64_t amount) { total_ += amount; }
  [[nodiscard]] std::int64_t total() const { return total_; }

 private:
  std::int64_t total_ = 0;
};

struct Prices {
  std::vector<std::int64_t> each;
};

class Payer : public Group<Payer> {
 public:
  void pay(ProcessGroupProxy<Purse> purses, ReadOnly<Prices> prices) {
    Random random(mix(ledger->seed ^ static_cast<std::uint64_t>(pe().value + 1)));
    const auto n_processes = static_cast<std::uint64_t>(tess::machine().n_processes());
    for (std::size_t i = 0; i < static_cast<std::size_t>(ledger->n_each); ++i) {
      const std::int64_t price = prices->each[i];
      ledger->trial.expect(price == static_cast<std::int64_t>(i), "price ", i, " is ", price);
      if (random.chance(0.5)) {
        purses.write([price](Purse& purse) { purse.add(price); });
      } else {
        const ProcessId to{static_cast<std::int32_t>(random.below(n_processes))};
        purses[to].send<&Purse::add>(price);
      }
    }
  }
  void sum_up(ProcessGroupProxy<Purse> purses, Callback<std::int64_t> target) {
    const bool first = tess::machine().is_first_of_process(pe());
    const std::int64_t total = purses.read([](const Purse& purse) { return purse.total(); });
    contribute(sum, first ? total : 0, std::move(target));
  }
};

Task pay_all(std::int64_t expected) {
  ProcessGroupProxy<Purse> purses;
  ReadOnly<Prices> prices;
  co_await epoch([&] {
    purses = create_process_group<Purse>();
    Prices made;
    for (int i = 0; i < ledger->n_each; ++i) made.each.push_back(i);
    prices = create_read_only(std::move(made));
  });
  const auto payers = create_group<Payer>();
  co_await epoch([&] {
    payers.broadcast<&Payer::pay>(purses, prices);
    purses.broadcast<&Purse::add>(1);
  });
  const std::int64_t sum = co_await payers.reduce<&Payer::sum_up>(purses);
  const std::int64_t all = expected + tess::machine().n_processes();
  ledger->trial.expect(sum == all, "the purses hold ", sum, ", not ", all);
  purses.destroy();
  prices.destroy();
}

}  // namespace

void process_groups(Trial& trial) {
  const Ledger here{trial, trial.seed(), trial.draw(1, 60)};
  ledger = &here;
  const std::int64_t n = here.n_each;
  trial.run_clean([&] { return pay_all(trial.n_pes() * n * (n - 1) / 2); });
}

}  // namespace tess::fuzz
