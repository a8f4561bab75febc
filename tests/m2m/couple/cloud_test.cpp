// Clouds of points coupled by moving least squares: against one loop over all pairs, on every
// decomposition and schedule.
#include "m2m/coupling.hpp"
#include "m2m/rows/reconstruct/moving_least_squares.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

/// Points with one value each, of a cloud.
struct CloudValues {
  std::vector<GlobalId> ids{};
  std::vector<Point> points{};
  std::vector<double> values{};

  template <class Ar>
  void serialize(Ar& ar) {
    ar(ids, points, values);
  }
};
struct JoinClouds {
  CloudValues operator()(CloudValues a, const CloudValues& b) const {
    a.ids.insert(a.ids.end(), b.ids.begin(), b.ids.end());
    a.points.insert(a.points.end(), b.points.begin(), b.points.end());
    a.values.insert(a.values.end(), b.values.begin(), b.values.end());
    return a;
  }
};

class Cloud : public Chare<Cloud, Index1>, public Piece<Cloud> {
 public:
  void load(const CloudValues& cloud) { cloud_ = cloud; }
  [[nodiscard]] MeshView mesh_view() const {
    return {cloud_.points, {}, cloud_.ids, {}, std::ssize(cloud_.points)};
  }
  [[nodiscard]] std::span<const double> give() const { return cloud_.values; }
  [[nodiscard]] std::span<double> take() { return cloud_.values; }
  void show(Callback<CloudValues> target) {
    contribute(JoinClouds{}, CloudValues(cloud_), std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, cloud_);
  }

 private:
  CloudValues cloud_;
};

/// Every n-th point is of the same piece, so the boxes of all pieces are the same. The first
/// `n_shared` are in all of them, as if pieces owned their ghosts.
ArrayProxy<Cloud> clouds(const CloudValues& all, std::int32_t n, std::size_t n_shared = 0) {
  const auto array = create<Cloud>(range(n));
  std::vector<CloudValues> parts(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if (k != i % parts.size() && i >= n_shared) continue;
      parts[k].ids.push_back(all.ids[i]);
      parts[k].points.push_back(all.points[i]);
      parts[k].values.push_back(all.values[i]);
    }
  }
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Cloud::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

CloudValues random_cloud(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> in_cube(0, 1);
  CloudValues cloud;
  for (std::size_t i = 0; i < n; ++i) {
    cloud.ids.push_back(static_cast<GlobalId>(i));
    cloud.points.push_back({in_cube(random), in_cube(random), in_cube(random)});
    cloud.values.push_back(test::smooth(cloud.points.back()));
  }
  return cloud;
}

struct CloudCase {
  CloudValues source, target;
  CouplingOptions options{.kind = TransferKind::moving_least_squares};
  std::int32_t n_sources = 1, n_targets = 1;
  std::size_t n_shared = 0;
};
struct CloudResult {
  std::vector<double> values{}, forces{};
  Tally tally{};
};

std::vector<double> by_id(const CloudValues& cloud) {
  std::vector<double> values(cloud.values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[static_cast<std::size_t>(cloud.ids[i])] = cloud.values[i];
  return values;
}

Task couple(const CloudCase& c, CloudResult& result) {
  ArrayProxy<Cloud> source, target;
  co_await epoch([&] {
    source = clouds(c.source, c.n_sources, c.n_shared);
    target = clouds(c.target, c.n_targets);
  });
  Coupling coupling(source, target, c.options);
  result.tally = (co_await coupling.search()).tally;
  co_await coupling.apply<&Cloud::give, &Cloud::take>();
  result.values = by_id(co_await target.reduce<&Cloud::show>());
  if (!c.options.clamp) {
    // What was taken goes back as forces.
    Coupling back = coupling.transposed();
    co_await back.search();
    co_await back.apply<&Cloud::give, &Cloud::take>();
    result.forces = by_id(co_await source.reduce<&Cloud::show>());
    co_await epoch([&] { back.destroy(); });
  }
  co_await epoch([&] { coupling.destroy(); });
}
CloudResult result_of(const CloudCase& c, std::uint64_t seed) {
  CloudResult result;
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  machine.run([&] { return couple(c, result); }).require_success();
  return result;
}

/// All pairs of points, in one loop; the transposed rows likewise.
CloudResult by_force(const CloudCase& c) {
  CloudResult result;
  MovingLeastSquares fit(c.options.order);
  result.forces.assign(c.source.points.size(), 0);
  for (const Point& at : c.target.points) {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t s = 0; s < c.source.points.size(); ++s)
      order.emplace_back(squared_distance(at, c.source.points[s]), s);
    std::sort(order.begin(), order.end());
    order.resize(std::min(order.size(), MovingLeastSquares::n_neighbours(c.options.order)));
    std::vector<Point> neighbours;
    for (const auto& [squared, s] : order) neighbours.push_back(c.source.points[s]);
    (void)fit.compute(at, neighbours);
    double value = 0, low = 1e300, high = -1e300;
    for (std::size_t j = 0; j < order.size(); ++j) {
      const double of = c.source.values[order[j].second];
      value += fit.weights()[j] * of;
      low = std::min(low, of);
      high = std::max(high, of);
    }
    if (c.options.clamp) value = std::clamp(value, low, high);
    result.values.push_back(value);
    for (std::size_t j = 0; j < order.size(); ++j)
      result.forces[order[j].second] += fit.weights()[j] * value;
  }
  return result;
}

}  // namespace

TEST_CASE("coupled clouds have the bits of one loop over all pairs", "[m2m][fits]") {
  for (const std::int32_t order : {1, 2})
    for (const bool clamp : {false, true}) {
      CloudCase c{random_cloud(150, 1), random_cloud(70, 2)};
      c.options.order = order;
      c.options.clamp = clamp;
      c.source.points[7] = c.source.points[11];  // two in one place
      c.target.points[3] = {1.3, -0.2, 0.5};     // outside
      c.target.points[4] = c.source.points[7];
      c.n_shared = clamp ? 20 : 0;  // these cannot take forces
      const CloudResult want = by_force(c);
      test::for_seeds(0, test::n_seeds(8), [&](std::uint64_t seed) {
        c.n_sources = 1 + static_cast<std::int32_t>(seed % 5);
        c.n_targets = 1 + static_cast<std::int32_t>(seed % 3);
        const CloudResult got = result_of(c, seed);
        test::expect(got.values == want.values, "other values");
        test::expect(clamp || got.forces == want.forces, "other forces");
        test::expect(got.tally.count(Status::inside) == 70, "not all points have values");
      });
    }
}

TEST_CASE("forces that a cloud gives back keep their sum and their moments", "[m2m][fits]") {
  CloudCase c{random_cloud(400, 3), random_cloud(100, 4)};
  c.options.order = 2;
  c.n_sources = 3;
  c.n_targets = 2;
  const CloudResult got = result_of(c, 1);
  REQUIRE(got.tally.n_lower_order <= 1);  // linear near a corner of the cube: exact enough
  const auto moment = [](const CloudValues& cloud, const std::vector<double>& forces, int axis) {
    double sum = 0;
    for (std::size_t i = 0; i < forces.size(); ++i)
      sum += forces[i] * (axis < 0 ? 1 : cloud.points[i][static_cast<std::size_t>(axis)]);
    return sum;
  };
  for (const int axis : {-1, 0, 1, 2})
    CHECK(moment(c.source, got.forces, axis) ==
          Approx(moment(c.target, got.values, axis)).epsilon(1e-12));
}

TEST_CASE("clouds in a plane, small ones and empty ones are counted", "[m2m][fits]") {
  CloudCase c{random_cloud(60, 5), random_cloud(20, 6)};
  c.n_sources = 2;
  CHECK(result_of(c, 2).tally.n_lower_dimension == 0);
  for (Point& p : c.source.points) p[2] = 0.5;
  CHECK(result_of(c, 2).tally.n_lower_dimension == 20);
  CHECK(result_of(c, 2).tally.n_lower_order == 0);
  c.source = random_cloud(3, 5);
  c.options.order = 2;
  const Tally few = result_of(c, 2).tally;
  CHECK(few.n_lower_order + few.n_lower_dimension == 20);
  c.source = {};
  c.options.clamp = true;  // nothing to transpose
  c.options.policy = UseValue{7};
  const CloudResult none = result_of(c, 2);
  CHECK(none.tally.count(Status::outside) == 20);
  CHECK(none.values == std::vector<double>(20, 7));
}

TEST_CASE("options that moving least squares do not know are refused", "[m2m][fits]") {
  const auto with = [](auto change) {
    CouplingOptions options{.kind = TransferKind::moving_least_squares};
    change(options);
    return options;
  };
  CHECK_NOTHROW(check(with([](CouplingOptions& o) { o.order = 2; })));
  CHECK_THROWS_WITH(check(with([](CouplingOptions& o) { o.order = 3; })),
                    Contains("order 3 of moving least squares is not offered: choose 1 or 2"));
  CHECK_THROWS_WITH(check(with([](CouplingOptions& o) { o.tolerance = 1; })),
                    Contains("looks at no tetrahedron: leave out the tolerance"));
  CHECK_THROWS_WITH(check(with([](CouplingOptions& o) { o.source_values = Centring::cells; })),
                    Contains("takes values at nodes"));
}
