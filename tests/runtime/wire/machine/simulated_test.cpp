// The simulated machine: its options, and that a seed repeats a run exactly.
#include "runtime/wire/machine/simulated.hpp"

#include "runtime/core/cpu_clock.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace {

class Walker : public tess::Chare<Walker, tess::Index1> {
 public:
  void walk(std::uint64_t seed);
  void serialize(auto& /*ar*/) {}
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

TEST_CASE("work that a fixed cost leaves out is reported with its sum", "[runtime][simulated]") {
  const auto report = [](const std::string& keys, bool charges) {
    tess::Setup setup;
    setup.machine = tess::make_simulated_machine(tess::parse_simulated(keys));
    std::string said;
    setup.options.report = [&said](const std::string& line) { said += line + "\n"; };
    const auto work = [charges] {
      if (charges && tess::charge(std::chrono::milliseconds(30))) return;
      const std::int64_t begin = tess::thread_cpu_nanoseconds();
      while (tess::thread_cpu_nanoseconds() - begin < 30'000'000) {
      }
    };
    CHECK(tess::run(setup, work) == 0);
    return said;
  };
  const std::string left_out = report("pes=2,cost=100ns", false);
  CAPTURE(left_out);
  CHECK(left_out.starts_with("tessera: --sim cost=100ns: virtual time leaves out 0.0"));
  CHECK(left_out.find(" s that entry methods ran, and has ") != std::string::npos);
  CHECK(report("pes=2,cost=100ns", true).empty());
  CHECK(report("pes=2", false).empty());
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

TEST_CASE("the PEs of a process begin with its first one", "[runtime][simulated]") {
  const auto machine = tess::make_simulated_machine(tess::parse_simulated("pes=9,per-process=3"));
  REQUIRE(machine->n_processes() == 3);
  for (std::int32_t i = 0; i < machine->n_pes(); ++i) {
    const tess::PeId pe{i};
    INFO("PE " << i);
    CHECK(machine->first_pe(machine->process_of(pe)) == tess::PeId{i - i % 3});
    CHECK(machine->is_first_of_process(pe) == (i % 3 == 0));
  }
}

TEST_CASE("a bad option of the simulated machine is named", "[runtime][simulated]") {
  for (const char* bad : {"pes=0", "pes=many", "pes", "latency=-1us", "latency=1h", "bandwidth=0",
                          "bandwidth=1e-9", "bandwidth=1e9", "latency=2", "cost=100", "migrate=2",
                          "colour=red", "pes=5,per-process=2", "seed=0.5", "pes=2x"}) {
    INFO(bad);
    CHECK_THROWS_AS(tess::parse_simulated(bad), tess::Error);
  }
  CHECK_THROWS_WITH(tess::parse_simulated("pes=0"),
                    Catch::Matchers::EndsWith("0 is not a whole number of 1 … 1048576"));
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

TEST_CASE("a number of PEs beside the simulated machine's own is refused", "[runtime]") {
  std::string program = "test", sim = "--sim=pes=4", pes = "--pes=3";
  std::array<char*, 4> argv{program.data(), sim.data(), pes.data(), nullptr};
  int argc = 3;
  CHECK_THROWS_WITH(tess::take_options(argc, argv.data()),
                    Catch::Matchers::StartsWith("--sim pes=4 --pes 3: ") &&
                        Catch::Matchers::EndsWith("write --sim pes=3,…"));
}

namespace {

/// A file of parameters with this content.
class ParameterFile {
 public:
  explicit ParameterFile(const std::string& content) { std::ofstream(path_) << content; }
  ~ParameterFile() { std::filesystem::remove(path_); }
  ParameterFile(const ParameterFile&) = delete;
  ParameterFile& operator=(const ParameterFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() /
                       ("tess_simulated_" + std::to_string(::getpid()) + ".sim"))
                          .string();
};

/// The error of --sim with these options.
std::string refusal(const std::string& options) {
  try {
    (void)tess::parse_simulated(options);
  } catch (const tess::Error& error) {
    return error.what();
  }
  return "accepted";
}

/// Sends a ball from PE 0 to PE 1 and back, several times; the last time counts.
class Pair : public tess::Group<Pair> {
 public:
  void serve(int n_left) {
    n_left_ = n_left;
    began_ = tess::now();
    group()[tess::PeId{1}].send<&Pair::hit>();
  }
  void hit() {
    if (pe().value == 1) {
      group()[tess::PeId{0}].send<&Pair::hit>();
    } else if (n_left_ > 1) {
      serve(n_left_ - 1);
    } else {
      last = tess::now() - began_;
    }
  }
  static tess::Time last;

 private:
  int n_left_ = 0;
  tess::Time began_{};
};
tess::Time Pair::last{};

/// Nanoseconds to the other PE and back, with a fixed cost of 100 ns, which a PE pays after a
/// message.
std::int64_t round_trip(const std::string& options) {
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine(tess::parse_simulated("cost=100ns," + options));
  Pair::last = {};
  REQUIRE(tess::run(setup, [] {
            tess::create<Pair>(tess::each_pe)[tess::PeId{0}].send<&Pair::serve>(3);
          }) == 0);
  return Pair::last.count();
}

}  // namespace

TEST_CASE("a file has the parameters of a machine, and later parts override it",
          "[runtime][simulated]") {
  const ParameterFile file(
      "# here\n\nlatency=150ns\n overhead = 40ns\nprocess-latency=2us\r\n"
      "process-bandwidth=5GB/s\nprocess-overhead=300ns");
  for (const char* form : {"", "file="}) {
    const auto options = tess::parse_simulated(form + file.path() + ",pes=8,overhead=50ns");
    CHECK(options.n_pes == 8);
    CHECK(options.within_process().latency == tess::Time(150));
    CHECK(options.within_process().overhead == tess::Time(50));
    CHECK(options.within_process().bandwidth == 10e9);
    CHECK(options.between_processes().latency == tess::Time(2000));
    CHECK(options.between_processes().bandwidth == 5e9);
    CHECK(options.between_processes().overhead == tess::Time(300));
    CHECK_FALSE(options.cost.has_value());
  }
  const auto one = tess::parse_simulated("latency=3us,bandwidth=1GB/s,overhead=7ns");
  CHECK(one.between_processes().latency == tess::Time(3000));
  CHECK(one.between_processes().bandwidth == 1e9);
  CHECK(one.between_processes().overhead == tess::Time(7));
}

TEST_CASE("a bad file of parameters is refused with its line, value and remedy",
          "[runtime][simulated]") {
  struct Case {
    const char* content;
    const char* line;
    const char* says;
  };
  for (const Case& c :
       {Case{"latency=1us\noverhead=-4ns\n", ":2: overhead", "-4ns is not a time"},
        Case{"latency=fast\n", ":1: latency", "fast is not a number"},
        Case{"process-bandwidth=3km\n", ":1: process-bandwidth", "MB/s or GB/s"},
        Case{"process-latency=1e300s\n", ":1: process-latency", "1e300s is not a time"},
        Case{"# x\nlatency\n", ":2: latency", "bench --calibrate"},
        Case{"pes=4\n", ":1: unknown key pes", "--sim "},
        Case{"# nothing\n", "has no values", "bench --calibrate"}}) {
    const ParameterFile file(c.content);
    const std::string error = refusal("pes=2,file=" + file.path());
    CAPTURE(error);
    CHECK(error.find(file.path()) != std::string::npos);
    CHECK(error.find(c.line) != std::string::npos);
    CHECK(error.find(c.says) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
  }
  CHECK(refusal("/nowhere/here.sim").find("/nowhere/here.sim cannot be opened") !=
        std::string::npos);
  CHECK(refusal("latency=1us,pes").find("bench --calibrate") != std::string::npos);
}

TEST_CASE("overheads and the wire between processes are virtual time, exactly",
          "[runtime][simulated]") {
  struct Case {
    const char* machine;
    std::int64_t message;  // ns from one PE to the other; its bytes take none
  };
  for (const Case& c :
       {Case{"pes=2,latency=1us,bandwidth=1000000GB/s", 1000},
        Case{"pes=2,latency=1us,bandwidth=1000000GB/s,overhead=40ns", 1080},
        Case{"pes=2,per-process=1,latency=1us,process-latency=3us,bandwidth=1000000GB/s", 3000},
        Case{"pes=2,per-process=1,latency=1us,process-latency=3us,bandwidth=1000000GB/"
             "s,overhead=40ns,"
             "process-overhead=500ns",
             4000}}) {
    CAPTURE(c.machine);
    CHECK(round_trip(c.machine) == 2 * c.message);
  }
}
