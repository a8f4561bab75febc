// Reductions: operations with state, exact sums, order, and their results.
#include "runtime/reduction.hpp"

#include "runtime/core/exact_sum.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

#include <cmath>
#include <numeric>

namespace {

/// a + b, in units of `unit`: an operation with a member.
struct InUnits {
  int unit = 1;
  int operator()(int a, int b) const { return (a / unit + b / unit) * unit; }
  friend bool operator==(const InUnits&, const InUnits&) = default;
};

class Giver : public tess::Chare<Giver> {
 public:
  void add(int unit, tess::Callback<int> target) { contribute(InUnits{unit}, 25, target); }
  void add_in_order(int unit, tess::Callback<int> target) {
    contribute(tess::in_order(InUnits{unit}), 25, target);
  }
  static double summand(int i) { return std::ldexp(1.0 / (1 + i), 7 * (i % 9)); }
  void add_exactly(tess::Callback<tess::ExactSum> target) {
    tess::ExactSum own;
    own.add(summand(index().x));
    contribute(tess::AddExactSums{}, own, target);
  }
  void there(tess::Callback<void> target) { contribute(target); }
  void four(int a, std::string b, double c, std::vector<int> d, tess::Callback<double> target) {
    target(a + static_cast<double>(b.size()) + c + static_cast<double>(d.size()));
  }
  void give(tess::Callback<std::vector<int>> to) {
    contribute(tess::in_order(tess::concatenate), std::vector<int>{index().x}, to);
  }
};

class Greeter : public tess::Group<Greeter> {
 public:
  void hello(tess::Callback<int> target) { contribute(tess::sum, 1, target); }
};

tess::Task collect_values(std::vector<int>& gathered, int n) {
  const auto members = tess::create<Giver>(tess::sparse);
  co_await tess::epoch([&] {
    for (int i = 0; i < n; ++i) members[{(i * 37) % n}].insert_on(tess::PeId{i % 3});
  });
  gathered = co_await members.reduce<&Giver::give>();
}

}  // namespace

TEST_CASE("the state of a reduction's operation travels", "[runtime][reduction]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Giver>(tess::range(6));
    tess::Future<int> merged, ordered;
    nodes.broadcast<&Giver::add>(10, merged.callback());
    CHECK(co_await merged == 120);
    nodes.broadcast<&Giver::add_in_order>(10, ordered.callback());
    CHECK(co_await ordered == 120);
  });
}

TEST_CASE("the greatest and least of values with NaN are NaN, in every order",
          "[runtime][reduction]") {
  const double nan = std::nan("");
  for (const auto& [a, b] : {std::pair(nan, 1.0), {1.0, nan}, {nan, nan}}) {
    CHECK(std::isnan(tess::max(a, b)));
    CHECK(std::isnan(tess::min(a, b)));
  }
  CHECK(tess::max(1.0, 2.0) == 2);
  CHECK(tess::min(std::vector<double>{1, nan}, std::vector<double>{0, 5})[0] == 0);
  CHECK(std::isnan(tess::min(std::vector<double>{1, nan}, std::vector<double>{0, 5})[1]));
}

TEST_CASE("a reduction of exact sums has the same bits in every order", "[runtime][reduction]") {
  constexpr int n = 40;
  double rounded = 0;
  tess::ExactSum exact;
  for (int i = n - 1; i >= 0; --i) {
    exact.add(Giver::summand(i));
    rounded += Giver::summand(i);
  }
  CHECK(rounded != exact.total());
  tests::over_seeds(20, tests::two_processes, [&exact]() -> tess::Task {
    const auto nodes = tess::create<Giver>(tess::range(n));
    const tess::ExactSum all = co_await nodes.reduce<&Giver::add_exactly>();
    CHECK(all.total() == exact.total());
  });
}

TEST_CASE("reduce() broadcasts and gives the future of the result, for now or for later",
          "[runtime][reduction]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto nodes = tess::create<Giver>(tess::range(4));
    const auto members = tess::create<Greeter>(tess::each_pe);
    const int merged = co_await nodes.reduce<&Giver::add>(1);
    CHECK(merged == 100);
    co_await nodes.reduce<&Giver::there>();

    auto first = nodes.with(tess::expedited).reduce<&Giver::add_in_order>(2);
    auto second = members.reduce<&Greeter::hello>();
    CHECK(co_await second == tess::n_pes());
    CHECK(co_await first == 96);

    // One element may also give the result by itself. The arguments have memory of their own.
    const auto one = tess::create<Giver>(tess::range(1));
    const double all =
        co_await one.reduce<&Giver::four>(1, std::string(40, 'x'), 0.5, std::vector<int>(3));
    CHECK(all == 44.5);
  });
}

TEST_CASE("in_order combines in the order of indices, wherever the elements are",
          "[runtime][reduction]") {
  std::vector<int> expected(50);
  std::iota(expected.begin(), expected.end(), 0);
  tests::over_seeds(20, "pes=3,cost=100ns", [&expected]() -> tess::Task {
    std::vector<int> gathered;
    co_await collect_values(gathered, 50);
    CHECK(gathered == expected);
  });
}
