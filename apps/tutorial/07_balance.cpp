// Step 7: load balancing. 16 workers, of which the first 4 have five times the work. They are all
// on one PE at first; a balancer that measures them spreads them.
#include "runtime/balance.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

constexpr int n_phases = 20;

class Worker : public tess::Chare<Worker> {
 public:
  void begin(tess::Callback<void> done) {
    done_ = done;
    work();
  }
  void work() {
    // On the simulated machine this takes virtual time; a real program computes here.
    tess::charge(std::chrono::milliseconds(index().x < 4 ? 5 : 1));
    ++phase_;
    at_sync();  // the end of this element's part of the phase
  }
  void resume_from_sync() {  // all have reached the end, and the round of the balancer is over
    if (phase_ < n_phases) return work();
    contribute(done_);  // without a value: all are there
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(phase_, done_);
  }

 private:
  int phase_ = 0;
  tess::Callback<void> done_;
};

tess::Task measure(std::string chosen) {
  for (const std::string& strategy : {std::string("none"), chosen}) {
    const auto workers = tess::create<Worker>(tess::range(16));
    const auto balancer = tess::start_balancing(workers, {.strategy = strategy});
    const tess::Time begin = tess::now();
    co_await workers.reduce<&Worker::begin>();
    std::size_t n_moves = 0;
    for (const auto& round : balancer.history()) n_moves += round.n_moved;
    tess::print(strategy, ": ", n_moves, " moves, ", tess::seconds(tess::now() - begin), " s\n");
  }
}

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    std::string strategy = "greedy_refine";
    tess::CommandLine line("Balances 16 workers, of which 4 have five times the work.");
    line.option("--strategy NAME", strategy, "where elements go");
    if (!line.parse(argc, argv)) return 0;
    return tess::run(setup, [=] { return measure(strategy); });
  });
}
