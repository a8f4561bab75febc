// The sample of runtime/more/process_group.hpp, compiled and run on virtual processes of the simulated
// machine and on threads. tests/samples/check.py compares the text.
#include "runtime/more/process_group.hpp"

#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <map>
#include <mutex>
#include <set>

namespace {

class Cache {
 public:
  void put(int key, double value) { values_[key] = value; }
  double get(int key) const { return values_.at(key); }
  void check_size(int n) const { n_right += static_cast<int>(values_.size()) == n ? 1 : 0; }

  static std::atomic<int> n_right;

 private:
  std::map<int, double> values_;
};
std::atomic<int> Cache::n_right{0};

struct Table {
  std::vector<int> squares;
};

std::atomic<int> n_seen{0};
std::mutex tables_mutex;
std::set<const Table*> tables;

class TableReader : public tess::Group<TableReader> {
 public:
  void read(tess::ReadOnly<Table> table, tess::ProcessGroupProxy<Cache> caches) {
    for (int i = 0; i < 100; ++i)
      caches.write([&](Cache& cache) { cache.put(100 + i, pe().value); });
    n_seen += table->squares[3];
    const std::lock_guard lock(tables_mutex);
    tables.insert(&*table);
  }
};

tess::Task use_caches(double& result, int& n_processes) {
  tess::ProcessGroupProxy<Cache> caches;
  tess::ReadOnly<Table> table;
  n_processes = tess::machine().n_processes();
  const tess::ProcessId process{n_processes - 1};
  co_await tess::epoch([&] {
    caches = tess::create<Cache>(tess::each_process);
    table = tess::create_read_only(Table{{0, 1, 4, 9}});
  });
  co_await tess::epoch([&] {
    caches.write([](Cache& cache) { cache.put(3, 0.5); });  // this process, at once
    caches[process].send<&Cache::put>(4, 1.5);              // any process, by a message
    caches.broadcast<&Cache::put>(5, 2.5);
    caches.broadcast<&Cache::put>(3, 0.5);
    caches.broadcast<&Cache::put>(4, 1.5);
    tess::create<TableReader>(tess::each_pe).broadcast<&TableReader::read>(table, caches);
  });
  const double value = caches.read([](const Cache& cache) { return cache.get(3); });
  result = value;
  co_await tess::epoch([&] { caches.broadcast<&Cache::check_size>(103); });
  caches.destroy();
  table.destroy();
}

void check_caches(tess::Setup setup) {
  const int n_pes = setup.machine->n_pes();
  double result = 0;
  int n_processes = 0;
  Cache::n_right = 0;
  n_seen = 0;
  tables.clear();
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return use_caches(result, n_processes); }) == 0);
  CHECK(result == 0.5);
  CHECK(Cache::n_right == n_processes);
  CHECK(n_seen == 9 * n_pes);
  CHECK(static_cast<int>(tables.size()) == n_processes);
}

}  // namespace

TEST_CASE("a process group has one object per process, and read-only data one copy",
          "[runtime][process_group]") {
  check_caches({tess::make_threads_machine(3), {}});
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    tess::SimulatedOptions options;
    options.n_pes = 6;
    options.pes_per_process = std::array{1, 2, 3, 6}[seed % 4];
    options.cost = tess::Time(100);
    options.seed = seed;
    check_caches({tess::make_simulated_machine(options), {}});
  }
}
