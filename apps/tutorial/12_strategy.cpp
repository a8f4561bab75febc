// Step 12: a balancing strategy of your own, with a name that --balance accepts.
#include "runtime/balance.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <numeric>

/// Deals the elements out as cards, the heaviest first: to PE 0, 1, 2, …, and back again.
tess::balance::Assignment deal(const tess::balance::Snapshot& snapshot) {
  const auto& elements = snapshot.elements;
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) {
    return elements.load[i].seconds_or(0);  // a load may be unknown yet
  });
  const std::size_t n_pes = snapshot.pes.size();
  tess::balance::Assignment result(elements.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t at = k % (2 * n_pes);
    result[order[k]] = tess::balance::pe_at(std::min(at, 2 * n_pes - 1 - at));
  }
  return result;
}

class Worker : public tess::Chare<Worker> {
 public:
  void work() {
    tess::charge(std::chrono::milliseconds(index().x < 4 ? 5 : 1));
    ++phase_;
    at_sync();
  }
  void resume_from_sync() {
    if (phase_ < 20) work();
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(phase_);
  }

 private:
  int phase_ = 0;
};

tess::Task measure(tess::BalanceOptions balance) {
  const auto workers = tess::create<Worker>(tess::range(16));
  (void)tess::start_balancing(workers, balance);
  const tess::Time begin = tess::now();
  co_await tess::epoch([&] { workers.broadcast<&Worker::work>(); });
  tess::print(balance.strategy, ": ", tess::seconds(tess::now() - begin), " s\n");
}

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    tess::balance::register_strategy("deal", deal);
    std::string balance = "deal";
    tess::CommandLine line("Balances 16 workers, of which 4 have five times the work.");
    line.option("--balance STRATEGY", balance, "a strategy, as deal,report");
    if (!line.parse(argc, argv)) return 0;
    return tess::run(setup, [options = tess::parse_balance(balance)] { return measure(options); });
  });
}
