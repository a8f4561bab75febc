// --trace: the contents of the file for a run with known messages.
#include "runtime/more/trace.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
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

/// Runs it; returns the number of messages that ran, or −1 if it failed.
int run_relay(const std::string& path, int n_pes) {
  const int per_process = n_pes % 2 == 0 ? n_pes / 2 : n_pes;
  tess::RuntimeOptions options;
  options.trace = path;
  options.statistics = true;
  const auto main = [] { tess::create<Relay>(tess::range(8))[{0}].send<&Relay::pass>(40); };
  const std::string keys = tess::text("pes=", n_pes, ",per-process=", per_process, ",cost=100ns");
  const tests::Ending ending = tests::run(keys, main, options);
  int n_messages = 0;
  for (std::size_t at = 0; (at = ending.report.find(" messages ", at)) != std::string::npos; ++at)
    n_messages += std::atoi(ending.report.c_str() + at + 10);
  return ending.exit_code == 0 ? n_messages : -1;
}

}  // namespace

TEST_CASE("a trace has a slice for each message of the user, and an arrow from its send",
          "[runtime][trace]") {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("tess_trace_" + std::to_string(getpid()) + ".json"))
                               .string();
  for (const int n_pes : {1, 3, 4}) {
    const int n_messages = run_relay(path, n_pes);
    REQUIRE(n_messages > 40);
    std::ifstream file(path);
    const auto written = nlohmann::json::parse(file);
    std::map<std::string, double> sent, ran;
    std::map<int, double> busy_until;
    int n_passes = 0, n_events = 0;
    for (const auto& event : written.at("traceEvents")) {
      const std::string phase = event.at("ph");
      if (phase == "M") continue;
      const double at = event.at("ts");
      ++n_events;
      CHECK(phase == "X");
      const std::string name = event.at("name");
      CHECK(
          (name == "Relay::pass" || name == "main program" || name == "runtime" || name == "send"));
      CHECK(event.contains("flow_out") == (name == "send"));
      if (event.contains("flow_out")) CHECK(sent.emplace(event.at("bind_id"), at).second);
      if (event.contains("flow_in")) CHECK(ran.emplace(event.at("bind_id"), at).second);
      if (name == "send") continue;
      const int pe = event.at("tid");
      CHECK(at >= busy_until[pe]);
      busy_until[pe] = at + event.at("dur").get<double>() - 1e-3;
      if (name != "Relay::pass") continue;
      ++n_passes;
      CHECK(event.at("dur").get<double>() >= 3.0 - 1e-3);
    }
    CHECK(n_passes == 41);
    CHECK(n_events <= 2 * n_messages);
    CHECK(ran.size() >= 40);
    CHECK(ran.size() == sent.size());
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

namespace {

/// The critical path that a run printed.
std::string path_of(const std::function<void()>& main, const std::string& file) {
  tess::RuntimeOptions options;
  options.trace = file;
  const auto result = tests::run("pes=3,latency=10us,cost=0ns", main, options);
  REQUIRE(result.exit_code == 0);
  return result.report;
}

/// Element 1 works longer than element 2; element 0 begins when both have told it.
class Fork : public tess::Chare<Fork, tess::Index1> {
 public:
  void start() {
    tess::charge(std::chrono::microseconds(5));
    array()[{1}].send<&Fork::work>(300);
    array()[{2}].send<&Fork::work>(100);
    tess::charge(std::chrono::microseconds(40));  // after the sends: not on the path
  }
  void work(int microseconds) {
    const tess::Span span("lifting");
    tess::charge(std::chrono::microseconds(microseconds));
    array()[{0}].send<&Fork::join>();
  }
  void join() {
    tess::charge(std::chrono::microseconds(7));
    if (++n_joined_ < 2) return;
    tess::mark("joined");
    array()[{0}].send<&Fork::finish>();
  }
  void finish() { tess::charge(std::chrono::microseconds(20)); }

 private:
  int n_joined_ = 0;
};

}  // namespace

TEST_CASE("the critical path goes through the slower branch", "[runtime][trace]") {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("tess_path_" + std::to_string(getpid()) + ".json"))
          .string();
  const std::string report =
      path_of([] { tess::create<Fork>(tess::range(3))[{0}].send<&Fork::start>(); }, path);
  INFO(report);
  // 5 before the send, 300, 7 and 20; two messages of 10 us on the way, and their bytes.
  CHECK(report.find("0.332 ms in entry methods") != std::string::npos);
  CHECK(report.find("0.02001 ms of waiting") != std::string::npos);
  CHECK(report.find("0.3 ms in Fork::work on PE 1") != std::string::npos);
  CHECK(report.find("on PE 2") == std::string::npos);
  std::ifstream file(path);
  int n_spans = 0, n_marks = 0;
  const auto written = nlohmann::json::parse(file);
  for (const auto& event : written.at("traceEvents")) {
    if (event.at("name") == "lifting") {
      ++n_spans;
      CHECK(event.at("ph") == "X");
      CHECK((event.at("dur") == 300 || event.at("dur") == 100));
    }
    if (event.at("name") == "joined") n_marks += event.at("ph") == "i" ? 1 : 100;
  }
  CHECK(n_spans == 2);
  CHECK(n_marks == 1);
  std::filesystem::remove(path);
}

TEST_CASE("clocks of processes are aligned by the fastest message of each direction",
          "[runtime][trace]") {
  using tess::detail::Trace;
  Trace zero(10), one(10);
  // Nanoseconds; the clock of process 1 is 500 ahead, and a message takes 20, or longer.
  (void)zero.sent(100);
  (void)zero.sent(200);
  one.ran(0, 500 + 100 + 90, 700, tess::PeId{0}, 1);
  one.ran(0, 500 + 200 + 20, 730, tess::PeId{0}, 2);
  (void)one.sent(500 + 240);
  zero.ran(0, 240 + 20, 300, tess::PeId{1}, 1);
  std::vector<tess::detail::TraceOfPe> pes{
      {tess::PeId{0}, &zero, 1e-9, 0, 0, tess::ProcessId{0}, 0},
      {tess::PeId{1}, &one, 1e-9, 0, 0, tess::ProcessId{1}, 0}};
  tess::detail::align_clocks(pes);
  CHECK(pes[0].late == 0);
  CHECK(pes[1].seconds(740) == Approx(240e-9));
}
