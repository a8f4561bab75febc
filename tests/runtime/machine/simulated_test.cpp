// The simulated machine: its options, and that a seed repeats a run exactly.
#include "runtime/machine/simulated.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

namespace {

class Walker : public tess::Chare<Walker, tess::Index1> {
 public:
  void walk(std::uint64_t seed);
  template <class Ar>
  void serialize(Ar& /*ar*/) {}
};
std::vector<std::uint64_t> trace;  // one thread runs all simulated PEs

void Walker::walk(std::uint64_t seed) {
  tess::Random random(seed);
  trace.push_back(seed ^ static_cast<std::uint64_t>(tess::now().count()));
  if (trace.size() > 500) return;
  migrate_to(tess::PeId{static_cast<std::int32_t>(random.below(3))});
  array()[{static_cast<int>(random.below(5))}].send<&Walker::walk>(random());
}

std::vector<std::uint64_t> walk(const std::string& options) {
  std::string option = "--sim=" + options;
  std::string program = "test";
  std::array<char*, 3> argv{program.data(), option.data(), nullptr};
  int argc = 2;
  tess::Setup setup = tess::take_options(argc, argv.data());
  REQUIRE(argc == 1);
  trace.clear();
  REQUIRE(tess::run(setup, [] {
            const auto walkers = tess::create<Walker>(tess::range(5));
            for (int i = 0; i < 5; ++i)
              walkers[{i}].send<&Walker::walk>(static_cast<std::uint64_t>(i));
          }) == 0);
  return trace;
}

}  // namespace

TEST_CASE("a seed repeats a run exactly, and another is another run", "[runtime][simulated]") {
  const auto first = walk("pes=3,cost=100ns,seed=7");
  CHECK(first == walk("pes=3,cost=100ns,seed=7"));
  CHECK(first != walk("pes=3,cost=100ns,seed=8"));
}

TEST_CASE("the options of the simulated machine are read with their units",
          "[runtime][simulated]") {
  const auto options = tess::parse_simulated(
      "pes=8,per-process=2,latency=2us,bandwidth=10GB/s,cost=100ns,seed=7,migrate=0.25");
  CHECK(options.n_pes == 8);
  CHECK(options.pes_per_process == 2);
  CHECK(options.latency.count() == 2000);
  CHECK(options.bandwidth == 10e9);
  CHECK(options.cost.value().count() == 100);
  CHECK(options.seed.value() == 7);
  CHECK(options.migration_chance.value() == 0.25);
  CHECK_FALSE(tess::parse_simulated("cost=measured").cost.has_value());
}

TEST_CASE("a bad option of the simulated machine is named", "[runtime][simulated]") {
  for (const char* bad : {"pes=0", "pes=many", "pes", "latency=-1us", "latency=1h", "bandwidth=0",
                          "migrate=2", "colour=red", "pes=5,per-process=2", "seed=0.5", "pes=2x"}) {
    INFO(bad);
    CHECK_THROWS_AS(tess::parse_simulated(bad), tess::Error);
  }
}

TEST_CASE("the memory for messages is read with its unit", "[runtime]") {
  std::string program = "test", option = "--message-memory", value = "3MiB";
  std::array<char*, 4> argv{program.data(), option.data(), value.data(), nullptr};
  int argc = 3;
  CHECK(tess::take_options(argc, argv.data()).options.messages.memory_bytes == 3U << 20U);
  CHECK(argc == 1);
}

TEST_CASE("a bad runtime option is refused", "[runtime]") {
  for (const char* bad : {"--pes=0", "--pes=x", "--pes=-2", "--pes=", "--sim=colour=red",
                          "--message-memory=0", "--message-memory=8MB", "--message-memory=x",
                          "--message-memory=2000GiB", "--message-memory=-1"}) {
    std::string program = "test", option = bad;
    std::array<char*, 3> argv{program.data(), option.data(), nullptr};
    int argc = 2;
    INFO(bad);
    CHECK_THROWS_AS(tess::take_options(argc, argv.data()), tess::Error);
  }
}
