// Pairs of shapes by the serial face: the exact test behind the boxes.
#include "collide/pairs.hpp"
#include "collide/swept.hpp"
#include "collide/tetrahedron.hpp"
#include "tests/collide/shapes/oracle.hpp"
#include "tests/support/catch.hpp"

#include <limits>
#include <set>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

/// A shape of whole numbers within a cube of `size` at a random place.
template <class Shape>
Shape some_shape(SmallPoints& random) {
  const Point at = random.point(10);
  const auto corner = [&] {
    Point p = random.point(4);
    for (std::size_t k = 0; k < 3; ++k) p[k] += at[k];
    return p;
  };
  if constexpr (std::is_same_v<Shape, Triangle>) return {{corner(), corner(), corner()}};
  if constexpr (std::is_same_v<Shape, Tetrahedron>)
    return {{corner(), corner(), corner(), corner()}};
  if constexpr (std::is_same_v<Shape, Segment>) return {corner(), corner()};
  if constexpr (std::is_same_v<Shape, Sphere>) return {at, double(random.below(3))};
  if constexpr (std::is_same_v<Shape, Swept<>>)
    return {merged(box_of(corner()), box_of(corner())), merged(box_of(corner()), box_of(corner()))};
  if constexpr (std::is_same_v<Shape, TriangleOf<float>>) {
    TriangleOf<float> t{};
    for (auto& c : t.corners) {
      const Point p = corner();
      for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<float>(p[k]);
    }
    return t;
  }
}

}  // namespace

TEMPLATE_TEST_CASE("pairs() of shapes are those that intersect, each once", "[collide][shapes]",
                   Triangle, TriangleOf<float>, Tetrahedron, Segment, Sphere, Swept<>) {
  SmallPoints random(1);
  std::vector<TestType> shapes;
  for (int i = 0; i < 150; ++i) shapes.push_back(some_shape<TestType>(random));
  for (const Touching touching : both) {
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> expected, found;
    for (std::uint32_t i = 0; i < shapes.size(); ++i)
      for (std::uint32_t j = i + 1; j < shapes.size(); ++j)
        if (intersect(shapes[i], shapes[j], touching)) expected.insert({i, j});
    for (const Pair& p : pairs(std::span<const TestType>(shapes), {.touching = touching}))
      found.insert({p.first, p.second});
    CHECK(found == expected);
    // Two segments are never more than touching.
    const bool is_segment = std::is_same_v<TestType, Segment>;
    CHECK(expected.empty() == (is_segment && touching == Touching::does_not_count));
  }
}

TEST_CASE("pairs() refuses a shape with a coordinate that is not finite, wherever it stands",
          "[collide][shapes]") {
  SmallPoints random(2);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL})
    for (std::size_t corner = 0; corner < 4; ++corner)
      for (std::size_t k = 0; k < 3; ++k) {
        std::vector<Triangle> triangles(5, some_shape<Triangle>(random));
        if (corner < 3) {
          triangles[3].corners[corner][k] = bad;
          CHECK_THROWS_WITH(pairs(std::span<const Triangle>(triangles)), Contains("3"));
        }
        std::vector<Tetrahedron> tetrahedra(9, some_shape<Tetrahedron>(random));
        tetrahedra[8].corners[corner][k] = bad;
        CHECK_THROWS_WITH(pairs(std::span<const Tetrahedron>(tetrahedra)), Contains("8"));
        std::vector<Swept<>> swept(9, some_shape<Swept<>>(random));
        Aabb& box = corner % 2 == 0 ? swept[6].start : swept[6].end;
        (corner < 2 ? box.lo : box.hi)[k] = bad;
        CHECK_THROWS_WITH(pairs(std::span<const Swept<>>(swept)), Contains("6"));
      }
}
