// Epochs one after another, each with few but long messages: PEs idle, report and continue, again
// and again. The run must not be taken for over while an epoch's report is due.
#include "apps/protocol_fuzz/scenarios.hpp"

namespace tess::fuzz {
namespace {

struct Plan {
  Random random;
  int n_elements = 0;
  std::uint64_t longest = 0;  // ns of work of one message
  int due = 0;                // messages under way
};
Plan* plan = nullptr;

class Worker : public Chare<Worker, Index1> {
 public:
  /// Works, and sends `n_more` messages, one from another.
  void work(int n_more) {
    tess::charge(Time(static_cast<std::int64_t>(plan->random.below(plan->longest))));
    if (n_more > 0) {
      const auto to =
          static_cast<int>(plan->random.below(static_cast<std::uint64_t>(plan->n_elements)));
      ++plan->due;
      array()[{to}].send<&Worker::work>(n_more - 1);
    }
    --plan->due;
  }
};

Task play(Trial& trial, int n_epochs) {
  const auto workers = tess::create<Worker>(range(plan->n_elements));
  for (int i = 0; i < n_epochs; ++i) {
    co_await epoch([&] {
      if (i % 2 == 0) {
        plan->due += plan->n_elements;
        workers.broadcast<&Worker::work>(i % 3);
        return;
      }
      for (int k = trial.draw(1, 4); k > 0; --k) {
        ++plan->due;
        workers[{trial.draw(0, plan->n_elements - 1)}].send<&Worker::work>(trial.draw(0, 4));
      }
    });
    trial.expect(plan->due == 0, "epoch ", i, " returned with ", plan->due, " messages to do");
  }
  tess::exit(0);
}

}  // namespace

void pauses(Trial& trial) {
  Plan here{Random(trial.random()()), trial.draw(1, 32), 300ULL << trial.draw(0, 6), 0};
  plan = &here;
  const int n_epochs = trial.draw(1, 60);
  trial.run_clean([&] { return play(trial, n_epochs); });
}

}  // namespace tess::fuzz
