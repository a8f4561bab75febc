#include "runtime/balance/prediction.hpp"

#include "apps/bench/balance_scenes.hpp"
#include "tests/support/catch.hpp"

using namespace tess;
using namespace tess::balance;

namespace {

/// Elements 0, 1, … of array 0 with these loads; below 0: not there.
Snapshot phase(const std::vector<double>& loads) {
  Snapshot s = idle_pes(2);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i] < 0) continue;
    s.elements.key[add_element(s, 0, loads[i])].element = i;
  }
  return s;
}

ElementKey key(std::uint64_t element) {
  return {CollectionId{0}, element};
}

}  // namespace

TEST_CASE("predictions continue constant, noisy and linear loads", "[balance]") {
  Predictor last(Prediction::last);
  Predictor mean(Prediction::moving_average, 4);
  Predictor trend(Prediction::linear_trend, 4);
  for (std::size_t k = 0; k < 10; ++k) {
    const auto x = static_cast<double>(k);
    for (Predictor* p : {&last, &mean, &trend})
      p->record(phase({3, k % 2 == 0 ? 1.0 : 2.0, 5 + 2 * x, 9 - x}));
  }
  CHECK(last.load(key(0)) == 3);
  CHECK(last.load(key(1)) == 2);
  CHECK(mean.load(key(0)) == Approx(3));
  CHECK(mean.load(key(1)) == Approx(1.5));
  CHECK(mean.load(key(2)) == Approx(5 + 2 * 7.5));
  CHECK(trend.load(key(0)) == Approx(3));
  CHECK(trend.load(key(2)) == Approx(25));
  CHECK(trend.load(key(3)) == Approx(0).margin(1e-12));
}

TEST_CASE("phases whose loads are not recorded count as phases", "[balance]") {
  Predictor trend(Prediction::linear_trend, 5);
  for (int k = 0; k < 12; ++k) {
    if (k == 0 || k == 5 || k == 6 || k == 11)
      trend.record(phase({10.0 + k}));
    else
      trend.pass();
  }
  CHECK(trend.load(key(0)) == Approx(22));
}

TEST_CASE("an element that comes back meets its history, one that stays away is forgotten",
          "[balance]") {
  Predictor trend(Prediction::linear_trend, 5, 3);
  trend.record(phase({1, 10}));
  trend.record(phase({2, 10}));
  trend.record(phase({-1, 10}));
  CHECK(trend.load(key(0)) == Approx(4));  // phase 4 of a load that is the phase's number
  const Snapshot back = trend.predict(phase({100, 100, 100}));
  CHECK(back.elements.load[0].seconds() == Approx(4));
  CHECK(back.elements.load[1].seconds() == Approx(10));
  CHECK(back.elements.load[2] == 100);  // never seen
  for (int k = 0; k < 3; ++k) trend.record(phase({-1, 10}));
  CHECK(trend.n_known() == 1);
  CHECK(trend.load(key(0)) == 0);
}

TEST_CASE("a prediction follows its element to another PE", "[balance]") {
  Predictor mean(Prediction::moving_average);
  Snapshot s = phase({4, 6});
  mean.record(s);
  std::swap(s.elements.key[0], s.elements.key[1]);
  s.elements.pe[0] = PeId{1};
  s.elements.load = {8, 4};
  mean.record(s);
  CHECK(mean.load(key(0)) == Approx(4));
  CHECK(mean.load(key(1)) == Approx(7));
}

TEST_CASE("an unknown prediction is refused with the names that exist", "[balance]") {
  CHECK_THROWS_WITH(parse_prediction("best"), Catch::Contains("last, moving_average"));
  CHECK(parse_prediction("linear_trend") == Prediction::linear_trend);
}
