#include "apps/m2m_transfer/run/measure.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

using namespace tess;
using namespace tess::m2m;
using namespace m2m_transfer;

namespace {

constexpr int n_rounds = 10;
constexpr std::size_t n_bytes = 10000;

/// Each member sends the same number of bytes to the next one, several times.
class Chatter : public Group<Chatter> {
 public:
  void talk(int left) {
    if (left == 0) return;
    const PeId next{(pe().value + 1) % tess::n_pes()};
    group()[next].send<&Chatter::hear>(std::vector<std::uint8_t>(n_bytes));
    group()[pe()].send<&Chatter::talk>(left - 1);
  }
  void hear(std::vector<std::uint8_t> bytes) {
    TESS_CHECK(bytes.size() == n_bytes, "got ", bytes.size(), " bytes");
  }
};

Task compare(Footprint& before, Footprint& after) {
  const auto gauge = create<Gauge>(each_pe);
  const auto chatter = create<Chatter>(each_pe);
  Future<Footprint> first, second;
  gauge.broadcast<&Gauge::read>(first.callback());
  before = co_await first;
  co_await epoch([&] { chatter.broadcast<&Chatter::talk>(n_rounds); });
  gauge.broadcast<&Gauge::read>(second.callback());
  after = co_await second;
}

}  // namespace

TEST_CASE("bytes that PEs send between processes are counted once", "[apps][footprint]") {
  for (const char* keys : {"pes=4,seed=3", "pes=6,per-process=2,seed=4"}) {
    Setup setup{make_simulated_machine(parse_simulated(keys)), {}};
    const auto n_processes = static_cast<std::uint64_t>(setup.machine->n_processes());
    Footprint before, after;
    REQUIRE(run(setup, [&] { return compare(before, after); }) == 0);
    // Only the last PE of each process sends to another process.
    const std::uint64_t said = n_processes * n_rounds * n_bytes;
    const std::uint64_t sent = after.bytes_sent - before.bytes_sent;
    CHECK(sent > said);
    CHECK(sent < said + said / 2);                                       // envelopes, and the epoch
    CHECK(after.peak_memory_bytes == after.greatest_peak_memory_bytes);  // one memory
    CHECK(after.peak_memory_bytes > 1'000'000);
  }
}

TEST_CASE("messages within a process are not counted", "[apps][footprint]") {
  Footprint before, after;
  REQUIRE(tests::run_threads(2, [&] { return compare(before, after); }).exit_code == 0);
  CHECK(after.bytes_sent == 0);
}

TEST_CASE("joined footprints have the sums, and the largest peak", "[apps][footprint]") {
  const Footprint all = JoinFootprints()({10, 10, 1}, JoinFootprints()({30, 30, 2}, {20, 20, 4}));
  CHECK(all.peak_memory_bytes == 60);
  CHECK(all.greatest_peak_memory_bytes == 30);
  CHECK(all.bytes_sent == 7);
}
