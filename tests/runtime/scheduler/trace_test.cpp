// --trace: the contents of the file for a run with known messages.
#include "runtime/machine/simulated.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <unistd.h>

namespace {

class Relay : public tess::Chare<Relay, tess::Index1> {
 public:
  void pass(int left) {
    tess::charge(std::chrono::microseconds(3));
    if (left > 0)
      array()[{(index().x + 1) % static_cast<int>(array().size())}].send<&Relay::pass>(left - 1);
  }
};

int run_relay(const std::string& path, int n_pes) {
  tess::Setup setup;
  tess::SimulatedOptions options;
  options.n_pes = n_pes;
  options.pes_per_process = n_pes % 2 == 0 ? n_pes / 2 : n_pes;
  options.cost = tess::Time(100);
  setup.machine = tess::make_simulated_machine(options);
  setup.options.trace = path;
  return tess::run(setup, [] { tess::create<Relay>(tess::range(8))[{0}].send<&Relay::pass>(40); });
}

}  // namespace

TEST_CASE("a trace has a slice for each message, and an arrow from the send that caused it",
          "[runtime][trace]") {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("tess_trace_" + std::to_string(getpid()) + ".json"))
                               .string();
  for (const int n_pes : {1, 3, 4}) {
    REQUIRE(run_relay(path, n_pes) == 0);
    std::ifstream file(path);
    const auto written = nlohmann::json::parse(file);
    std::map<std::uint64_t, double> sent, ran;
    std::map<int, double> busy_until;
    int n_passes = 0;
    for (const auto& event : written.at("traceEvents")) {
      const std::string phase = event.at("ph");
      if (phase == "M") continue;
      const double at = event.at("ts");
      if (phase == "s") CHECK(sent.emplace(event.at("id"), at).second);
      if (phase == "f") CHECK(ran.emplace(event.at("id"), at).second);
      if (phase != "X") continue;
      const int pe = event.at("tid");
      CHECK(at >= busy_until[pe]);
      busy_until[pe] = at + event.at("dur").get<double>() - 1e-3;
      const std::string name = event.at("name");
      if (name.find("Relay::pass") == std::string::npos) continue;
      ++n_passes;
      CHECK(event.at("dur").get<double>() >= 3.0 - 1e-3);
    }
    CHECK(n_passes == 41);
    for (const auto& [id, at] : ran) {
      REQUIRE(sent.contains(id));
      CHECK(sent.at(id) <= at);
    }
  }
  std::remove(path.c_str());
}

TEST_CASE("a trace that cannot be written is refused before the run", "[runtime][trace]") {
  CHECK_THROWS_AS(run_relay("/no/such/folder/trace.json", 2), tess::Error);
}
