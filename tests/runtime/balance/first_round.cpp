// The first balance round in the README's order: create, start_balancing, broadcast. There are 64
// chares; those created on PE 0 are four times as heavy. Every strategy that balances evens out the
// true loads in its first round, in which all loads are known. On threads, under mpirun and --sim.
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/runtime.hpp"

#include <array>

namespace {

constexpr std::int32_t n_chares = 64;

/// Of max/average after the round; before it is 2.3 on 4 PEs. Real machines measure what other
/// programs do, too.
double most_after() {
  return tess::machine().virtual_time() ? 1.4 : 1.9;
}

class Block : public tess::Chare<Block, tess::Index1> {
 public:
  void step(tess::Callback<std::vector<std::int64_t>> placement) {
    placement_ = std::move(placement);
    if (!tess::charge(std::chrono::microseconds(load_))) spin();
    at_sync();
  }
  void resume_from_sync() {
    std::vector<std::int64_t> of_pe(static_cast<std::size_t>(tess::n_pes()), 0);
    of_pe[static_cast<std::size_t>(tess::my_pe().value)] = load_;
    contribute(tess::sum, std::move(of_pe), placement_);
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& ar) { ar(placement_, load_, value_); }

 private:
  void spin() {
    for (std::int64_t i = 0; i < 300 * load_; ++i) value_ = value_ * 0.999 + 1;
  }
  tess::Callback<std::vector<std::int64_t>> placement_;
  std::int64_t load_ = tess::my_pe() == tess::PeId{0} ? 400 : 100;
  double value_ = 1;
};

/// The result of the first round of a strategy.
struct Outcome {
  double ratio = 0;  ///< max/average of the true loads
  std::size_t n_unknown = 0;
};

tess::Task balance_by(const std::string& strategy, Outcome* outcome) {
  const auto blocks = tess::create<Block>(tess::range(n_chares));
  const tess::BalancerProxy balancer = tess::start_balancing(blocks, {.strategy = strategy});
  const std::vector<std::int64_t> loads = co_await blocks.reduce<&Block::step>();
  double most = 0, sum = 0;
  for (const std::int64_t load : loads) {
    most = std::max(most, static_cast<double>(load));
    sum += static_cast<double>(load);
  }
  outcome->ratio = most / sum * static_cast<double>(loads.size());
  outcome->n_unknown = balancer.history().at(0).n_unknown;
}

tess::Task balance_by_all() {
  // Other programs disturb what is measured, on the simulated machine too unless messages have a
  // fixed cost: there the best of a few rounds counts. In each of them the call may overtake the
  // start of balancing on its way to a PE, whose elements then have unknown loads (balance.hpp).
  const int n_tries = tess::machine().message_cost() > tess::Time(0) ? 1 : 8;
  bool good = true;
  for (const std::string& name : tess::balance::strategy_names()) {
    if (name == "none" || name == "rotate" || name == "random") continue;
    Outcome best{1e9, 0};
    for (int k = 0; k < n_tries && (best.ratio > most_after() || best.n_unknown != 0); ++k) {
      Outcome one;
      co_await balance_by(name, &one);
      const bool better = one.n_unknown == 0 && (best.n_unknown != 0 || one.ratio < best.ratio);
      if (k == 0 || better) best = one;
    }
    tess::print(name, ": ", best.ratio, ", unknown loads ", best.n_unknown, "\n");
    good = good && best.ratio <= most_after() && best.n_unknown == 0;
  }
  if (!good) tess::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  return tess::run(argc, argv, [] { return balance_by_all(); });
}
