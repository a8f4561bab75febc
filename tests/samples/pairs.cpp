// The sample of collide/pairs.hpp, compiled and run. tests/samples/check.py compares the text.
#include "collide/pairs.hpp"

#include "tests/support/catch.hpp"

using namespace tess::collide;

TEST_CASE("the sample of collide/pairs.hpp finds the pairs of a row, and of two rows", "[sample]") {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 8; ++i) boxes.push_back({{1.0 * i, 0, 0}, {i + 1.5, 1, 1}});
  const std::span<const Aabb> planes = std::span(boxes).first(4),
                              rockets = std::span(boxes).subspan(4);
  const std::vector<Pair> all = pairs(std::span<const Aabb>(boxes));
  PairStatistics report;
  const std::uint64_t n = count_pairs(planes, rockets, {.statistics = &report});
  CHECK(all.size() == 7);
  CHECK(n == 1);
  CHECK(report.n_pairs == 1);
}
