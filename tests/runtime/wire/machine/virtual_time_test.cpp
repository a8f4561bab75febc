// The times that the simulated machine reports, exactly: PEs work at the same time, busy time is
// messages and charged work, and an epoch costs little beside the messages that it counts.
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstdio>

namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds latency(1000), cost(100);

/// Runs `main` on a simulated machine of these options, with the cost and the latency above;
/// `lines` gets what --stats reports.
template <class Main>
int simulate(const std::string& options, Main main, std::vector<std::string>* lines = nullptr) {
  std::string option = "--sim=cost=100ns,latency=1us," + options;
  std::string program = "test";
  std::array<char*, 3> argv{program.data(), option.data(), nullptr};
  int argc = 2;
  tess::Setup setup = tess::take_options(argc, argv.data());
  setup.options.statistics = lines != nullptr;
  if (lines != nullptr)
    setup.options.report = [lines](const std::string& line) { lines->push_back(line); };
  return tess::run(setup, std::move(main));
}

/// PEs from PE 0 to the farthest in a tree of four children each.
std::int32_t depth_of(std::int32_t n_pes) {
  std::int32_t depth = 0;
  for (std::int32_t last = 0; last < n_pes - 1; last = 4 * last + 4) ++depth;
  return depth;
}

/// Works for a time that depends on its PE, and contributes that time to the reduction.
class Shift : public tess::Chare<Shift, tess::Index1> {
 public:
  void work(tess::Callback<std::int64_t> done) {
    tess::charge(work_of(tess::my_pe()));
    contribute(tess::sum, std::int64_t{1}, std::move(done));
  }
  static nanoseconds work_of(tess::PeId pe) { return nanoseconds(50'000 + 10'000 * pe.value); }
};

struct IterationTimes {
  nanoseconds mean{0}, busiest{0}, sum{0};
};

tess::Task iterate(IterationTimes& times) {
  constexpr std::int32_t n_each = 4, n_rounds = 10;
  const auto shifts = tess::create<Shift>(tess::range(n_each * tess::n_pes()));
  for (std::int32_t i = 0; i < tess::n_pes(); ++i) {
    const nanoseconds work = n_each * Shift::work_of(tess::PeId{i});
    times.busiest = std::max(times.busiest, work);
    times.sum += work;
  }
  nanoseconds began{0};
  for (std::int32_t round = 0; round <= n_rounds; ++round) {
    if (round == 1) began = tess::now();  // the first waits for the array, too
    const std::int64_t n = co_await shifts.reduce<&Shift::work>();
    TESS_CHECK(n == n_each * tess::n_pes(), n, " chares worked");
  }
  times.mean = (tess::now() - began) / n_rounds;
}

constexpr std::int32_t n_files = 50;

/// Does a known amount of work on each PE, and sends messages about.
class Clerk : public tess::Group<Clerk> {
 public:
  void begin(std::int32_t n) {
    for (std::int32_t i = 0; i < n * (pe().value + 1); ++i) group()[pe()].send<&Clerk::file>();
    group()[tess::PeId{(pe().value + 1) % tess::n_pes()}].send<&Clerk::file>();
  }
  void file() { tess::charge(nanoseconds(7001)); }
};

struct Trip {
  std::uint64_t state = 0;
  std::int32_t hops_left = 0;
};

nanoseconds last_trip_ended{0};  // one thread runs all simulated PEs

class Tourist : public tess::Chare<Tourist, tess::Index1> {
 public:
  explicit Tourist(std::int32_t n) : n_(static_cast<std::uint64_t>(n)) {}
  void begin(std::int32_t n_hops) { hop({static_cast<std::uint64_t>(index().x), n_hops + 1}); }
  void hop(Trip trip) {
    if (--trip.hops_left == 0) {
      last_trip_ended = std::max(last_trip_ended, tess::now());
      return;
    }
    trip.state = trip.state * 6364136223846793005U + 1442695040888963407U;
    array()[{static_cast<std::int32_t>((trip.state >> 32U) * n_ >> 32U)}].send<&Tourist::hop>(trip);
  }

 private:
  std::uint64_t n_;
};

/// A vector on its way to another process.
struct Shipped {
  nanoseconds sent_at{0};
  std::vector<char> bytes{};
};
nanoseconds took{0};
class Parcels : public tess::Group<Parcels> {
 public:
  void take(const Shipped& load) { took = tess::now() - load.sent_at; }
};

/// Gives the number of messages that each PE has run.
class Counter : public tess::Group<Counter> {
 public:
  void count(tess::Callback<std::vector<std::uint64_t>> done) {
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(tess::n_pes()));
    counts[static_cast<std::size_t>(pe().value)] = tess::statistics().messages;
    contribute(tess::sum, std::move(counts), std::move(done));
  }
};

/// Trips of so many hops each, one from each element.
struct Walk {
  std::int32_t n_trips, n_hops;
  nanoseconds without_epoch{0}, in_epoch{0};
  std::vector<std::uint64_t> messages{};  // in the epoch, run on each PE

  [[nodiscard]] double n_messages() const { return double{1} * n_trips * n_hops; }
};

void walk_without_epoch(const Walk& walk) {
  tess::create<Tourist>(tess::range(walk.n_trips), walk.n_trips)
      .broadcast<&Tourist::begin>(walk.n_hops);
}

tess::Task walk_in_epoch(Walk& walk) {
  const auto body = [&] { walk_without_epoch(walk); };
  co_await tess::epoch(body);
  walk.in_epoch = tess::now();
  tess::Future<std::vector<std::uint64_t>> done;
  tess::create<Counter>(tess::each_pe).broadcast<&Counter::count>(done.callback());
  walk.messages = co_await done;
}

}  // namespace

TEST_CASE("an iteration of broadcast, work and reduction takes as long as the busiest PE works",
          "[runtime][simulated]") {
  for (std::int32_t n_pes = 2; n_pes <= 16; ++n_pes) {
    for (const std::int32_t per_process : {1, n_pes}) {
      CAPTURE(n_pes, per_process);
      IterationTimes times;
      REQUIRE(simulate(tess::text("pes=", n_pes, ",per-process=", per_process),
                       [&times] { return iterate(times); }) == 0);
      const nanoseconds beyond = times.mean - times.busiest;
      CHECK(times.sum > times.busiest * 3 / 2);  // the bound below tells the two apart
      CHECK(beyond >= nanoseconds(0));
      // To the root of the array's tree, down to the farthest PE and up again, to PE 0.
      CHECK(beyond <= (2 * depth_of(n_pes) + 2) * latency + 10 * cost);
    }
  }
}

TEST_CASE("the busy time of --stats is the cost of each message and the work that was charged",
          "[runtime][simulated]") {
  constexpr std::int32_t n_pes = 3;
  for (const char* processes : {"per-process=3", "per-process=1"}) {
    std::vector<std::string> lines;
    REQUIRE(simulate(
                tess::text("pes=", n_pes, ",", processes),
                [] { tess::create<Clerk>(tess::each_pe).broadcast<&Clerk::begin>(n_files); },
                &lines) == 0);
    REQUIRE(lines.size() == n_pes + 1);
    CHECK(lines.back().starts_with("stats: PEs wait"));
    lines.pop_back();
    for (const std::string& line : lines) {
      INFO(line);
      int pe = -1;
      unsigned long long n_messages = 0, n_sent = 0, n_bytes = 0;
      double busy = 0, idle = 0;
      REQUIRE(std::sscanf(line.c_str(),
                          "stats: PE %d messages %llu sent %llu bytes %llu busy %lf s idle %lf s",
                          &pe, &n_messages, &n_sent, &n_bytes, &busy, &idle) == 6);
      const auto n_filed = static_cast<unsigned long long>(n_files * (pe + 1) + 1);
      CHECK(n_messages > n_filed);
      const double expected =
          1e-9 * (static_cast<double>(n_messages) * 100 + static_cast<double>(n_filed) * 7001);
      CHECK(busy == Approx(expected).margin(1e-6));  // it is printed to a microsecond
    }
  }
}

TEST_CASE("both ends copy the bytes of packed messages, and none of a large vector",
          "[runtime][simulated]") {
  for (const std::size_t n_bytes : {std::size_t{1000}, std::size_t{4000}, std::size_t{1'000'000}}) {
    CAPTURE(n_bytes);
    REQUIRE(simulate("pes=2,per-process=1,bandwidth=1GB/s,process-copy=1GB/s", [n_bytes] {
              tess::create<Parcels>(tess::each_pe)[tess::PeId{1}].send<&Parcels::take>(
                  Shipped{tess::now(), std::vector<char>(n_bytes)});
            }) == 0);
    const auto bytes = static_cast<std::int64_t>(n_bytes);
    const std::int64_t under_way = bytes + latency.count();  // a nanosecond per byte
    const std::int64_t copies = n_bytes < 100'000 ? 2 * bytes : 0;
    CHECK(took.count() >= under_way + copies);
    CHECK(took.count() <= under_way + copies + 2000);
  }
}

TEST_CASE("an epoch costs at most a fifth more per message, and PE 0 twice the mean in messages",
          "[runtime][simulated][completion]") {
  struct Case {
    std::int32_t n_pes, n_trips, n_hops;
  };
  for (const Case& c : {Case{16, 1000, 60}, Case{256, 1000, 200}}) {
    for (const std::int32_t per_process : {1, c.n_pes}) {
      CAPTURE(c.n_pes, c.n_trips, per_process);
      const std::string machine = tess::text("pes=", c.n_pes, ",per-process=", per_process);
      Walk walk{c.n_trips, c.n_hops};
      REQUIRE(simulate(machine, [&walk] { walk_without_epoch(walk); }) == 0);
      walk.without_epoch = std::exchange(last_trip_ended, nanoseconds(0));
      REQUIRE(simulate(machine, [&walk] { return walk_in_epoch(walk); }) == 0);
      CHECK(walk.in_epoch >= std::exchange(last_trip_ended, nanoseconds(0)));
      CHECK(static_cast<double>(walk.in_epoch.count()) <=
            1.2 * static_cast<double>(walk.without_epoch.count()));

      double sum = 0;
      for (const std::uint64_t n : walk.messages) sum += static_cast<double>(n);
      CHECK(sum > walk.n_messages());
      CHECK(static_cast<double>(walk.messages[0]) <= 2 * sum / c.n_pes);
    }
  }
}
