// Periodic rounds run beside the elements' work: a round does not wait for the messages that are
// ready.
#include "runtime/balance.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <vector>

namespace {

using namespace tess;
using namespace std::chrono_literals;

constexpr int n_busy_workers = 64;
constexpr int n_busy_tasks = 40;
constexpr auto longest_task = 2ms;

/// Has a message ready at any time; the first ones need the most time.
class BusyWorker : public Chare<BusyWorker> {
 public:
  void work(int n_left, Callback<int> done) {
    charge(longest_task - 20us * index().x);
    ++n_done_;
    if (n_left > 1) {
      self().send<&BusyWorker::work>(n_left - 1, done);
    } else {
      contribute(sum, n_done_, done);
    }
  }
  void serialize(auto& ar) { ar(n_done_); }

 private:
  int n_done_ = 0;
};

struct BusyOutcome {
  int n_done = 0;
  std::vector<balance::Round> rounds;
};

Task keep_busy(BusyOutcome& outcome) {
  const auto workers = create<BusyWorker>(range(n_busy_workers));
  const auto balancer = start_balancing(
      workers, {.strategy = "greedy_refine", .when = BalanceWhen::periodic, .period = 100ms});
  outcome.n_done = co_await workers.reduce<&BusyWorker::work>(n_busy_tasks);
  outcome.rounds = balancer.history();
}

}  // namespace

TEST_CASE("a periodic round waits at each of its steps for the running task, not for the queue",
          "[balance]") {
  const std::array<int, 2> sizes{1, 4};
  for (const int per_process : sizes) {
    INFO(per_process << " PEs per process");
    BusyOutcome outcome;
    const test::Machine machine{
        .pes = 4, .per_process = per_process, .reordering = 0, .migration = 0};
    machine.run([&] { return keep_busy(outcome); }).require_success();
    CHECK(outcome.n_done == n_busy_workers * n_busy_tasks);
    REQUIRE(outcome.rounds.size() >= 3);
    std::uint64_t n_moved = 0;
    for (const balance::Round& round : outcome.rounds) n_moved += round.n_moved;
    CHECK(n_moved > 0);
    // A queue of 16 tasks takes about 20 ms. The steps: the start of the broadcast, the broadcast,
    // two levels of reports, their result, the moves, and the news of them.
    for (const balance::Round& round : outcome.rounds)
      CHECK(round.round_seconds <=
            8 * 1e-9 * static_cast<double>(std::chrono::nanoseconds(longest_task).count()));
  }
}
