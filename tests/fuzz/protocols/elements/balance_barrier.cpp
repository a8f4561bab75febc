// The balancer's barrier, for elements that migrate and wait while balancing starts.
#include "runtime/balance.hpp"
#include "runtime/balance/strategy.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <array>
#include <atomic>

namespace tess::fuzz {
namespace {

/// Counts the elements that have reached each barrier. Some migrate first, and leave again while
/// they wait for the first barrier: to PEs where balancing has started, and to others.
class BarrierElement : public Chare<BarrierElement, Index1> {
 public:
  static constexpr int n_phases = 8;
  static inline int n = 0;
  static inline std::array<std::atomic<int>, n_phases + 1> reached{};

  void begin(int n_moves) {
    if (n_moves == 0) {
      reach();
    } else {
      array()[index()].send<&BarrierElement::begin>(n_moves - 1);
    }
    if (n_moves > 0 || moves_) move_away();
    moves_ = n_moves > 0;
  }
  void resume_from_sync() {
    expect(reached[static_cast<std::size_t>(phase_)] == n, element_text(*this), " is past barrier ",
           phase_, ", which ", reached[static_cast<std::size_t>(phase_)].load(), " of ", n,
           " have reached");
    if (++phase_ <= n_phases) reach();
  }
  [[nodiscard]] std::array<double, 3> balance_position() const { return {1.0 * index().x, 0, 0}; }
  void serialize(auto& ar) { ar(phase_, moves_); }

 private:
  void move_away() {
    const std::int32_t n_pes = tess::n_pes();
    migrate_to(PeId{(tess::my_pe().value + 1 + index().x % n_pes) % n_pes});
  }
  void reach() {
    charge(std::chrono::microseconds(1 + index().x % 3));
    ++reached[static_cast<std::size_t>(phase_)];
    at_sync();
  }
  int phase_ = 0;
  bool moves_ = false;
};

}  // namespace

void balance_barrier(Case& test) {
  BarrierElement::n = test.draw(1, 20);
  for (auto& count : BarrierElement::reached) count = 0;
  BalanceOptions options;
  do options.strategy = any_of(balance::strategy_names(), test.random);
  while (options.strategy == "none");  // no barrier
  const int n_moves = test.draw(0, 3);
  test.run_clean([&] {
    const auto elements = create<BarrierElement>(range(BarrierElement::n));
    if (test.seed % 2 == 0) elements.broadcast<&BarrierElement::begin>(n_moves);
    start_balancing(elements, options);
    if (test.seed % 2 != 0) elements.broadcast<&BarrierElement::begin>(n_moves);
  });
  for (const auto& count : BarrierElement::reached)
    expect(count == BarrierElement::n, count.load(), " of ", BarrierElement::n,
           " reached a barrier");
}

}  // namespace tess::fuzz
