// Runs that hang: what --hang-report and a deadlock say, and what an audit finds, on the simulated
// machine and on threads.
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace {

using namespace std::chrono_literals;

struct Outcome {
  int exit_code = 0;
  std::string report;
  [[nodiscard]] bool says(const std::string& part) const {
    return report.find(part) != std::string::npos;
  }
};

template <class Main>
Outcome outcome_of(tess::Setup setup, Main main) {
  Outcome outcome;
  std::mutex mutex;  // the watching thread reports, too
  setup.options.report = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    outcome.report += line + "\n";
  };
  outcome.exit_code = tess::run(setup, std::move(main));
  return outcome;
}

tess::Setup simulated(int n_pes, std::chrono::nanoseconds hang_report = 0ns) {
  tess::SimulatedOptions options;
  options.n_pes = n_pes;
  options.cost = 100ns;
  tess::Setup setup;
  setup.machine = tess::make_simulated_machine(options);
  setup.options.hang_report = hang_report;
  return setup;
}
tess::Setup on_threads(int n_pes, std::chrono::nanoseconds hang_report = 0ns) {
  tess::Setup setup;
  setup.machine = tess::make_threads_machine(n_pes);
  setup.options.hang_report = hang_report;
  return setup;
}

class Partner : public tess::Chare<Partner, tess::Index2> {
 public:
  tess::Task step(tess::Index2 other) {
    step_ = 16;
    co_await array()[other].ask<&Partner::depth>(index());
  }
  tess::Task depth(tess::Index2 from) { co_await array()[from].ask<&Partner::level>(); }
  tess::Task level() {
    tess::Future<int> never;
    co_await never;
  }
  void take() {}
  void add(tess::Callback<int> to) {
    if (index().x != 3) contribute(tess::sum, 1, to);
  }
  [[nodiscard]] std::string describe_state() const {
    return step_ == 0 ? "" : tess::text("at step ", step_);
  }
  void serialize(auto& ar) { ar(step_); }

 private:
  int step_ = 0;
};

/// Cannot say how far it is.
class Mute : public tess::Chare<Mute> {
 public:
  tess::Task wait() {
    tess::Future<int> never;
    co_await never;
  }
  [[nodiscard]] std::string describe_state() const {
    if (index().x == 0) throw std::runtime_error("no state");
    throw 7;
  }
};

std::atomic<bool> slow_may_end{false};

class Slow : public tess::Chare<Slow, tess::Index1> {
 public:
  /// Runs until the report has been printed.
  void step() {
    while (!slow_may_end) std::this_thread::sleep_for(1ms);
  }
};

class Relay : public tess::Chare<Relay, tess::Index1> {
 public:
  void pass(int n) {
    if (n > 0)
      array()[{(index().x + 1) % static_cast<int>(array().size())}].send<&Relay::pass>(n - 1);
  }
  void serialize(auto& /*ar*/) {}
};

}  // namespace

TEST_CASE("a deadlock of replies is reported as a cycle, on any schedule", "[runtime][hang]") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    const Outcome outcome = outcome_of(tess::test::adversarial(3, seed), [] {
      const auto partners = tess::create<Partner>(tess::range(4, 6));
      partners[{3, 4}].send<&Partner::step>(tess::Index2{3, 5});
    });
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.says("wait:\n  cycle of replies: "));
    CHECK(outcome.says("Partner[3,4] waits for Partner[3,5].depth"));
    CHECK(outcome.says("Partner[3,5] waits for Partner[3,4].level"));
    CHECK(outcome.says(", at step 16: Partner::step waits for the reply of Partner[3,5].depth"));
  }
}

TEST_CASE("a report goes on if describe_state() throws", "[runtime][hang]") {
  const Outcome outcome =
      outcome_of(simulated(2), [] { tess::create<Mute>(tess::range(2)).broadcast<&Mute::wait>(); });
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.says("Mute[0]"));
  CHECK(outcome.says(", its describe_state() throws: no state: Mute::wait waits for a future"));
  CHECK(outcome.says("Mute[1]"));
  CHECK(outcome.says(", its describe_state() throws: Mute::wait waits for a future"));
}

TEST_CASE("elements of two arrays with the same index make no cycle", "[runtime][hang]") {
  const Outcome outcome = outcome_of(simulated(2), []() -> tess::Task {
    const auto one = tess::create<Partner>(tess::range(1, 1));
    co_await one[{0, 0}].ask<&Partner::level>();
  });
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.says("the reply of Partner[0,0].level"));
  CHECK_FALSE(outcome.says("cycle"));
}

TEST_CASE("a run that only a timer keeps open is reported in virtual time", "[runtime][hang]") {
  const Outcome outcome = outcome_of(simulated(3, 5s), []() -> tess::Task {
    const auto partners = tess::create<Partner>(tess::range(4, 1));
    partners[{9, 9}].send<&Partner::take>();
    tess::after(1h, [] { tess::exit(0); });
    (void)tess::every(1s, [] {});
    co_await partners.reduce<&Partner::add>();
  });
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.says("tessera: hang: no entry method has begun on any PE for 5 s; "));
  CHECK(outcome.says("1 message (Partner::take) on PE "));
  CHECK(outcome.says("to Partner[9,9], which does not exist"));
  CHECK(outcome.says("Partner[3,0]"));
  CHECK(outcome.says("the main program on PE 0: run() waits for a future of int"));
  CHECK(outcome.report.find("hang: no entry") == outcome.report.rfind("hang: no entry"));
  CHECK(outcome.says(": 1 timer is set"));
}

TEST_CASE("a run that works is not reported as a hang", "[runtime][hang]") {
  const Outcome outcome = outcome_of(simulated(3, 1ms), [] {
    const auto relays = tess::create<Relay>(tess::range(5));
    relays[{0}].send<&Relay::pass>(20'000);
  });
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.report.empty());
}

TEST_CASE("an entry method that runs long is named while it runs", "[runtime][hang][threads]") {
  tess::Setup setup = on_threads(2, 200ms);
  std::mutex mutex;
  std::string report;
  setup.options.report = [&](const std::string& line) {
    const std::lock_guard lock(mutex);
    report += line + "\n";
    // The line of the watch, and the report of all PEs.
    if (report.find("tessera: hang: Slow") != std::string::npos &&
        report.find("no entry method") != std::string::npos)
      slow_may_end = true;
  };
  const int exit_code =
      tess::run(setup, [] { tess::create<Slow>(tess::range(4))[{3}].send<&Slow::step>(); });
  CHECK(exit_code == 0);
  CHECK(report.find("tessera: hang: Slow[3] on PE 1 has been in Slow::step for ") !=
        std::string::npos);
  CHECK(
      report.find("PE 1 has not answered within 300 ms: Slow[3] on PE 1 has been in Slow::step") !=
      std::string::npos);
}

TEST_CASE("a hang on threads is reported once, and the run goes on", "[runtime][hang][threads]") {
  const Outcome outcome = outcome_of(on_threads(2, 100ms), []() -> tess::Task {
    const auto partners = tess::create<Partner>(tess::range(4, 6));
    partners[{3, 4}].send<&Partner::step>(tess::Index2{3, 5});
    tess::after(1500ms, [] { tess::exit(3); });
    tess::Future<int> never;
    co_await never;
  });
  CHECK(outcome.exit_code == 3);
  const auto first = outcome.report.find("hang: no entry method has begun on any PE for 0.");
  CHECK(first != std::string::npos);
  CHECK(outcome.report.find("hang: no entry", first + 1) == std::string::npos);
  CHECK(outcome.says("cycle of replies: "));
}

TEST_CASE("an audit of a run without faults finds that each message arrived once",
          "[runtime][audit][threads]") {
  const auto main = [] { tess::create<Relay>(tess::range(7))[{0}].send<&Relay::pass>(1000); };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    tess::Setup setup = tess::test::adversarial(5, seed);
    setup.options.audit = true;
    const Outcome outcome = outcome_of(std::move(setup), main);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.says("messages between PEs, each of which arrived once"));
  }
  tess::Setup setup = on_threads(3);
  setup.options.audit = true;
  const Outcome outcome = outcome_of(std::move(setup), main);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.says("messages between PEs, each of which arrived once"));
}

TEST_CASE("an audit names a message that the simulated machine lost or delivered twice",
          "[runtime][audit]") {
  using Kind = tess::MessageFault::Kind;
  int n_named = 0;
  for (const Kind kind : {Kind::lost, Kind::twice}) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      INFO("seed " << seed);
      tess::Setup setup = tess::test::adversarial(4, seed);
      setup.options.audit = true;
      setup.options.fault = {kind, 1 + seed % 5};
      const Outcome outcome = outcome_of(std::move(setup), [] {
        const auto relays = tess::create<Relay>(tess::range(8));
        for (int i = 0; i < 8; ++i) relays[{i}].send<&Relay::pass>(20);
      });
      CHECK(outcome.exit_code != 0);
      const std::string what =
          kind == Kind::lost ? " was sent and has not arrived" : " arrived twice";
      CHECK(outcome.says("(Relay::pass) from PE 0 to PE "));
      CHECK(outcome.says(what));
      n_named += outcome.says(what) ? 1 : 0;
    }
  }
  CHECK(n_named == 60);
}

TEST_CASE("a lost message on threads is named in the report of the hang",
          "[runtime][audit][threads]") {
  tess::Setup setup = on_threads(2, 100ms);
  setup.options.audit = true;
  setup.options.fault = {tess::MessageFault::Kind::lost, 2};
  setup.options.report = {};
  const Outcome outcome = outcome_of(std::move(setup), [] {
    const auto relays = tess::create<Relay>(tess::range(2));
    for (int i = 0; i < 4; ++i) relays[{1}].send<&Relay::pass>(0);
    tess::after(1500ms, [] { tess::exit(0); });
  });
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.says("message 2 (Relay::pass) from PE 0 to PE 1 was sent and has not arrived"));
}
