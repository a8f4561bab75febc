// Costs of the parts of a step, fitted to steps whose times are known sums.
#include "apps/collide_scaling/costs.hpp"

#include "tests/support/catch.hpp"

namespace {

using namespace collide_scaling;

/// Fits costs to steps with items as in the scenes of the study.
SimulatedCosts fitted_to(double gridding, double search, double pair, double reply) {
  std::vector<MeasuredStep> steps{{{98e3, 98e3, 190e3, 190e3}},
                                  {{98e3, 98e3, 190e3, 380e3}},
                                  {{98e3, 96e3, 90e3, 90e3}},
                                  {{97e3, 90e3, 0, 0}},
                                  {{98e3, 0, 0, 0}}};
  for (auto& [n, nanoseconds] : steps)
    nanoseconds = gridding * n[0] + search * n[1] + pair * n[2] + reply * n[3];
  return fitted_costs(steps);
}

}  // namespace

TEST_CASE("the costs of parts are fitted to steps in which they have different shares",
          "[collide_scaling]") {
  const SimulatedCosts costs = fitted_to(9, 20, 3, 1.5);
  CHECK(costs.gridding == Approx(9));
  CHECK(costs.search == Approx(20));
  CHECK(costs.pair == Approx(3));
  CHECK(costs.reply == Approx(1.5));
  const SimulatedCosts not_negative = fitted_to(9, 20, 3, -0.5);
  CHECK(not_negative.reply == 0);
  CHECK(not_negative.pair < 3);
}

TEST_CASE("costs are read from their text, and other texts are refused", "[collide_scaling]") {
  CHECK(text_of(parse_costs({"pair=3.5ns", "gridding=9.31ns"})) ==
        "gridding=9.31ns,search=0ns,pair=3.5ns,reply=0ns,copy=0ns,record=0ns");
  for (const std::string text : {"pair", "pair=", "pair=3", "pair=3us", "pairs=3ns", "pair=-3ns"})
    CHECK_THROWS_WITH(parse_costs({text}), Catch::Contains("--costs " + text + ": give parts as"));
}
