// Compares the pairs of the serial face with overlap() of all pairs.
#include "collide/pairs.hpp"

#include "collide/sphere.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace tess::collide;

namespace {

/// The same numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  std::uint64_t below(std::uint64_t n) { return bits_() % n; }

 private:
  std::mt19937_64 bits_;
};

/// What a random scene looks like.
struct Look {
  std::size_t n;
  double offset = 0, scale = 1;
  double decades = 0;       ///< sizes are log-uniform over so many
  double largest = 0.3;     ///< of the width of the scene
  bool on_lattice = false;  ///< faces touch, boxes are equal
  std::uint32_t n_models = 3;
};

template <class Real, std::size_t D>
struct Scene {
  std::vector<Box<Real, D>> boxes;
  std::vector<std::uint32_t> models;
};

template <class Real, std::size_t D>
Scene<Real, D> random_scene(std::uint64_t seed, const Look& look) {
  Random random(seed);
  Scene<Real, D> scene;
  for (std::size_t i = 0; i < look.n; ++i) {
    Box<Real, D> box;
    const double size = look.largest * std::pow(10, -look.decades * random.uniform());
    for (std::size_t k = 0; k < D; ++k) {
      double x = random.uniform() - 0.5, w = i % 7 == 0 ? 0 : size * random.uniform();
      if (look.on_lattice) {
        x = std::round(8 * x) / 8;
        w = std::round(4 * w) / 8;
      }
      box.lo[k] = static_cast<Real>(look.offset + look.scale * x);
      box.hi[k] = std::max(box.lo[k], static_cast<Real>(look.offset + look.scale * (x + w)));
    }
    scene.boxes.push_back(i % 11 == 10 ? scene.boxes[i / 2] : box);
    scene.models.push_back(static_cast<std::uint32_t>(random.below(look.n_models)));
  }
  return scene;
}

template <class Real, std::size_t D>
std::vector<Pair> expected(const Scene<Real, D>& scene, const PairOptions& options) {
  std::vector<Pair> out;
  for (std::uint32_t i = 0; i < scene.boxes.size(); ++i)
    for (std::uint32_t j = i + 1; j < scene.boxes.size(); ++j)
      if ((options.models.empty() || options.within_model == WithinModel::test ||
           scene.models[i] != scene.models[j]) &&
          overlap(scene.boxes[i], scene.boxes[j], options.touching))
        out.push_back({i, j});
  return out;
}

/// The first third against the rest.
template <class Real, std::size_t D>
std::vector<Pair> expected_of_sets(std::span<const Box<Real, D>> a, std::span<const Box<Real, D>> b,
                                   Touching touching) {
  std::vector<Pair> out;
  for (std::uint32_t i = 0; i < a.size(); ++i)
    for (std::uint32_t j = 0; j < b.size(); ++j)
      if (overlap(a[i], b[j], touching)) out.push_back({i, j});
  return out;
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <class Real, std::size_t D>
void check(const Scene<Real, D>& scene, std::initializer_list<double> sizes) {
  const std::span<const Box<Real, D>> boxes(scene.boxes);
  for (const auto touching : {Touching::counts, Touching::does_not_count})
    for (const auto method :
         {PairMethod::automatic, PairMethod::all_pairs, PairMethod::sweep, PairMethod::bisection})
      for (const double size : sizes) {
        CAPTURE(static_cast<int>(touching), static_cast<int>(method), size, D, sizeof(Real));
        PairStatistics statistics;
        PairOptions options{touching, {}, WithinModel::test, size, method, &statistics};
        const std::vector<Pair> found = sorted(pairs(boxes, options));
        REQUIRE((found == expected(scene, options)));
        REQUIRE(statistics.n_pairs == found.size());
        options.models = scene.models;
        options.within_model = WithinModel::skip;
        REQUIRE((sorted(pairs(boxes, options)) == expected(scene, options)));
        options.within_model = WithinModel::test;
        REQUIRE(count_pairs(boxes, options) == found.size());
        const auto a = boxes.first(boxes.size() / 3), b = boxes.subspan(boxes.size() / 3);
        REQUIRE((sorted(pairs(a, b, options)) == expected_of_sets(a, b, touching)));
      }
}

/// Spheres as a user's type, in a box that is larger than need be.
struct Ball {
  Point centre;
  double radius;
};
Aabb box_of(const Ball& ball) {
  Aabb box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = ball.centre[k] - 1.01 * ball.radius;
    box.hi[k] = ball.centre[k] + 1.01 * ball.radius;
  }
  return box;
}
bool intersect(const Ball& a, const Ball& b, Touching /*touching*/) {
  double d2 = 0;
  for (std::size_t k = 0; k < 3; ++k) d2 += std::pow(a.centre[k] - b.centre[k], 2);
  return d2 <= std::pow(a.radius + b.radius, 2);
}

}  // namespace

TEST_CASE("every pair is found once, for any type, method, size of voxels and rule", "[pairs]") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    const Look look{.n = 60 + 150 * (seed % 3), .on_lattice = seed % 2 == 1};
    check(random_scene<double, 3>(seed, look), {0, 0.05, 0.1, 0.3, 1, 0.25});
    check(random_scene<float, 3>(seed, look), {0, 0.1});
    check(random_scene<double, 2>(seed, look), {0, 0.1});
    check(random_scene<float, 4>(seed, look), {0, 0.3});
  }
}

TEST_CASE("offsets, scales and sizes over six decades lose no pair", "[pairs]") {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    check(random_scene<double, 3>(seed, {.n = 300, .offset = 1e12, .scale = 1e3}), {0, 100});
    check(random_scene<double, 3>(seed, {.n = 300, .offset = -1e12, .scale = 1e-3}), {0});
    check(random_scene<double, 3>(seed, {.n = 300, .scale = 1e9}), {0, 1e8});
    check(random_scene<double, 3>(seed, {.n = 300, .scale = 1e-9}), {0, 1e-10});
    check(random_scene<double, 3>(seed, {.n = 300, .scale = 1e300}), {0});
    check(random_scene<double, 3>(seed, {.n = 300, .scale = 1e-300}), {0});
    check(random_scene<double, 3>(seed, {.n = 700, .decades = 6, .largest = 1}), {0});
    check(random_scene<float, 3>(seed, {.n = 700, .decades = 6, .largest = 1}), {0});
    check(random_scene<double, 3>(seed, {.n = 700, .n_models = 2}), {0});
  }
}

TEST_CASE("few large objects among many small ones: two levels, the pairs of brute force",
          "[pairs]") {
  auto scene = random_scene<double, 3>(5, {.n = 20000, .largest = 0.004});
  const auto large = random_scene<double, 3>(6, {.n = 60, .largest = 1.8});
  for (const int at : {1000, 15000})
    scene.boxes.insert(scene.boxes.begin() + at, large.boxes.begin(), large.boxes.end());
  scene.models.resize(scene.boxes.size());
  PairStatistics statistics;
  PairOptions options;
  options.statistics = &statistics;
  const std::span<const Aabb> boxes(scene.boxes);
  REQUIRE((sorted(pairs(boxes, options)) == expected(scene, options)));
  REQUIRE(statistics.grid.n_levels > 1);
  REQUIRE(statistics.grid.n_entries < 8 * scene.boxes.size());
  const auto a = boxes.first(10000), b = boxes.subspan(10000);
  REQUIRE((sorted(pairs(a, b, options)) == expected_of_sets(a, b, Touching::counts)));
  REQUIRE(statistics.grid.n_levels > 2);
}

TEST_CASE("clusters: a voxel with too many objects is divided again", "[pairs]") {
  auto scene = random_scene<double, 3>(7, {.n = 4000, .scale = 1e-6});
  scene.boxes.push_back({{1e6, 1e6, 1e6}, {1e6, 1e6, 1e6}});
  scene.models.push_back(0);
  PairStatistics statistics;
  PairOptions options;
  options.statistics = &statistics;
  const std::span<const Aabb> boxes(scene.boxes);
  REQUIRE((sorted(pairs(boxes, options)) == expected(scene, options)));
  REQUIRE(statistics.grid.voxel_size < 1e-6);
}

TEST_CASE("objects that reach over the parts of a divided voxel make each pair once", "[pairs]") {
  // Dense clusters far from each other, some of them over a face of a voxel.
  Scene<double, 3> scene;
  Random random(8);
  for (int cluster = 0; cluster < 6; ++cluster) {
    const Point centre{random.uniform(), random.uniform(), cluster / 6.0};
    for (int i = 0; i < 1500; ++i) {
      Aabb box;
      for (std::size_t k = 0; k < 3; ++k) {
        box.lo[k] = centre[k] + 0.004 * random.uniform();
        box.hi[k] = box.lo[k] + 0.0005 * random.uniform();
      }
      scene.boxes.push_back(box);
    }
  }
  scene.models.resize(scene.boxes.size());
  const std::span<const Aabb> boxes(scene.boxes);
  PairStatistics statistics;
  PairOptions options;
  options.statistics = &statistics;
  for (const auto method : {PairMethod::automatic, PairMethod::bisection}) {
    options.method = method;
    REQUIRE((sorted(pairs(boxes, options)) == expected(scene, options)));
  }
  const auto a = boxes.first(2500), b = boxes.subspan(2500);
  REQUIRE((sorted(pairs(a, b, options)) == expected_of_sets(a, b, Touching::counts)));
}

TEST_CASE("sheets that lie on the rounded borders of divided voxels lose no pair of two sets",
          "[pairs]") {
  // Voxels have edges of 1 / per_unit if the width is divided into a power of two.
  for (const double per_unit : {10.0, 20.0, 49.0})
    for (const int doublings : {3, 4, 5, 6})
      for (const double sheet : {3.0, 6.0, 7.0, per_unit}) {
        Random random(static_cast<std::uint64_t>(sheet));
        const double width = std::ldexp(1.0, doublings) / per_unit;
        std::vector<Box<double, 2>> boxes(6000);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
          const bool in_sheet = i % 32 != 0;
          const double x = width * (in_sheet ? 0.1 : 1.0) * random.uniform();
          const double y = in_sheet ? sheet / per_unit : random.uniform();
          boxes[i] = {{x, y}, {std::min(x + 1e-4, width), y}};
        }
        boxes.front() = {{0, 0}, {0, 0}};
        boxes[1] = {{width, 1}, {width, 1}};
        const std::span<const Box<double, 2>> all(boxes), a = all.first(3000),
                                                          b = all.subspan(3000);
        const auto wanted = expected_of_sets(a, b, Touching::counts);
        for (const double size : {0.0, 0.01 / per_unit})
          for (const auto method : {PairMethod::automatic, PairMethod::bisection}) {
            CAPTURE(per_unit, doublings, sheet, size, static_cast<int>(method));
            PairOptions options;
            options.method = method;
            options.voxel_size = size;
            REQUIRE((sorted(pairs(a, b, options)) == wanted));
            REQUIRE(count_pairs(b, a, options) == wanted.size());
          }
      }
}

TEST_CASE("a grid of touching cubes has the pairs that a count gives", "[pairs]") {
  // Boxes [i/10, i/10 + 3/20] per axis: 93 556 pairs, of which another library loses 15 %.
  std::vector<Aabb> boxes;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      for (int z = 0; z < 20; ++z) {
        const Point lo{0.1 * x, 0.1 * y, 0.1 * z};
        boxes.push_back({lo, {lo[0] + 0.15, lo[1] + 0.15, lo[2] + 0.15}});
      }
  for (const double size : {0.0, 0.3, 0.1, 0.05})
    REQUIRE(count_pairs(std::span<const Aabb>(boxes), {.voxel_size = size}) == 93556);
}

TEST_CASE("a user's type is searched by its box and its exact test", "[pairs]") {
  Random random(3);
  std::vector<Ball> balls;
  for (int i = 0; i < 4000; ++i)
    balls.push_back(
        {{random.uniform(), random.uniform(), random.uniform()}, 0.1 * random.uniform()});
  std::vector<Pair> by_hand;
  for (std::uint32_t i = 0; i < balls.size(); ++i)
    for (std::uint32_t j = i + 1; j < balls.size(); ++j)
      if (intersect(balls[i], balls[j], Touching::counts)) by_hand.push_back({i, j});
  PairStatistics statistics;
  REQUIRE((sorted(pairs(std::span<const Ball>(balls), {.statistics = &statistics})) == by_hand));
  REQUIRE(statistics.n_pairs == by_hand.size());
  REQUIRE(statistics.n_candidates > statistics.n_pairs);
}

TEST_CASE("a filter is asked once per pair of boxes that overlap, in the order of the pair",
          "[pairs]") {
  const auto scene = random_scene<double, 3>(8, {.n = 1000});
  const std::span<const Aabb> boxes(scene.boxes), a = boxes.first(300), b = boxes.subspan(300);
  std::uint64_t n_asked = 0;
  const auto wanted = [&](std::uint32_t i, std::uint32_t j) {
    ++n_asked;
    return (i + 2 * j) % 3 == 0;
  };
  const auto filtered = [&](std::vector<Pair> all) {
    std::erase_if(all, [](const Pair& pair) { return (pair.first + 2 * pair.second) % 3 != 0; });
    return sorted(all);
  };
  PairStatistics statistics;
  const auto all = pairs(boxes), across = pairs(a, b);
  REQUIRE((sorted(pairs(boxes, {.statistics = &statistics}, wanted)) == filtered(all)));
  REQUIRE(n_asked == all.size());
  REQUIRE(statistics.n_candidates == all.size());
  REQUIRE(statistics.n_pairs == filtered(all).size());
  REQUIRE((sorted(pairs(a, b, {}, wanted)) == filtered(across)));
  REQUIRE(count_pairs(a, b, {}, wanted) == filtered(across).size());
}

TEST_CASE("one model alone is left out; identical boxes make n^2 pairs in bounded memory",
          "[pairs]") {
  const std::vector<Aabb> boxes(3000, Aabb{{1, 2, 3}, {4, 5, 6}});
  const std::vector<std::uint32_t> models(3000, 9);
  PairStatistics statistics;
  PairOptions options{
      .models = models, .within_model = WithinModel::skip, .statistics = &statistics};
  REQUIRE(count_pairs(std::span(boxes), options) == 0);
  REQUIRE(statistics.grid.n_left_out == 3000);
  options.within_model = WithinModel::test;
  REQUIRE(count_pairs(std::span(boxes), options) == 3000U * 2999 / 2);
  REQUIRE(statistics.bytes < 200 * boxes.size());
}

TEST_CASE("a search counts the voxels and the objects in them", "[pairs]") {
  // Along x the voxels 0, 3 and 6 have two boxes each, and the last box is in voxel 7, too.
  std::vector<Aabb> boxes;
  for (const double x : {0.0, 0.5, 3.25, 3.5, 6.25, 6.5})
    boxes.push_back({{x, 0, 0}, {x + 0.25, 1, 1}});
  boxes.back().hi[0] = 8;
  const std::vector<std::uint32_t> models{0, 1, 0, 0, 0, 1};
  PairStatistics statistics;
  PairOptions options{.models = models,
                      .within_model = WithinModel::skip,
                      .voxel_size = 1,
                      .statistics = &statistics};
  (void)count_pairs(std::span<const Aabb>(boxes), options);
  CHECK(statistics.grid.voxel_size == 1);
  CHECK(statistics.grid.n_levels == 1);
  CHECK(statistics.grid.n_voxels == 2);
  CHECK(statistics.grid.n_entries == 7);
  CHECK(statistics.grid.n_left_out == 3);  // two of one model, and one alone
  options.within_model = WithinModel::test;
  (void)count_pairs(std::span<const Aabb>(boxes), options);
  CHECK(statistics.grid.n_voxels == 3);
  CHECK(statistics.grid.n_entries == 7);
  CHECK(statistics.grid.n_left_out == 1);
}

TEST_CASE("empty sets and single objects have no pairs", "[pairs]") {
  const std::vector<Aabb> none, one{{{0, 0, 0}, {1, 1, 1}}};
  REQUIRE(pairs(std::span(none)).empty());
  REQUIRE(pairs(std::span(one)).empty());
  REQUIRE(pairs(std::span(none), std::span(one)).empty());
  REQUIRE(pairs(std::span(one), std::span(one)).size() == 1);
  // Statistics are those of the last search, also of an empty one.
  PairStatistics statistics;
  REQUIRE(count_pairs(std::span(one), std::span(one), {.statistics = &statistics}) == 1);
  REQUIRE(statistics.n_candidates == 1);
  REQUIRE(count_pairs(std::span(one), std::span(none), {.statistics = &statistics}) == 0);
  REQUIRE(statistics.n_candidates == 0);
}

TEST_CASE("a bad box, voxel size or list of models is an error that names it", "[pairs]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::size_t n_found = 0;
  const auto refused = [&](const Aabb& bad, std::size_t at, const PairOptions& options) {
    std::vector<Aabb> boxes(50, Aabb{{0, 0, 0}, {1, 1, 1}});
    boxes[at] = bad;
    return tess::test::message_of([&] {
      for_each_pair(std::span<const Aabb>(boxes), options, [&](auto, auto) { ++n_found; });
    });
  };
  for (const std::size_t at : {std::size_t{0}, std::size_t{17}, std::size_t{49}}) {
    const std::string name = "of object " + std::to_string(at) + " is not valid";
    for (const double bad : {nan, inf, -inf, 2.0})
      REQUIRE_THAT(refused({{bad, 0, 0}, {1, 1, 1}}, at, {}), Contains(name));
    REQUIRE_THAT(refused({{0, 0, 0}, {1, 1, nan}}, at, {}), Contains(name));
  }
  for (const double radius : {-1.0, nan}) {
    const std::vector<Sphere> balls{{{0, 0, 0}, 1}, {{0, 0, 0}, radius}};
    REQUIRE_THROWS_WITH(pairs(std::span<const Sphere>(balls)),
                        Contains("of object 1 is not valid") &&
                            Contains("(of a ball: a radius that is not negative)"));
  }
  REQUIRE_THAT(refused({{1, 0, 0}, {0, 1, 1}}, 0, {}), Catch::EndsWith("with lo <= hi"));
  const Aabb good{{0, 0, 0}, {1, 1, 1}};
  REQUIRE_THAT(refused(good, 0, {.voxel_size = 1e-6}), Contains("voxel size 1e-06 puts"));
  for (const double bad : {-0.5, nan, inf, -inf})
    REQUIRE_THAT(refused(good, 0, {.voxel_size = bad}), Contains("is no size"));
  const std::vector<std::uint32_t> models(49);
  REQUIRE_THAT(refused(good, 0, {.models = models, .within_model = WithinModel::skip}),
               Contains("49 models for 50 objects"));
  const std::vector<Aabb> both(49, good);
  const std::span<const Aabb> set(both);
  REQUIRE_THROWS_WITH(for_each_pair(set, set, {.models = models, .within_model = WithinModel::skip},
                                    [&](auto, auto) { ++n_found; }),
                      Contains("49 models for a search across two sets"));
  REQUIRE(n_found == 0);
}
