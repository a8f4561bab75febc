// Messages that run long: a PE that always has one ready still takes what others send to it, and
// epochs of other work end meanwhile.
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <array>

namespace {

using namespace std::chrono_literals;

constexpr std::int32_t n_links = 400;

// One thread runs all simulated PEs.
std::array<std::int32_t, 2> n_run;            // links of each PE's chain so far
std::int32_t at_sending, at_arrival, at_end;  // links of PE 0's chain

/// A chain of messages of a millisecond each to itself, so that its PE is never idle.
class Chain : public tess::Group<Chain> {
 public:
  void link() {
    tess::charge(1ms);
    std::int32_t& n = n_run[static_cast<std::size_t>(tess::my_pe().value)];
    if (++n < n_links) group()[tess::my_pe()].send<&Chain::link>();
    if (n == 10 && tess::my_pe() == tess::PeId{1}) {
      at_sending = n_run[0];
      group()[tess::PeId{0}].send<&Chain::arrive>();
    }
  }
  void arrive() { at_arrival = n_run[0]; }
  void nothing() {}
};

tess::Task measure_epoch() {
  tess::GroupProxy<Chain> chains;
  co_await tess::epoch([&] { chains = tess::create<Chain>(tess::each_pe); });
  chains.broadcast<&Chain::link>();
  co_await tess::epoch([&] { chains.broadcast<&Chain::nothing>(); });
  at_end = n_run[0];
}

void run_on(const std::string& options) {
  std::string option = "--sim=pes=2," + options;
  std::string program = "test";
  std::array<char*, 3> argv{program.data(), option.data(), nullptr};
  int argc = 2;
  tess::Setup setup = tess::take_options(argc, argv.data());
  n_run = {};
  REQUIRE(tess::run(setup, [] { return measure_epoch(); }) == 0);
  REQUIRE(n_run[0] == n_links);
}

}  // namespace

TEST_CASE("a PE takes what others send between two of its own long messages",
          "[runtime][simulated]") {
  for (const char* options : {"latency=1us", "latency=1us,per-process=1", "cost=100ns"}) {
    CAPTURE(options);
    run_on(options);
    CHECK(at_arrival <= at_sending + 3);
  }
}

TEST_CASE("an epoch ends while other work keeps every PE busy",
          "[runtime][simulated][completion]") {
  for (const char* options : {"latency=1us", "latency=1us,per-process=1", "cost=100ns"}) {
    CAPTURE(options);
    run_on(options);
    CHECK(at_end <= 40);  // some ten messages one after the other, each behind two links at most
  }
}
