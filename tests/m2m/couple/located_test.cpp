// What a search says of each target point, against all pairs in one thread: status, distance,
// donor, value, and the worst places; on every decomposition and schedule.
#include "m2m/count_nan.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/rows/interpolate/donor.hpp"
#include "m2m/rows/interpolate/nearest_point.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>

using namespace tess;
using namespace tess::m2m;

namespace {

struct LocatedCase {
  TetMesh source, target;
  std::vector<double> values;  // at the vertices of the source
  TransferOptions options;
};

struct Located {
  std::vector<Status> status{};
  std::vector<double> distance{}, values{};
  std::vector<WorstPlace> worst{};

  friend bool operator==(const Located& a, const Located& b) {
    // Bits, so that NaN equals NaN.
    const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
      return x.size() == y.size() &&
             std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
    };
    return a.status == b.status && same(a.distance, b.distance) && same(a.values, b.values) &&
           a.worst == b.worst;
  }
};

constexpr double kept = -7;  // what the target has before the transfer

/// All pairs of a point and a tetrahedron.
Located by_force(const LocatedCase& c) {
  Located out;
  for (std::size_t v = 0; v < c.target.n_points(); ++v) {
    const Point& p = c.target.points[v];
    Candidate best;
    Donor donor;
    for (std::size_t t = 0; t < c.source.n_tets(); ++t) {
      const auto corners = corners_of(c.source.points, c.source.tets[t]);
      const auto id = static_cast<GlobalId>(t);
      Candidate candidate;
      Weights weights{};
      if (const auto location = locate(p, corners)) {
        candidate = candidate_of(*location, id);
        weights = location->weights;
      } else if (const NearestPoint near = nearest_point(p, corners);
                 c.options.tolerance > 0 && near.distance <= c.options.tolerance) {
        candidate = {near.distance, id, Status::snapped};
        weights = near.weights;
      }
      if (!better(candidate, best)) continue;
      best = candidate;
      donor = {c.source.tets[t], weights};
    }
    double value = kept, distance = best.distance;
    if (best.status == Status::outside) {
      std::size_t nearest = 0;
      for (std::size_t s = 1; s < c.source.n_points(); ++s)
        if (squared_distance(p, c.source.points[s]) < squared_distance(p, c.source.points[nearest]))
          nearest = s;
      distance = std::sqrt(squared_distance(p, c.source.points[nearest]));
      if (std::holds_alternative<Nearest>(c.options.policy)) value = c.values[nearest];
    } else {
      value = interpolated(donor.weights, donor.vertices, c.values.data(), 1);
      if (c.options.clamp) {
        double low = INFINITY, high = -INFINITY;
        for (const VertexId corner : donor.vertices) {
          low = std::min(low, c.values[static_cast<std::size_t>(corner)]);
          high = std::max(high, c.values[static_cast<std::size_t>(corner)]);
        }
        value = std::min(std::max(value, low), high);
      }
    }
    out.status.push_back(best.status);
    out.distance.push_back(distance);
    out.values.push_back(value);
    if (best.status >= Status::snapped)
      out.worst.push_back({static_cast<GlobalId>(v), p, distance, best.status});
  }
  std::sort(out.worst.begin(), out.worst.end(), [](const WorstPlace& a, const WorstPlace& b) {
    return std::tuple(-a.distance, a.point) < std::tuple(-b.distance, b.point);
  });
  out.worst.resize(std::min(out.worst.size(), std::size_t{5}));
  return out;
}

Task transfer_case(const LocatedCase& c, std::int32_t n_parts, Located& out) {
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(c.source, {{"f", 1, c.values}}, n_parts, PartitionMethod::rcb);
    target = scatter(c.target, {{"f", 1, std::vector<double>(c.target.n_points(), kept)}},
                     n_parts % 5 + 1, PartitionMethod::hsfc);
  });
  const TransferSummary summary = co_await transfer(source, target, c.options);
  const Outcome all = co_await test::gathered(target);
  REQUIRE(all.points.size() == c.target.n_points());
  out = {all.status, all.distance, all.values, {}};
  out.worst.assign(summary.search.worst.list().begin(), summary.search.worst.list().end());
}

void check_on_schedules(const LocatedCase& c, std::uint64_t n_seeds = 12) {
  const Located want = by_force(c);
  test::for_seeds(1, test::n_seeds(n_seeds) + 1, [&](std::uint64_t seed) {
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
    const auto n_parts = static_cast<std::int32_t>(1 + seed * 5 % 13);
    INFO(n_parts << " parts");
    Located got;
    machine.run([&] { return transfer_case(c, n_parts, got); }).require_success();
    const bool same_status = got.status == want.status, same_worst = got.worst == want.worst;
    REQUIRE(same_status);
    REQUIRE(same_worst);
    const bool same = got == want;
    REQUIRE(same);
  });
}

/// The target reaches a quarter of the source's width beyond it, on all sides.
LocatedCase overhanging(double scale = 1, double offset = 0) {
  LocatedCase c{test::moved_by(read_mesh("kuhn:4@0.2"), scale, offset),
                test::moved_by(read_mesh("kuhn:7@0.1"), 1.5 * scale, offset - 0.25 * scale),
                {},
                {}};
  c.values = sample(c.source, "f", make_formula("gaussian", bounds(c.source))).values;
  return c;
}

std::size_t count(const Located& located, Status status) {
  return static_cast<std::size_t>(std::count(located.status.begin(), located.status.end(), status));
}

}  // namespace

TEST_CASE("points outside have the distance from the nearest vertex, under every policy",
          "[m2m][located]") {
  LocatedCase c = overhanging();
  CHECK(count(by_force(c), Status::outside) > 100);
  check_on_schedules(c);
  c.options.policy = Nearest{};
  check_on_schedules(c);
}

TEST_CASE("points within the tolerance snap to the nearest tetrahedron, with its nearest value",
          "[m2m][located]") {
  for (const double tolerance : {0.01, 0.1, 0.3, 10.0}) {
    INFO("tolerance " << tolerance);
    LocatedCase c = overhanging();
    c.options.tolerance = tolerance;
    const Located want = by_force(c);
    CHECK((count(want, Status::snapped) > 30 || tolerance == 0.01));
    CHECK((count(want, Status::outside) == 0) == (tolerance > 1));
    check_on_schedules(c, 6);
  }
}

TEST_CASE("a tolerance is a length: it scales with the mesh, far from the origin too",
          "[m2m][located]") {
  const std::size_t n_snapped = [] {
    LocatedCase c = overhanging();
    c.options.tolerance = 0.1;
    return count(by_force(c), Status::snapped);
  }();
  for (const auto& [scale, offset] : {std::pair{0x1p-30, 0.0}, std::pair{1.0, 0x1p30}}) {
    INFO("scale " << scale << ", offset " << offset);
    LocatedCase c = overhanging(scale, offset);
    c.options.tolerance = 0.1 * scale;
    CHECK(count(by_force(c), Status::snapped) == n_snapped);
    check_on_schedules(c, 4);
  }
}

TEST_CASE("a point exactly at the tolerance snaps, one beyond does not", "[m2m][located]") {
  LocatedCase c{read_mesh("kuhn:2"), {}, {}, {}};
  c.target.name = "points";
  c.target.points = {{0.5, 0.5, 1.25}, {0.5, 0.5, 1.2500001}, {1.5, 0.5, 0.25}, {0.3, 0.4, 0.6}};
  c.target.tets = {{0, 1, 2, 3}};
  c.values = sample(c.source, "f", make_formula("linear", bounds(c.source))).values;
  c.options.tolerance = 0.25;
  const Located want = by_force(c);
  CHECK(want.status ==
        std::vector{Status::snapped, Status::outside, Status::outside, Status::inside});
  CHECK(want.values[0] == c.values[static_cast<std::size_t>(
                              NearestVertex(c.source.points).find({0.5, 0.5, 1}).vertex)]);
  CHECK(want.worst.front().point == 2);
  check_on_schedules(c, 4);
}

TEST_CASE("values stay within those of the donor on request, also where they would extrapolate",
          "[m2m][located]") {
  // Points 1e-11 beyond a face snap within rounding; a step of 1e30 makes their values leave it.
  LocatedCase c{read_mesh("kuhn:3"), read_mesh("kuhn:5"), {}, {}};
  for (Point& p : c.target.points)
    if (p[2] == 1) p[2] += 1e-11;
  for (const Point& p : c.source.points) c.values.push_back(p[2] == 1 ? 0 : 1e30);
  const auto least = [](const Located& located) {
    return *std::min_element(located.values.begin(), located.values.end());
  };
  CHECK(least(by_force(c)) < -1e18);
  check_on_schedules(c, 3);
  c.options.clamp = true;
  const Located want = by_force(c);
  CHECK(count(want, Status::snapped) == 36);
  CHECK(least(want) == 0);
  check_on_schedules(c, 6);
}

TEST_CASE("NaN passes through, and is counted", "[m2m][located]") {
  LocatedCase c = overhanging();
  c.options.tolerance = 0.1;
  c.values[60] = std::numeric_limits<double>::quiet_NaN();
  for (const bool clamp : {false, true}) {
    c.options.clamp = clamp;
    Located got;
    REQUIRE(tests::run("pes=4", [&] { return transfer_case(c, 5, got); }).exit_code == 0);
    const Located want = by_force(c);
    CHECK(count_nan_rows(want.values) > 0);
    CHECK(count_nan_rows(got.values) == count_nan_rows(want.values));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(count_nan_rows(std::vector{1.0, nan, nan, nan, 2.0, 3.0}, 2) == 2);
}

TEST_CASE("a tolerance that is no length is refused", "[m2m][located]") {
  for (const double tolerance : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    LocatedCase c = overhanging();
    c.options.tolerance = tolerance;
    Located got;
    CHECK(tests::run("pes=4", [&] { return transfer_case(c, 2, got); }).exit_code == 2);
  }
}
