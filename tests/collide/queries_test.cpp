#include "collide/queries.hpp"

#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace user {

/// A shell around a ball: points inside have a distance, too.
struct Shell {
  tess::collide::Sphere ball;
};
tess::collide::Aabb box_of(const Shell& s) {
  return box_of(s.ball);
}
double distance2(const Shell& s, const tess::collide::Point& p) {
  const double off = std::sqrt(tess::collide::distance2(s.ball.centre, p)) - s.ball.radius;
  return off * off;
}
std::optional<double> hit(const Shell& s, const tess::collide::Ray& ray) {
  return hit(s.ball, ray);
}

}  // namespace user

using namespace tess::collide;

namespace {

using user::Shell;

class Random {
 public:
  explicit Random(std::uint64_t seed) : random_(seed) {}
  double number() { return unit_(random_); }
  /// Within [-1, 1]; a third of the coordinates are multiples of 1/4, so that there are equals.
  Point point() {
    Point p{};
    for (double& x : p) x = random_() % 3 == 0 ? std::round(4 * number()) / 4 : number();
    return p;
  }
  std::mt19937_64& generator() { return random_; }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{-1, 1};
};

Point sum(const Point& a, const Point& b, double scale) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

/// An object of about `size` at `at`.
template <class Object>
Object made(Random& random, const Point& at, double size) {
  const auto corner = [&] { return sum(at, random.point(), size); };
  if constexpr (std::is_same_v<Object, Point>) return at;
  if constexpr (std::is_same_v<Object, Aabb>) return merged(box_of(corner()), box_of(corner()));
  if constexpr (std::is_same_v<Object, Segment>) return {corner(), corner()};
  if constexpr (std::is_same_v<Object, Triangle>) return {{corner(), corner(), corner()}};
  if constexpr (std::is_same_v<Object, Tetrahedron>)
    return {{corner(), corner(), corner(), corner()}};
  if constexpr (std::is_same_v<Object, Sphere>) return {at, size * std::abs(random.number())};
  if constexpr (std::is_same_v<Object, Shell>) return {{at, size * std::abs(random.number())}};
}

/// Objects of sizes over four decades, among them duplicates and clusters.
template <class Object>
std::vector<Object> scene(Random& random, std::size_t n, double scale, const Point& offset) {
  std::vector<Object> out;
  for (std::size_t i = 0; i < n; ++i) {
    if (i % 10 == 9) {
      out.push_back(out[i / 2]);
      continue;
    }
    const Point at = sum(offset, random.point(), i % 4 == 0 ? 0.01 * scale : scale);
    out.push_back(made<Object>(random, at, scale * std::pow(10, -2 + 2 * random.number())));
  }
  return out;
}

template <class Object>
std::vector<Neighbour> brute_nearest(const std::vector<Object>& objects, const Point& p) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < objects.size(); ++i)
    all.push_back({static_cast<std::uint32_t>(i),
                   std::max(distance2(detail::aabb_of(objects[i]), p), distance2(objects[i], p))});
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

TEMPLATE_TEST_CASE("distances in an index are those of a loop over all objects",
                   "[collide][queries]", Point, Aabb, Segment, Triangle, Sphere, Tetrahedron,
                   Shell) {
  std::size_t n_within = 0, n_equal = 0;
  for (const auto& [scale, offset] :
       {std::pair{1.0, 0.0}, {1.0, 1e12}, {1e-9, 0.0}, {1e9, -3e9}, {1e-200, 0.0}}) {
    Random random(1);
    const Point origin{offset, -offset, offset / 2};
    const auto objects = scene<TestType>(random, 150, scale, origin);
    const Index<TestType> index{std::span<const TestType>(objects)};
    for (int q = 0; q < 12; ++q) {
      const Point p = sum(origin, random.point(), 1.5 * scale);
      const auto all = brute_nearest(objects, p);
      for (const std::size_t k : {std::size_t{1}, std::size_t{7}, objects.size() + 5}) {
        auto expected = all;
        expected.resize(std::min(k, all.size()));
        REQUIRE(index.nearest(p, k) == expected);
      }
      for (std::size_t i = 1; i < all.size(); ++i)
        n_equal += all[i].distance2 == all[i - 1].distance2 ? 1U : 0U;
      // A radius that is the distance of one of the objects, rounded: it may be just outside.
      for (const double radius : {0.0, 0.3 * scale, std::sqrt(all[20].distance2)}) {
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < objects.size(); ++i) {
          bool is_near = false;
          if constexpr (std::is_same_v<TestType, Shell>)
            is_near = distance2(objects[i], p) <= radius * radius;
          else
            is_near = intersect(Sphere{p, radius}, objects[i], Touching::counts);
          if (is_near) expected.push_back(i);
        }
        REQUIRE(index.within(p, radius) == expected);
        n_within += expected.size();
      }
    }
  }
  CHECK(n_within > 500);
  CHECK(n_equal > 50);
}

TEMPLATE_TEST_CASE("rays in an index hit what a loop over all objects hits", "[collide][queries]",
                   Aabb, Triangle, Sphere, Tetrahedron, Shell) {
  std::size_t n_hits = 0;
  for (const auto& [scale, offset] : {std::pair{1.0, 0.0}, {1.0, 1e12}, {1e-9, 0.0}, {1e9, -3e9}}) {
    Random random(2);
    const Point origin{offset, -offset, offset / 2};
    const auto objects = scene<TestType>(random, 150, scale, origin);
    const Index<TestType> index{std::span<const TestType>(objects)};
    for (int q = 0; q < 120; ++q) {
      Ray ray{sum(origin, random.point(), 1.5 * scale), {}};
      const Point target = sum(origin, random.point(), scale);
      for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = target[k] - ray.from[k];
      if (q % 3 == 0) ray.direction[static_cast<std::size_t>(q) / 3 % 3] = 0;  // along axes
      if (ray.direction == Point{}) continue;
      const detail::RayToBox to_box(ray);
      std::vector<RayHit> expected;
      for (std::uint32_t i = 0; i < objects.size(); ++i)
        if (const auto at = hit(objects[i], ray))
          expected.push_back({i, std::max(*at, to_box.entry(detail::aabb_of(objects[i])))});
      std::sort(expected.begin(), expected.end());
      REQUIRE(index.all_hits(ray) == expected);
      const auto first = index.first_hit(ray);
      REQUIRE(first.has_value() == !expected.empty());
      if (first) REQUIRE(*first == expected[0]);
      n_hits += expected.size();
    }
  }
  CHECK(n_hits > 100);
}

TEST_CASE("answers do not depend on the order of the objects", "[collide][queries]") {
  Random random(3);
  const auto triangles = scene<Triangle>(random, 300, 1, {});
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::shuffle(order.begin(), order.end(), random.generator());
  std::vector<Triangle> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(triangles[i]);
  const Index<Triangle> index{std::span<const Triangle>(triangles)};
  const Index<Triangle> other{std::span<const Triangle>(shuffled)};
  for (int q = 0; q < 50; ++q) {
    const Point p = random.point();
    const auto a = index.nearest(p, 20), b = other.nearest(p, 20);
    for (std::size_t i = 0; i < 20; ++i) REQUIRE(a[i].distance2 == b[i].distance2);
    auto found = other.within(p, 0.2);
    for (std::uint32_t& i : found) i = order[i];
    std::sort(found.begin(), found.end());
    REQUIRE(found == index.within(p, 0.2));
    const auto hit = index.first_hit({p, {1, 0.5, 0.25}}),
               same = other.first_hit({p, {1, 0.5, 0.25}});
    REQUIRE(hit.has_value() == same.has_value());
    if (hit) REQUIRE(hit->at == same->at);
  }
}

TEST_CASE("among equals the smaller position comes first", "[collide][queries]") {
  const std::vector<Aabb> same(100, Aabb{{1, 1, 1}, {2, 2, 2}});
  const Index<Aabb> index{std::span<const Aabb>(same)};
  const auto nearest = index.nearest({0, 1, 1}, 10);
  for (std::uint32_t i = 0; i < 10; ++i) REQUIRE(nearest[i] == Neighbour{i, 1});
  CHECK(index.first_hit({{0, 1.5, 1.5}, {2, 0, 0}}) == RayHit{0, 0.5});
  CHECK(index.all_hits({{0, 1.5, 1.5}, {2, 0, 0}}).size() == 100);
}

TEST_CASE("an empty index finds nothing", "[collide][queries]") {
  const Index<Triangle> index{std::span<const Triangle>()};
  CHECK(index.nearest({0, 0, 0}, 3).empty());
  CHECK(index.within({0, 0, 0}, 3).empty());
  CHECK_FALSE(index.first_hit({{0, 0, 0}, {1, 0, 0}}));
  CHECK(index.all_hits({{0, 0, 0}, {1, 0, 0}}).empty());
  const std::vector<Point> points{{1, 2, 3}};
  CHECK(Index<Point>{std::span<const Point>(points)}.nearest({0, 0, 0}, 0).empty());
}

TEST_CASE("boxes from the smallest to the largest double are found", "[collide][queries]") {
  constexpr double most = std::numeric_limits<double>::max();
  const std::vector<Aabb> boxes{{{-most, -most, -most}, {most, most, most}},
                                {{1e-320, 0, 0}, {1e-310, 0, 0}},
                                {{1e300, -1, -1}, {most, 1, 1}},
                                {{-1, -1, -1}, {1, 1, 1}}};
  const Index<Aabb> index{std::span<const Aabb>(boxes)};
  CHECK(index.within({0, 0, 0}, 1) == std::vector<std::uint32_t>{0, 1, 3});
  CHECK(index.all_hits({{-2, 0, 0}, {1, 0, 0}}).size() == 4);
  CHECK(index.all_hits({{-most, 0, 0}, {1, 0, 0}}).size() == 4);
  CHECK(index.all_hits({{0, 0, 0}, {1e-310, 0, 0}}).size() == 4);
  CHECK(index.first_hit({{most, 0, 0}, {-1, 0, 0}}) == RayHit{0, 0});
}

TEST_CASE("bad objects and queries are refused, with the position", "[collide][queries]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Triangle> triangles(5, Triangle{{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}}});
  const Index<Triangle> index{std::span<const Triangle>(triangles)};
  for (const double bad : {nan, HUGE_VAL, -HUGE_VAL}) {
    triangles[3].corners[2][1] = bad;
    REQUIRE_THROWS_WITH(Index<Triangle>{std::span<const Triangle>(triangles)},
                        Contains("object 3"));
    CHECK_THROWS_AS(index.within({0, bad, 0}, 1), tess::Error);
    CHECK_THROWS_AS(index.within({0, 0, 0}, bad), tess::Error);
    CHECK_THROWS_AS(index.nearest({bad, 0, 0}, 1), tess::Error);
    CHECK_THROWS_AS(index.first_hit({{0, 0, bad}, {1, 0, 0}}), tess::Error);
    CHECK_THROWS_AS(index.all_hits({{0, 0, 0}, {1, bad, 0}}), tess::Error);
  }
  CHECK_THROWS_AS(index.within({0, 0, 0}, -1), tess::Error);
  CHECK_THROWS_WITH(index.first_hit({{0, 0, 0}, {0, 0, 0}}), Contains("direction"));
  const std::vector<Sphere> balls{{{0, 0, 0}, 1}, {{0, 0, 0}, -1}};
  CHECK_THROWS_WITH(Index<Sphere>{std::span<const Sphere>(balls)}, Contains("object 1"));
}
