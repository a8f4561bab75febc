// A test of an outside project, without a test framework: chares under adversarial order.
#include <runtime/more/testing.hpp>
#include <runtime/runtime.hpp>

class Adder : public tess::Chare<Adder> {
 public:
  void add(int n) { sum_ += n; }
  [[nodiscard]] int sum() { return sum_; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(sum_);
  }

 private:
  int sum_ = 0;
};

tess::Task add_up(int& found) {
  const auto adders = tess::create<Adder>(tess::range(4));
  co_await tess::epoch([&] {
    for (int n = 1; n <= 4; ++n) adders[{3}].send<&Adder::add>(n);
  });
  const int sum = co_await adders[{3}].ask<&Adder::sum>();
  found = sum;
}

int main() {
  tess::test::for_seeds(0, 20, [](std::uint64_t seed) {
    int found = 0;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> tess::Task { return add_up(found); }).require_success();
    tess::test::expect(found == 10, "found ", found);
  });
  tess::print("20 seeds pass\n");
}
