// The broadcast log by itself: one log per PE, messages in any order, and elements that come, go
// and migrate at any time. The oracles: an element receives each broadcast of its life once and in
// order, and none after the broadcast's epoch is done.
#include "runtime/arrays/broadcast_log.hpp"

#include "tests/runtime/arrays/network.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

namespace {

using namespace tess;
using namespace tess::detail;
using test::Bag;
using test::Ledgers;

struct Listener {
  std::uint64_t seen = 0;  // the last broadcast that it received, or that was applied before it
};

class Logs;

class LogHost final : public BroadcastHost {
 public:
  LogHost(Logs& logs, PeId here) : logs_(logs), here_(here) {}
  void send(PeId to, const NumberedCall& call) override;
  void send(PeId to, const BroadcastSettled& settled) override;
  void send(PeId to, const BroadcastDrop& drop) override;
  void flush() override { n_held_ = 0; }
  void apply(const NumberedCall& call) override;

  std::vector<Listener> elements;

 private:
  Logs& logs_;
  const PeId here_;
  int n_held_ = 0;  // messages to children that may still be held back
};

class Logs {
 public:
  Logs(std::int32_t n_pes, std::uint64_t seed) : bag(seed), ledgers(n_pes), root_(any_of(n_pes)) {
    for (std::int32_t i = 0; i < n_pes; ++i) {
      hosts.push_back(std::make_unique<LogHost>(*this, PeId{i}));
      of_pes.push_back(std::make_unique<BroadcastLog>(*hosts.back(), PeId{i}, root_, n_pes));
    }
  }

  [[nodiscard]] PeId any_pe() { return any_of(static_cast<std::int32_t>(of_pes.size())); }
  [[nodiscard]] BroadcastLog& log(PeId pe) { return *of_pes[static_cast<std::size_t>(pe.value)]; }
  [[nodiscard]] LogHost& host(PeId pe) { return *hosts[static_cast<std::size_t>(pe.value)]; }

  void start() {
    const PeId from = any_pe();
    const EpochId epoch = Ledgers::epoch(n_started++);
    Counted::departs(ledgers.at(from), epoch);
    epochs.push_back(epoch);
    bag.post([this, epoch] {
      Counted counted(ledgers.at(root_), epoch);
      if (!ended)
        log(root_).on_start(NumberedCall{0, epoch, nullptr, 0, n_bytes}, std::move(counted));
    });
  }
  void create(PeId pe) { host(pe).elements.push_back({log(pe).applied()}); }

  /// An element receives a broadcast on a PE.
  void receive(Listener& element, const NumberedCall& call) {
    REQUIRE(call.number == element.seen + 1);
    REQUIRE(ledgers.n_open(call.epoch) > 0);
    element.seen = call.number;
  }
  /// The element leaves; later it arrives elsewhere and catches up, and its former PE learns of it.
  void migrate(PeId from, const Listener& element) {
    const PeId to = any_pe();
    const std::uint64_t seen = element.seen;
    log(from).left(seen);
    bag.post([this, from, to, seen] {
      if (ended) return;
      Listener arrived{seen};
      for (const NumberedCall& call : log(to).missed(seen)) receive(arrived, call);
      host(to).elements.push_back(arrived);
      bag.post([this, from, seen] {
        if (!ended) log(from).arrived(seen);
      });
    });
  }
  /// A random element of a PE migrates or is destroyed, or one is created there.
  void disturb() {
    const PeId pe = any_pe();
    std::vector<Listener>& elements = host(pe).elements;
    if (elements.empty() || bag.random.chance(0.2)) return create(pe);
    std::swap(elements[bag.random.below(elements.size())], elements.back());
    const Listener element = elements.back();
    elements.pop_back();
    if (bag.random.chance(0.8)) migrate(pe, element);
  }
  void step() {
    if (bag.random.chance(0.2)) disturb();
    if (!bag.empty()) bag.deliver_one();
  }
  /// The collection ends on all PEs; messages under way to it are dropped.
  void end() {
    ended = true;
    for (const auto& log_of_pe : of_pes) log_of_pe->end();
    while (!bag.empty()) bag.deliver_one();
  }

  Bag bag;
  Ledgers ledgers;
  std::vector<std::unique_ptr<LogHost>> hosts;
  std::vector<std::unique_ptr<BroadcastLog>> of_pes;
  std::vector<EpochId> epochs;  // of the broadcasts in the order of their starts
  std::uint64_t n_started = 0;
  std::uint64_t n_bytes = 0;  // of the arguments of a call
  bool ended = false;

 private:
  [[nodiscard]] PeId any_of(std::int32_t n_pes) {
    return PeId{static_cast<std::int32_t>(bag.random.below(static_cast<std::uint64_t>(n_pes)))};
  }

  const PeId root_;
};

void LogHost::send(PeId to, const NumberedCall& call) {
  ++n_held_;
  Counted::departs(logs_.ledgers.at(here_), call.epoch);
  logs_.bag.post([&logs = logs_, to, call] {
    Counted counted(logs.ledgers.at(to), call.epoch);
    if (!logs.ended) logs.log(to).on_call(NumberedCall(call), std::move(counted));
  });
}
void LogHost::send(PeId to, const BroadcastSettled& settled) {
  logs_.bag.post([&logs = logs_, to, settled] {
    if (!logs.ended) logs.log(to).on_settled(settled);
  });
}
void LogHost::send(PeId to, const BroadcastDrop& drop) {
  logs_.bag.post([&logs = logs_, to, drop] {
    if (!logs.ended) logs.log(to).on_drop(drop);
  });
}
/// Some of the elements that receive it migrate at once.
void LogHost::apply(const NumberedCall& call) {
  REQUIRE(n_held_ == 0);  // other processes do not wait for the local elements
  REQUIRE(logs_.log(here_).applied() == call.number);
  std::vector<Listener> kept;
  for (Listener& element : elements) {
    bool stays = true;
    if (element.seen < call.number) {
      logs_.receive(element, call);
      stays = logs_.bag.random.chance(0.8);
    }
    if (stays) {
      kept.push_back(element);
    } else {
      logs_.migrate(here_, element);
    }
  }
  elements = std::move(kept);
}

}  // namespace

TEST_CASE("an element receives each broadcast of its life once, in order and within its epoch",
          "[runtime][collections][broadcast_log]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    const auto n_pes = 1 + static_cast<std::int32_t>(seed % 9);
    Logs logs(n_pes, seed);
    for (int i = 0; i < 8; ++i) logs.create(logs.any_pe());
    while (logs.n_started < 60) {
      logs.start();
      for (std::uint64_t i = logs.bag.random.below(20); i > 0; --i) logs.step();
    }
    while (!logs.bag.empty()) logs.bag.deliver_one();
    for (const auto& host : logs.hosts)
      for (const Listener& element : host->elements) CHECK(element.seen == logs.n_started);
    for (const EpochId epoch : logs.epochs) {
      CHECK(logs.ledgers.sum(epoch).sent == static_cast<std::uint64_t>(n_pes));
      CHECK(logs.ledgers.n_open(epoch) == 0);
    }
    // Copies are dropped once all PEs have settled them, in portions; large ones at once.
    for (const auto& log : logs.of_pes) CHECK(log->n_kept() < 16);
    logs.n_bytes = 1 << 20;
    logs.start();
    while (!logs.bag.empty()) logs.bag.deliver_one();
    for (const auto& log : logs.of_pes) CHECK(log->n_kept() == 0);
  }
}

TEST_CASE("a broadcast's epoch waits for an element that left before it and has not arrived",
          "[runtime][collections][broadcast_log]") {
  Logs logs(2, 3);
  logs.log(PeId{0}).left(0);
  logs.start();
  while (!logs.bag.empty()) logs.bag.deliver_one();
  CHECK(logs.log(PeId{0}).applied() == 1);
  CHECK(logs.ledgers.n_open(logs.epochs[0]) == 1);
  logs.log(PeId{0}).arrived(0);
  CHECK(logs.ledgers.n_open(logs.epochs[0]) == 0);
}

TEST_CASE("the end of a collection settles the broadcasts that are under way",
          "[runtime][collections][broadcast_log]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    Logs logs(1 + static_cast<std::int32_t>(seed % 9), seed);
    for (int i = 0; i < 8; ++i) logs.create(logs.any_pe());
    for (int i = 0; i < 20; ++i) {
      logs.start();
      for (std::uint64_t k = logs.bag.random.below(20); k > 0; --k) logs.step();
    }
    logs.end();
    for (const EpochId epoch : logs.epochs) CHECK(logs.ledgers.n_open(epoch) == 0);
  }
}
