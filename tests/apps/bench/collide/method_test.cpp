// The methods of the benchmark: each finds the pairs that brute force finds, whatever library it
// is.
#include "apps/bench/collide/method.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace bench;

namespace {

std::vector<PackedPair> sorted(std::vector<PackedPair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

TEST_CASE("every method finds the pairs of brute force, each once", "[apps][bench][collide]") {
  for (const Case& full : box_cases()) {
    const Case of = smaller(full, 256);
    // Ours on floats has other objects than the rest, but not if all are rounded first.
    const Problem problem = widened(make_problem(of));
    const auto brute = brute_force(problem);
    REQUIRE(brute != nullptr);
    const auto expected = sorted(brute->pairs());
    // Of a few hundred needles hardly two meet.
    if (of.name != "one_model" && of.name != "needles") CHECK(!expected.empty());
    for (const MethodKind& kind : method_kinds()) {
      INFO(of.name << ' ' << kind.name);
      const auto method = kind.make(problem);
      if (!method) continue;
      CHECK(method->count() == expected.size());
      CHECK(sorted(method->pairs()) == expected);
      const auto candidates = sorted(method->candidates());
      CHECK(std::includes(candidates.begin(), candidates.end(), expected.begin(), expected.end()));
    }
  }
}

TEST_CASE("a box that is rounded outward contains the box, and is the next one of floats",
          "[apps][bench][collide]") {
  const Aabb box{{0.1, -0.1, 3}, {0.3, 1e-50, 1e10 + 1}};
  const FloatBox rounded = rounded_outward(box);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(static_cast<double>(rounded.lo[k]) <= box.lo[k]);
    CHECK(static_cast<double>(rounded.hi[k]) >= box.hi[k]);
  }
  CHECK(rounded.lo[2] == 3);
  CHECK(rounded.hi[1] > 0);
  CHECK(rounded.hi[1] < 1e-44F);
  CHECK(rounded.hi[2] == 1e10F + 1024);
}
