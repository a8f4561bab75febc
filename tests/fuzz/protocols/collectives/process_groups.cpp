// Process groups and read-only data: every PE changes the object of its process, and those of
// others by messages. The oracle: nothing is lost, all PEs of a process see one object, and the
// table that was sent once to each process is the same everywhere.
#include "runtime/more/process_group.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

namespace tess::fuzz {
namespace {

struct ProcessDraws {
  std::uint64_t seed = 0;
  int n_each = 0;
};
const ProcessDraws* process_draws = nullptr;

class Total {
 public:
  void add(std::int64_t amount) { total_ += amount; }
  [[nodiscard]] std::int64_t total() const { return total_; }

 private:
  std::int64_t total_ = 0;
};

struct Table {
  std::vector<std::int64_t> each;
};

class Adder : public Group<Adder> {
 public:
  void add_some(ProcessGroupProxy<Total> totals, ReadOnly<Table> table) {
    Random random(mix(process_draws->seed ^ static_cast<std::uint64_t>(pe().value + 1)));
    const auto n_processes = static_cast<std::uint64_t>(tess::machine().n_processes());
    for (std::size_t i = 0; i < static_cast<std::size_t>(process_draws->n_each); ++i) {
      const std::int64_t value = table->each[i];
      expect(value == static_cast<std::int64_t>(i), "value ", i, " is ", value);
      if (random.chance(0.5)) {
        totals.write([value](Total& one) { one.add(value); });
      } else {
        const ProcessId to{static_cast<std::int32_t>(random.below(n_processes))};
        totals[to].send<&Total::add>(value);
      }
    }
  }
  void sum_up(ProcessGroupProxy<Total> totals, Callback<std::int64_t> target) {
    const bool first = tess::machine().is_first_of_process(pe());
    const std::int64_t total = totals.read([](const Total& one) { return one.total(); });
    contribute(sum, first ? total : 0, std::move(target));
  }
};

Task add_everywhere(std::int64_t expected) {
  ProcessGroupProxy<Total> totals;
  ReadOnly<Table> table;
  co_await epoch([&] {
    totals = create<Total>(each_process);
    Table made;
    for (int i = 0; i < process_draws->n_each; ++i) made.each.push_back(i);
    table = create_read_only(std::move(made));
  });
  const auto adders = create<Adder>(each_pe);
  co_await epoch([&] {
    adders.broadcast<&Adder::add_some>(totals, table);
    totals.broadcast<&Total::add>(1);
  });
  const std::int64_t sum = co_await adders.reduce<&Adder::sum_up>(totals);
  const std::int64_t all = expected + tess::machine().n_processes();
  expect(sum == all, "the totals hold ", sum, ", not ", all);
  totals.destroy();
  table.destroy();
}

}  // namespace

void process_groups(Case& test) {
  const ProcessDraws here{test.seed, test.draw(1, 60)};
  process_draws = &here;
  const std::int64_t n = here.n_each;
  test.run_clean([&] { return add_everywhere(test.machine.pes * n * (n - 1) / 2); });
}

}  // namespace tess::fuzz
