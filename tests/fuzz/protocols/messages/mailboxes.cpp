// A ring of elements that exchange edges with their neighbours, step by step, without a barrier:
// early messages wait in a mailbox, which migrates with its element; a coroutine lasts one step.
// The oracle is the same computation, serial.
#include "tests/fuzz/protocols/scenarios.hpp"

namespace tess::fuzz {
namespace {

struct Ring {
  int n_elements = 0, n_steps = 0;
  double move_chance = 0;
  std::vector<std::uint64_t> result{};

  /// The next value of an element from its own and its neighbours' values.
  static std::uint64_t next(std::uint64_t left, std::uint64_t me, std::uint64_t right) {
    return mix(left * 3 + me * 5 + right * 7);
  }
  [[nodiscard]] std::vector<std::uint64_t> serial() const {
    const auto n = static_cast<std::size_t>(n_elements);
    std::vector<std::uint64_t> now(n), then(n);
    for (std::size_t i = 0; i < n; ++i) now[i] = i;
    for (int step = 0; step < n_steps; ++step) {
      for (std::size_t i = 0; i < n; ++i)
        then[i] = next(now[(i + n - 1) % n], now[i], now[(i + 1) % n]);
      now = then;
    }
    return now;
  }
};
Ring* ring = nullptr;

struct Side {
  int key = 0;  // 2 × step + side
  std::uint64_t value = 0;
  std::string ballast;
};

class RingElement : public Chare<RingElement, Index1> {
 public:
  RingElement() : value_(static_cast<std::uint64_t>(index().x)) {}

  Task step(int step) {
    const int n = ring->n_elements, i = index().x;
    if (step == ring->n_steps) {
      const std::lock_guard lock(oracle);
      ring->result[static_cast<std::size_t>(i)] = value_;
      co_return;
    }
    array()[{(i + 1) % n}].send<&RingElement::take_in>(Side{2 * step, value_, "of the left"});
    array()[{(i + n - 1) % n}].send<&RingElement::take_in>(
        Side{2 * step + 1, value_, "of the right"});
    Random random(mix(static_cast<std::uint64_t>(step * 4096 + i)));
    if (random.chance(ring->move_chance)) move(random);  // takes effect when this step is done
    const Side left = co_await sides_.take(2 * step);
    const Side right = co_await sides_.take(2 * step + 1);
    expect(left.ballast == "of the left" && right.ballast == "of the right",
           "a message was garbled on its way");
    value_ = Ring::next(left.value, value_, right.value);
    array()[index()].send<&RingElement::step>(step + 1);
  }
  void take_in(Side side) {
    sides_.put(std::move(side));
    expect(sides_.size() <= 4, "an element is ", sides_.size(), " messages behind");
  }

  void serialize(auto& ar) { ar(value_, sides_); }

 private:
  void move(Random& random) { migrate_to(any_pe(random)); }

  std::uint64_t value_ = 0;
  Mailbox<&Side::key> sides_;
};

}  // namespace

void mailboxes(Case& test) {
  Ring here{test.draw(1, 24), test.draw(1, 20), 0.3 * test.draw(0, 2)};
  here.result.assign(static_cast<std::size_t>(here.n_elements), 0);
  ring = &here;
  test.run_clean(
      [&] { tess::create<RingElement>(range(here.n_elements)).broadcast<&RingElement::step>(0); });
  expect(here.result == here.serial(), "the result is not that of the serial computation");
}

}  // namespace tess::fuzz
