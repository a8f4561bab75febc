// Completion by itself: PEs as Completion objects, their messages in one bag from which a random
// one is delivered next. The oracle counts the messages of each epoch that are not done.
#include "runtime/pe/completion/completion.hpp"

#include "runtime/core/hash.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "tests/support/catch.hpp"

#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

namespace {

using namespace tess;
using namespace tess::detail;
namespace messages = tess::detail::completion;

/// A user's message on its way; when it is done it may send others.
struct Work {
  EpochId epoch{};
  int energy = 0;
};
using Any = std::variant<messages::Report, messages::Answer, messages::Wave, messages::Echo,
                         messages::End, Work>;
struct Posted {
  PeId to{};
  Any what;
};

class Network;

class Port final : public CompletionMessages {
 public:
  explicit Port(Network& network) : network_(network) {}
  void send(PeId to, const messages::Report& m) override { post(to, m); }
  void send(PeId to, const messages::Answer& m) override { post(to, m); }
  void send(PeId to, const messages::Wave& m) override { post(to, m); }
  void send(PeId to, const messages::Echo& m) override { post(to, m); }
  void send(PeId to, const messages::End& m) override { post(to, m); }
  void quiescent() override;

  Completion* self = nullptr;

 private:
  template <class M>
  void post(PeId to, const M& m);
  Network& network_;
};

class Network {
 public:
  Network(std::int32_t n_pes, std::uint64_t seed) : random(seed) {
    for (std::int32_t i = 0; i < n_pes; ++i) {
      ports_.push_back(std::make_unique<Port>(*this));
      pes.push_back(std::make_unique<Completion>(*ports_.back(), PeId{i}, n_pes));
      ports_.back()->self = pes.back().get();
    }
  }

  [[nodiscard]] PeId any_pe() { return PeId{static_cast<std::int32_t>(random.below(pes.size()))}; }
  [[nodiscard]] Completion& at(PeId pe) { return *pes[static_cast<std::size_t>(pe.value)]; }

  /// Sends a user's message of that epoch.
  void work(PeId from, Work work) {
    ++n_due;
    ++due_of[work.epoch.value];
    Counted::departs(at(from), work.epoch);
    at(from).hop_sent();
    bag.push_back({any_pe(), work});
  }

  /// Delivers one message, or lets one PE run dry. False if nothing is left to do.
  bool step() {
    if (!bag.empty() && !random.chance(0.3)) {
      std::swap(bag[random.below(bag.size())], bag.back());
      const Posted posted = std::move(bag.back());
      bag.pop_back();
      std::visit([&](const auto& m) { deliver(posted.to, m); }, posted.what);
      return true;
    }
    const PeId dry = any_pe();
    if (idle(dry)) return true;
    if (!bag.empty()) return true;
    for (std::size_t i = 0; i < pes.size(); ++i)
      if (idle(PeId{static_cast<std::int32_t>(i)})) return true;
    return false;
  }

  Random random;
  std::vector<std::unique_ptr<Completion>> pes;
  std::vector<Posted> bag;
  int n_due = 0;                        // user messages that are not done
  std::map<std::uint64_t, int> due_of;  // the same, by epoch
  int n_open = 0;
  bool quiescent = false;

 private:
  bool idle(PeId pe) {
    if (at(pe).report_epochs()) return true;
    return at(pe).run_changed() && at(pe).report_run();
  }
  void deliver(PeId to, const Work& work) {
    const Counted counted(at(to), work.epoch);
    for (int energy = work.energy; energy > 0; energy /= 2)
      if (random.chance(0.5)) this->work(to, {work.epoch, energy / 2});
    --n_due;
    --due_of[work.epoch.value];
    at(to).hop_processed();
  }
  /// Messages of epochs are hops of the run; those of the run are not.
  template <class Message>
  void deliver(PeId to, const Message& m) {
    at(to).on(m);
    if (m.epoch.value != 0) at(to).hop_processed();
  }

  std::vector<std::unique_ptr<Port>> ports_;
};

template <class M>
void Port::post(PeId to, const M& m) {
  if (m.epoch.value != 0) self->hop_sent();
  network_.bag.push_back({to, m});
}
void Port::quiescent() {
  REQUIRE(network_.n_due == 0);
  REQUIRE(network_.n_open == 0);
  network_.quiescent = true;
}

/// `n_epochs` epochs one after another, each opened on PE 0 when the one before it has ended.
void open_next(Network& network, int n_epochs) {
  if (n_epochs == 0) return;
  ++network.n_open;
  const PeId opener{0};
  const EpochId epoch = network.at(opener).open(EpochId{}, [&network, n_epochs] {
    REQUIRE(network.n_due == 0);
    --network.n_open;
    open_next(network, n_epochs - 1);
  });
  const auto n = network.random.below(4);
  for (std::uint64_t i = 0; i < n; ++i)
    network.work(opener, {epoch, static_cast<int>(network.random.below(40))});
  network.at(opener).close(epoch);
}

}  // namespace

TEST_CASE("an epoch ends after all of its messages, and the run after all epochs",
          "[runtime][completion]") {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    INFO("seed " << seed);
    Network network(1 + static_cast<std::int32_t>(seed % 23), seed);
    open_next(network, 6);
    int n_steps = 0;
    while (!network.quiescent) {
      REQUIRE(network.step());  // otherwise it stands still, and nothing has noticed
      REQUIRE(++n_steps < 100'000);
    }
  }
}

TEST_CASE("epochs that overlap end each by itself", "[runtime][completion]") {
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    INFO("seed " << seed);
    Network network(2 + static_cast<std::int32_t>(seed % 9), seed);
    for (int i = 0; i < 5; ++i) {
      const PeId opener = network.any_pe();
      ++network.n_open;
      const auto self = std::make_shared<EpochId>();
      const EpochId epoch = network.at(opener).open(EpochId{}, [&network, self] {
        REQUIRE(network.due_of[self->value] == 0);
        --network.n_open;
      });
      *self = epoch;
      network.work(opener, {epoch, static_cast<int>(network.random.below(100))});
      network.at(opener).close(epoch);
    }
    while (!network.quiescent) REQUIRE(network.step());
    CHECK(network.n_open == 0);
    for (const auto& pe : network.pes) CHECK(pe->n_epochs() == 0);  // each was told of the ends
  }
}

TEST_CASE("an epoch does not end before it is closed", "[runtime][completion]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    Network network(1 + static_cast<std::int32_t>(seed % 9), seed);
    const PeId opener = network.any_pe();
    bool ended = false;
    const EpochId epoch = network.at(opener).open(EpochId{}, [&ended] { ended = true; });
    network.n_open = 1;
    network.at(opener).hop_sent();  // the message whose code opens and closes the epoch
    const Work body{epoch, static_cast<int>(network.random.below(30))};
    for (int part = 0; part < 3; ++part) {
      network.work(opener, body);
      for (int i = 0; i < 200; ++i) (void)network.step();
      REQUIRE_FALSE(ended);
    }
    network.n_open = 0;
    network.at(opener).close(epoch);
    network.at(opener).hop_processed();
    while (!network.quiescent) REQUIRE(network.step());
    CHECK(ended);
  }
}

TEST_CASE("an epoch waits for those opened in it", "[runtime][completion]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    Network network(2 + static_cast<std::int32_t>(seed % 5), seed);
    const PeId outer_opener = network.any_pe(), inner_opener = network.any_pe();
    int n_ended = 0;
    const EpochId outer = network.at(outer_opener).open(EpochId{}, [&n_ended] {
      CHECK(n_ended == 1);
      ++n_ended;
    });
    const EpochId inner = network.at(inner_opener).open(outer, [&n_ended] { ++n_ended; });
    network.at(outer_opener).close(outer);
    network.work(inner_opener, {inner, static_cast<int>(network.random.below(60))});
    network.at(inner_opener).close(inner);
    while (!network.quiescent) REQUIRE(network.step());
    CHECK(n_ended == 2);
  }
}

TEST_CASE("a PE reports an epoch once until it is answered", "[runtime][completion]") {
  Network network(2, 7);
  bool ended = false;
  const EpochId epoch = network.at(PeId{0}).open(EpochId{}, [&ended] { ended = true; });
  Completion& other = network.at(PeId{1});
  for (int i = 0; i < 10; ++i) {
    Counted::departs(other, epoch);
    (void)other.report_epochs();
  }
  REQUIRE(network.bag.size() == 1);
  CHECK(std::get<messages::Report>(network.bag.front().what).counters == Counters{1, 0});
  other.on(messages::Answer{epoch});
  (void)other.report_epochs();
  REQUIRE(network.bag.size() == 2);
  CHECK(std::get<messages::Report>(network.bag.back().what).counters == Counters{10, 0});
  CHECK_FALSE(ended);
}

namespace {

/// The Completion of a PE that coordinates no epoch, and what it has counted.
class Counts {
 public:
  [[nodiscard]] Counters of(EpochId epoch) {
    network_.bag.clear();
    completion().on(messages::Wave{epoch, PeId{0}, 1});
    return std::get<messages::Echo>(network_.bag.back().what).sum;
  }
  [[nodiscard]] Completion& completion() { return network_.at(PeId{1}); }

 private:
  Network network_{2, 1};
};

constexpr EpochId one_epoch{std::uint64_t{1} << 24U}, other_epoch{std::uint64_t{2} << 24U};

}  // namespace

TEST_CASE("a message counts itself: as sent when it is made, as processed when it is gone",
          "[runtime][completion]") {
  Counts counts;
  {
    const Counted made = Counted::sent(counts.completion(), one_epoch);
    CHECK(made.epoch() == one_epoch);
    CHECK(counts.of(one_epoch) == Counters{1, 0});
  }
  CHECK(counts.of(one_epoch) == Counters{1, 1});
  { const Counted none; }
  { const Counted of_run = Counted::sent(counts.completion(), EpochId{}); }
  CHECK(counts.completion().n_epochs() == 1);
}

TEST_CASE("a message that leaves for another PE is processed there", "[runtime][completion]") {
  Counts here, there;
  const EpochId travels = Counted::departs(here.completion(), one_epoch);
  CHECK(here.of(one_epoch) == Counters{1, 0});
  {
    Counted arrived(there.completion(), travels);
    CHECK(there.of(one_epoch) == Counters{0, 0});
    CHECK(arrived.leave() == one_epoch);
    CHECK(arrived.epoch() == EpochId{});
  }
  CHECK(there.of(one_epoch) == Counters{0, 0});  // it went on
  { const Counted back(here.completion(), travels); }
  CHECK(here.of(one_epoch) == Counters{1, 1});
}

TEST_CASE("a message that moves counts once, and one that is replaced is gone",
          "[runtime][completion]") {
  Counts counts;
  Counted first = Counted::sent(counts.completion(), one_epoch);
  Counted kept(std::move(first));
  first = Counted::sent(counts.completion(), other_epoch);
  CHECK(counts.of(one_epoch) == Counters{1, 0});
  kept = std::move(first);
  CHECK(counts.of(one_epoch) == Counters{1, 1});
  CHECK(counts.of(other_epoch) == Counters{1, 0});
  CHECK(kept.epoch() == other_epoch);
  kept.done();
  CHECK(counts.of(other_epoch) == Counters{1, 1});

  // A table that is dropped counts what waits in it.
  std::vector<Counted> table;
  for (int i = 0; i < 20; ++i) table.push_back(Counted::sent(counts.completion(), one_epoch));
  table.erase(table.begin() + 3);
  CHECK(counts.of(one_epoch) == Counters{21, 2});
  table.clear();
  CHECK(counts.of(one_epoch) == Counters{21, 21});
}

TEST_CASE("the run waits for what holds it", "[runtime][completion]") {
  Counts counts;
  {
    RunHold first(counts.completion());
    const RunHold held(std::move(first));
    CHECK(counts.completion().run_sent() == 1);
    CHECK(counts.completion().run_processed() == 0);
  }
  CHECK(counts.completion().run_processed() == 1);
}

TEST_CASE("a PE that an exception has stopped reports no epoch", "[runtime][completion]") {
  Network network(2, 7);
  Completion& other = network.at(PeId{1});
  Counted::departs(other, one_epoch);
  other.stop_reporting();
  CHECK_FALSE(other.report_epochs());
  CHECK(network.bag.empty());
}
