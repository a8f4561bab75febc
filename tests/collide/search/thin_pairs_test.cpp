// Compares the pairs of objects in pieces of many lengths with intersect() of all pairs.
#include "collide/search/thin_pairs.hpp"

#include "collide/swept.hpp"
#include "collide/tetrahedron.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>

using namespace tess::collide;

namespace {

/// What a scene of thin triangles looks like.
struct Needles {
  std::uint32_t n;
  double length = 0.3, width = 1e-3, offset = 0, scale = 1;
  bool is_flat = false;     ///< all in one plane
  bool on_lattice = false;  ///< corners coincide, ends touch
  double degenerate = 0.1;  ///< chance of an object of one point, or one that equals another
};

std::vector<Triangle> triangles(std::uint64_t seed, const Needles& look) {
  tess::Random random(seed);
  std::vector<Triangle> out;
  const auto direction = [&](double size) {
    Point d{};
    double length = 0;
    while (!(length > 0.1 && length < 0.5)) {
      for (double& x : d) x = random.unit() - 0.5;
      length = std::hypot(d[0], d[1], d[2]);
    }
    for (double& x : d) x *= size / length;
    return d;
  };
  while (out.size() < look.n) {
    if (!out.empty() && random.chance(look.degenerate)) {
      out.push_back(out[random.below(out.size())]);
      if (random.chance(0.5)) out.back().corners.fill(out.back().corners[random.below(3)]);
      continue;
    }
    const Point along = direction(look.length * (random.chance(0.2) ? random.unit() : 1)),
                aside = direction(look.width);
    const double share = random.unit();
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = random.unit();
      std::array<double, 3> at{x, x + along[k], x + share * along[k] + aside[k]};
      for (std::size_t i = 0; i < 3; ++i) {
        if (look.on_lattice) at[i] = std::round(8 * at[i]) / 8;
        if (look.is_flat && k == 2) at[i] = 0.3;
        t.corners[i][k] = look.offset + look.scale * at[i];
      }
    }
    out.push_back(t);
  }
  return out;
}

/// A type whose capsules are made by hand.
struct OwnCapsule {
  Triangle shape;
  Capsule capsule;

  friend Aabb box_of(const OwnCapsule& object) { return box_of(object.shape); }
  friend bool intersect(const OwnCapsule& a, const OwnCapsule& b, Touching touching) {
    return intersect(a.shape, b.shape, touching);
  }
  friend Capsule capsule_of(const OwnCapsule& object) { return object.capsule; }
};

using Pairs = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

template <class A, class B>
Pairs brute_force(std::span<const A> a, std::span<const B> b, Touching touching, bool is_one_set,
                  std::span<const std::uint32_t> models = {}) {
  Pairs out;
  for (std::uint32_t i = 0; i < a.size(); ++i)
    for (std::uint32_t j = is_one_set ? i + 1 : 0; j < b.size(); ++j)
      if ((models.empty() || models[i] != models[j]) && intersect(a[i], b[j], touching))
        out[{i, j}] = 1;
  return out;
}

/// How often each pair is found that intersects. Every pair is asked for at most once, and only if
/// the boxes overlap.
template <class A, class B>
Pairs found_thin(std::span<const A> a, std::span<const B> b, double longest, bool is_one_set,
                 PairOptions options) {
  const auto boxes_a = tess::collide::detail::boxes_of(a),
             boxes_b = tess::collide::detail::boxes_of(b);
  using TheBox = typename decltype(boxes_a)::value_type;
  using Real = typename decltype(TheBox::lo)::value_type;
  const auto capsules_a = tess::collide::detail::capsules_of(a),
             capsules_b = tess::collide::detail::capsules_of(b);
  const std::array<search::ThinSet<Real>, 2> sets{{{boxes_a, capsules_a}, {boxes_b, capsules_b}}};
  Pairs asked, out;
  const auto test = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t first = is_one_set ? std::min(i, j) : i,
                        second = is_one_set ? std::max(i, j) : j;
    REQUIRE(++asked[{first, second}] == 1);
    REQUIRE(overlap(boxes_a[first], boxes_b[second], options.touching));
    return intersect(a[first], b[second], options.touching);
  };
  const auto note = [&](std::uint32_t i, std::uint32_t j) {
    ++out[is_one_set ? std::pair(std::min(i, j), std::max(i, j)) : std::pair(i, j)];
  };
  PairStatistics statistics;
  options.statistics = &statistics;
  tess::collide::detail::for_each_tested(
      options, test, note, [&](tess::collide::detail::PairSink sink) {
        search::search_thin(search::ThinSets<Real>(sets).first(is_one_set ? 1 : 2), longest,
                            options, sink);
      });
  REQUIRE(statistics.n_pairs == out.size());
  REQUIRE(statistics.n_candidates >= asked.size());
  return out;
}

template <class Object>
void check_thin(const std::vector<Object>& objects, double length) {
  const std::span<const Object> all(objects);
  const std::size_t third = objects.size() / 3;
  const auto a = all.first(third), b = all.subspan(third);
  std::vector<std::uint32_t> models;
  for (std::uint32_t i = 0; i < objects.size(); ++i) models.push_back(i * 7 / 3 % 3);
  std::vector<std::uint32_t> two_models = models;
  for (std::uint32_t& model : two_models) model = model == 2 ? 5 : 9;
  for (const auto touching : {Touching::counts, Touching::does_not_count}) {
    const Pairs of_all = brute_force(all, all, touching, true);
    const Pairs across = brute_force(a, b, touching, false),
                reverse = brute_force(b, a, touching, false);
    const Pairs of_models = brute_force(all, all, touching, true, models);
    const Pairs of_two = brute_force(all, all, touching, true, two_models);
    for (const double parts : {0.0, 0.9, 2.0, 5.0, 20.0, 1000.0}) {
      const double longest = parts == 0 ? search::ThinObjects<double>::whole : length / parts;
      CAPTURE(static_cast<int>(touching), parts);
      PairOptions options{.touching = touching};
      REQUIRE((found_thin(all, all, longest, true, options) == of_all));
      REQUIRE((found_thin(a, b, longest, false, options) == across));
      REQUIRE((found_thin(b, a, longest, false, options) == reverse));
      options.models = models;
      options.within_model = WithinModel::skip;
      REQUIRE((found_thin(all, all, longest, true, options) == of_models));
      options.models = two_models;
      REQUIRE((found_thin(all, all, longest, true, options) == of_two));
      options.within_model = WithinModel::test;
      REQUIRE((found_thin(all, all, longest, true, options) == of_all));
    }
  }
}

}  // namespace

TEST_CASE("long thin triangles in pieces of any length make each pair once", "[thin]") {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    CAPTURE(seed);
    check_thin(triangles(seed, {.n = 150}), 0.3);
    check_thin(triangles(seed, {.n = 150, .is_flat = true}), 0.3);
    check_thin(triangles(seed, {.n = 100, .length = 0.6, .on_lattice = true}), 0.6);
    check_thin(triangles(seed, {.n = 100, .length = 0.6, .is_flat = true, .on_lattice = true}),
               0.6);
    check_thin(triangles(seed, {.n = 120, .width = 0.1}), 0.3);  // capsules that are thick
    check_thin(triangles(seed, {.n = 120, .width = 0, .degenerate = 0.5}), 0.3);
  }
}

TEST_CASE("offsets and scales lose no pair of long thin triangles", "[thin]") {
  for (std::uint64_t seed = 1; seed < 3; ++seed) {
    CAPTURE(seed);
    check_thin(triangles(seed, {.n = 100, .length = 1, .offset = 1e12}), 1);
    check_thin(triangles(seed, {.n = 100, .length = 1, .offset = -1e12, .scale = 1e-3}), 1e-3);
    check_thin(triangles(seed, {.n = 100, .length = 1, .scale = 1e9}), 1e9);
    check_thin(triangles(seed, {.n = 100, .length = 1, .scale = 1e-9}), 1e-9);
    check_thin(triangles(seed, {.n = 60, .length = 1, .scale = 1e-305}), 1e-305);
    check_thin(triangles(seed, {.n = 60, .length = 1, .scale = 1e307}), 1e307);
  }
}

TEST_CASE("a capsule that is none loses no pair of its object", "[thin]") {
  std::vector<OwnCapsule> objects;
  for (const Triangle& shape : triangles(9, {.n = 150})) {
    Capsule capsule = capsule_of(shape);
    const std::size_t what = objects.size() % 8, axis = objects.size() / 8 % 3;
    if (what == 0) capsule.from[axis] = std::numeric_limits<double>::quiet_NaN();
    if (what == 1) capsule.to[axis] = std::numeric_limits<double>::quiet_NaN();
    if (what == 2) capsule.to[axis] = std::numeric_limits<double>::infinity();
    if (what == 3) capsule.radius = -0.1;
    if (what == 4) capsule.radius = std::numeric_limits<double>::quiet_NaN();
    objects.push_back({shape, capsule});
  }
  check_thin(objects, 0.3);
}

TEST_CASE("segments, tetrahedra and triangles of float in pieces make each pair once", "[thin]") {
  const std::vector<Triangle> needles = triangles(4, {.n = 120, .length = 0.5});
  std::vector<Segment> segments;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<TriangleOf<float>> floats;
  for (const Triangle& t : needles) {
    const auto& [a, b, c] = t.corners;
    segments.push_back({a, b});
    tetrahedra.push_back({{a, b, c, {c[0], c[1], c[2] + 0.01}}});
    floats.push_back({});
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        floats.back().corners[i][k] = static_cast<float>(t.corners[i][k]);
  }
  check_thin(segments, 0.5);
  check_thin(tetrahedra, 0.5);
  check_thin(floats, 0.5);
  const std::span<const Triangle> a(needles);
  const std::span<const Segment> b = std::span<const Segment>(segments).subspan(40);
  for (const double longest : {1.0, 0.1, 0.01}) {
    REQUIRE((found_thin(a, b, longest, false, {}) == brute_force(a, b, Touching::counts, false)));
    REQUIRE((found_thin(b, a, longest, false, {}) == brute_force(b, a, Touching::counts, false)));
  }
}

/// Cubes that move along the first edges of triangles.
template <class TheBox>
std::vector<Swept<TheBox>> moving_cubes(const std::vector<Triangle>& ways, double size) {
  using Real = typename decltype(TheBox::lo)::value_type;
  std::vector<Swept<TheBox>> out;
  for (const Triangle& way : ways) {
    const auto cube = [&](const Point& centre) {
      TheBox box;
      for (std::size_t k = 0; k < 3; ++k) {
        box.lo[k] = static_cast<Real>(centre[k] - size / 2);
        box.hi[k] = static_cast<Real>(centre[k] + size / 2);
      }
      return box;
    };
    out.push_back({cube(way.corners[0]), cube(way.corners[1])});
  }
  return out;
}

TEST_CASE("boxes that move far in pieces of their way make each pair once", "[thin]") {
  const std::vector<Triangle> ways = triangles(7, {.n = 150, .length = 0.5});
  for (const double size : {0.05, 0.01, 0.0}) {
    const auto cubes = moving_cubes<Aabb>(ways, size);
    const std::span<const Swept<>> all(cubes);
    REQUIRE_FALSE(brute_force(all, all, Touching::counts, true).empty());
    check_thin(cubes, 0.5);
    check_thin(moving_cubes<Box<float, 3>>(ways, size), 0.5);
  }
  // By default, too, and then capsules spare most exact tests.
  const auto cubes =
      moving_cubes<Aabb>(triangles(8, {.n = 3000, .length = 1, .degenerate = 0}), 0.002);
  const std::span<const Swept<>> all(cubes);
  std::uint64_t n_asked = 0;
  const std::uint64_t n_found = count_pairs(all, {}, [&](std::uint32_t /*i*/, std::uint32_t /*j*/) {
    ++n_asked;
    return true;
  });
  CHECK(n_found == brute_force(all, all, Touching::counts, true).size());
  const auto boxes = tess::collide::detail::boxes_of(all);
  CHECK(n_asked < count_pairs(std::span<const Aabb>(boxes)) / 20);
}

TEST_CASE("pieces are chosen for long thin objects, and spare most pairs of boxes", "[thin]") {
  const std::vector<Triangle> needles =
      triangles(5, {.n = 3000, .length = 1, .width = 1e-4, .degenerate = 0});
  const std::span<const Triangle> all(needles);
  const auto boxes = tess::collide::detail::boxes_of(all);
  PairStatistics statistics;
  std::uint64_t n_asked = 0;
  const auto wanted = [&](std::uint32_t i, std::uint32_t j) {
    REQUIRE(i < j);
    ++n_asked;
    return (i + j) % 2 == 0;
  };
  const std::uint64_t n_boxes = count_pairs(std::span<const Aabb>(boxes));
  Pairs of_all = brute_force(all, all, Touching::counts, true);
  REQUIRE(count_pairs(all, {.statistics = &statistics}) == of_all.size());
  REQUIRE(statistics.n_candidates < n_boxes * 2 / 3);
  std::erase_if(of_all,
                [](const auto& pair) { return (pair.first.first + pair.first.second) % 2 != 0; });
  REQUIRE(count_pairs(all, {}, wanted) == of_all.size());
  REQUIRE(n_asked < n_boxes / 20);
  // Across two sets.
  const auto a = all.first(1000), b = all.subspan(1000);
  REQUIRE(count_pairs(a, b, {.statistics = &statistics}) ==
          brute_force(a, b, Touching::counts, false).size());
  REQUIRE(statistics.n_candidates <
          count_pairs(std::span(boxes).first(1000), std::span(boxes).subspan(1000)) * 2 / 3);
}

TEST_CASE("capsules are not used where they do not pay", "[thin]") {
  const auto choice = [](const std::vector<Triangle>& objects) {
    const std::span<const Triangle> all(objects);
    const auto boxes = tess::collide::detail::boxes_of(all);
    const auto capsules = tess::collide::detail::capsules_of(all);
    const search::ThinSet<double> set{boxes, capsules};
    return search::choose_pieces(search::ThinSets<double>(&set, 1), {});
  };
  CHECK_FALSE(choice(triangles(1, {.n = 4000, .length = 0.3, .width = 0.2})));    // not thin
  CHECK_FALSE(choice(triangles(1, {.n = 4000, .length = 0.01, .width = 1e-5})));  // not long
  CHECK_FALSE(choice({}));
  // A row of parallel needles along an axis: the boxes are the objects.
  std::vector<Triangle> row;
  for (int i = 0; i < 400; ++i)
    row.push_back({{Point{0, 0, 0}, Point{1, 0, 0}, Point{0.5, 1e-3 * i, 0}}});
  CHECK_FALSE(choice(row));
}

TEST_CASE("a thin object that is not valid, and a list of models that is too short, are named",
          "[thin]") {
  std::vector<Triangle> needles = triangles(6, {.n = 400, .length = 0.5, .width = 1e-4});
  const std::vector<std::uint32_t> models(399);
  const std::span<const Triangle> all(needles);
  REQUIRE_THROWS_WITH(count_pairs(all, {.models = models, .within_model = WithinModel::skip}),
                      Contains("399 models for 400 objects"));
  REQUIRE_THROWS_WITH(count_pairs(all, all, {.models = models, .within_model = WithinModel::skip}),
                      Contains("across two sets"));
  needles[17].corners[1][2] = std::numeric_limits<double>::infinity();
  REQUIRE_THROWS_WITH(count_pairs(all), Contains("of object 17 is not valid"));
  REQUIRE_THROWS_WITH(count_pairs(all.first(10), all), Contains("of object 17 of the second set"));
  // The others stand if they are told to.
  const PairOptions others{.invalid_boxes = tess::collide::InvalidBoxes::leave_out};
  std::vector<Triangle> valid = needles;
  valid.erase(valid.begin() + 17);
  const std::uint64_t n = count_pairs(std::span<const Triangle>(valid));
  REQUIRE(n > 0);
  REQUIRE(count_pairs(all, others) == n);
}
