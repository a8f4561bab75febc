// Epochs one after another, each with few but long messages: PEs idle, report and continue, again
// and again. The run must not be taken for over while an epoch's report is due.
#include "tests/fuzz/protocols/scenarios.hpp"

namespace tess::fuzz {
namespace {

struct IdleDraws {
  Random random;
  int n_elements = 0;
  std::uint64_t longest = 0;  // ns of work of one message
  int due = 0;                // messages under way
};
IdleDraws* idle_draws = nullptr;

class Worker : public Chare<Worker, Index1> {
 public:
  /// Works, and sends `n_more` messages, one from another.
  void work(int n_more) {
    tess::charge(Time(static_cast<std::int64_t>(idle_draws->random.below(idle_draws->longest))));
    if (n_more > 0) {
      const auto to = draw(idle_draws->random, idle_draws->n_elements);
      ++idle_draws->due;
      array()[{to}].send<&Worker::work>(n_more - 1);
    }
    --idle_draws->due;
  }
};

Task run_epochs(Case& test, int n_epochs) {
  const auto workers = tess::create<Worker>(range(idle_draws->n_elements));
  for (int i = 0; i < n_epochs; ++i) {
    co_await epoch([&] {
      if (i % 2 == 0) {
        idle_draws->due += idle_draws->n_elements;
        workers.broadcast<&Worker::work>(i % 3);
        return;
      }
      for (int k = test.draw(1, 4); k > 0; --k) {
        ++idle_draws->due;
        workers[{test.draw(0, idle_draws->n_elements - 1)}].send<&Worker::work>(test.draw(0, 4));
      }
    });
    expect(idle_draws->due == 0, "epoch ", i, " returned with ", idle_draws->due,
           " messages to do");
  }
  tess::exit(0);
}

}  // namespace

void idle_reports(Case& test) {
  IdleDraws here{Random(test.random()), test.draw(1, 32), 300ULL << test.draw(0, 6), 0};
  idle_draws = &here;
  const int n_epochs = test.draw(1, 60);
  test.run_clean([&] { return run_epochs(test, n_epochs); });
}

}  // namespace tess::fuzz
