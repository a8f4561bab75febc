#include "m2m/overset/blanking.hpp"

#include "m2m/kuhn.hpp"
#include "runtime/core/serialize.hpp"
#include "tests/m2m/overset/voxel_body.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <numeric>

using namespace tess;
using namespace tess::m2m;

namespace {

/// A cube of 8³ cubes, all owned, and the wall of a cube of 4³ of them in its corner at the origin.
struct Fixture {
  TetMesh mesh = kuhn_mesh({8});
  std::vector<GlobalId> point_ids, tet_ids;
  Wall wall;

  Fixture() {
    point_ids.resize(mesh.n_points());
    tet_ids.resize(mesh.n_tets());
    std::iota(point_ids.begin(), point_ids.end(), 0);
    std::iota(tet_ids.begin(), tet_ids.end(), 0);
    std::mt19937 random(1);
    const test::VoxelBody body(random, 1);
    const test::VoxelSurface surface(body, random, [](int x, int y, int z) {
      return Point{0.125 * x, 0.125 * y, 0.125 * z};
    });
    wall = Wall(surface.points, surface.triangles);
  }
  [[nodiscard]] MeshView view() const {
    return {mesh.points, mesh.tets, point_ids, tet_ids,
            static_cast<std::int64_t>(point_ids.size())};
  }
  /// With so many layers; donors as given by offer(): (status, weight at holes, weight at field).
  [[nodiscard]] Blanking cut(BlankingOptions options) const {
    Blanking blanking;
    blanking.cut(view(), {&wall, 1}, {}, options);
    return blanking;
  }
  void offer(Blanking& blanking, std::int32_t number, Status status, double hole,
             double field) const {
    take(blanking, number, hole, field);
    settle(blanking, number, status);
  }
  /// What apply() writes.
  void take(Blanking& blanking, std::int32_t number, double hole, double field) const {
    const std::span<double> offered = blanking.offered(coupling_from(number));
    for (std::size_t v = 0; v < point_ids.size(); ++v) {
      offered[2 * v] = hole;
      offered[2 * v + 1] = field;
    }
  }
  void settle(Blanking& blanking, std::int32_t number, Status status) const {
    const std::vector<Status> all(point_ids.size(), status);
    blanking.settle(view(), coupling_from(number), all, number);
  }
  /// A coupling from each mesh.
  static CouplingId coupling_from(std::int32_t number) {
    return CouplingId{static_cast<std::uint64_t>(100 - number)};
  }
};

}  // namespace

TEST_CASE("holes are the points in and on a wall, and the fringe is as deep as asked",
          "[m2m][overset]") {
  const Fixture fixture;
  for (const std::int32_t layers : {1, 2, 3}) {
    const Blanking blanking = fixture.cut({layers});
    for (std::size_t v = 0; v < fixture.mesh.n_points(); ++v) {
      // An edge of the mesh changes all coordinates by 0 or by 1 in the same direction.
      const Point& p = fixture.mesh.points[v];
      double edges = 0;
      for (const double x : p) edges = std::max(edges, 8 * x - 4);
      const Role role = edges <= 0 ? Role::hole : edges <= layers ? Role::fringe : Role::field;
      CHECK(blanking.roles()[v] == role);
      CHECK(blanking.flags()[2 * v] == (role == Role::hole ? 1 : 0));
      CHECK(blanking.flags()[2 * v + 1] == (role == Role::field ? 1 : 0));
    }
  }
}

TEST_CASE("the outer boundary is the first layer of its fringe", "[m2m][overset]") {
  const Fixture fixture;
  std::vector<std::uint8_t> on_outer;
  for (const Point& p : fixture.mesh.points) on_outer.push_back(p[0] == 1 ? 1 : 0);
  for (const std::int32_t layers : {1, 2}) {
    const std::vector<Role> roles = roles_of(fixture.view(), {}, on_outer, layers);
    for (std::size_t v = 0; v < roles.size(); ++v)
      CHECK(roles[v] ==
            (8 * (1 - fixture.mesh.points[v][0]) < layers ? Role::fringe : Role::field));
  }
}

TEST_CASE("a fringe point takes the donor of the best quality, whatever the order",
          "[m2m][overset]") {
  const Fixture fixture;
  struct Offer {
    std::int32_t number;
    Status status;
    double hole, field;
  };
  std::vector<Offer> offers{{1, Status::outside, 0, 1},
                            {2, Status::snapped, -1e-12, 1},
                            {3, Status::inside, 0, 0.5},
                            {4, Status::inside, 0, 1},
                            {5, Status::boundary, 0, 1}};
  std::vector<std::size_t> order(offers.size());
  std::iota(order.begin(), order.end(), 0);
  do {
    Blanking blanking = fixture.cut({1});
    for (const std::size_t i : order)
      fixture.offer(blanking, offers[i].number, offers[i].status, offers[i].hole, offers[i].field);
    for (std::size_t v = 0; v < fixture.mesh.n_points(); ++v) {
      const Role role = blanking.roles()[v];
      const int want = role == Role::hole ? 0 : role == Role::field ? 1 : -4;
      if (blanking.iblank()[v] != want || blanking.quality()[v] != (want == 0 ? 0 : 1)) {
        CHECK(blanking.iblank()[v] == want);
        return;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  SUCCEED();
}

TEST_CASE("flags of several meshes that are taken before any is settled keep apart",
          "[m2m][overset]") {
  const Fixture fixture;
  for (const bool ascending : {true, false}) {
    Blanking blanking = fixture.cut({1});
    fixture.take(blanking, 2, 0, 1);    // a good donor
    fixture.take(blanking, 3, 0.5, 0);  // with a corner in a hole
    blanking = from_bytes<Blanking>(to_bytes(blanking));
    for (const std::int32_t number : {ascending ? 2 : 3, ascending ? 3 : 2})
      fixture.settle(blanking, number, Status::inside);
    for (std::size_t v = 0; v < fixture.mesh.n_points(); ++v)
      if (blanking.roles()[v] == Role::fringe) REQUIRE(blanking.iblank()[v] == -2);
  }
}

TEST_CASE("a donor whose weights add up to 1 up to rounding is full, and no other is",
          "[m2m][overset]") {
  const Fixture fixture;
  for (const auto& [weight, quality] :
       {std::pair{1.0, 1.0}, {1 - 1e-12, 1.0}, {1 + 1e-12, 1.0}, {0.75, 0.75}, {0.0, 0.0}}) {
    Blanking blanking = fixture.cut({1, 0});
    fixture.offer(blanking, 2, Status::inside, 0, weight);
    const BlankingReport report = blanking.report(fixture.view());
    CHECK(report.n_fringe == 91);
    CHECK(report.n_full == (quality == 1 ? 91 : 0));
    CHECK(report.least_quality == quality);
  }
}

TEST_CASE("a fringe point without a donor is an orphan, listed with the reason", "[m2m][overset]") {
  const Fixture fixture;
  const auto reason_of = [&](const std::vector<std::array<double, 3>>& offers) {
    Blanking blanking = fixture.cut({1, 0.5});
    for (const auto& [is_outside, hole, field] : offers)
      fixture.offer(blanking, 2, is_outside != 0 ? Status::outside : Status::inside, hole, field);
    const BlankingReport report = from_bytes<Blanking>(to_bytes(blanking)).report(fixture.view());
    CHECK(report.n_hole == 125);
    CHECK(report.n_orphans == 91);  // 6³ - 5³
    CHECK(report.n_fringe == 0);
    CHECK(report.n_field == 729 - 216);
    REQUIRE(report.orphans.size() == 91);
    CHECK(std::is_sorted(report.orphans.begin(), report.orphans.end(),
                         [](const Orphan& a, const Orphan& b) { return a.point < b.point; }));
    const Orphan& first = report.orphans.front();
    CHECK(first.at == fixture.mesh.points[static_cast<std::size_t>(first.point)]);
    return std::string(name_of(first.reason));
  };
  CHECK(reason_of({}) == "outside");
  CHECK(reason_of({{1, 0, 1}}) == "outside");
  CHECK(reason_of({{0, 0.2, 0.8}}) == "hole");
  CHECK(reason_of({{0, 0, 0.4}}) == "least quality");
  CHECK(reason_of({{0, 0, 0.4}, {0, 0.2, 0.8}}) == "least quality");
  CHECK(reason_of({{0, 0.2, 0.8}, {0, 0, 0.4}}) == "least quality");
}

TEST_CASE("reports are joined in any order, and the lowest orphans are kept", "[m2m][overset]") {
  BlankingReport a, b;
  for (GlobalId id = 0; id < 900; ++id) {
    a.orphans.push_back({2 * id, {}, Orphan::Reason::outside});
    b.orphans.push_back({2 * id + 1, {}, Orphan::Reason::hole});
  }
  a.n_orphans = b.n_orphans = 900;
  a.n_field = 1, a.n_hole = 2, a.n_fringe = 3, a.n_full = 4;
  b.n_field = 10, b.n_hole = 20, b.n_fringe = 30, b.n_full = 40;
  a.least_quality = 0.25;
  const JoinBlankingReports join;
  const BlankingReport both = join(a, b);
  CHECK(both.n_orphans == 1800);
  CHECK(both.n_field == 11);
  CHECK(both.n_hole == 22);
  CHECK(both.n_fringe == 33);
  CHECK(both.n_full == 44);
  CHECK(both.least_quality == 0.25);
  REQUIRE(both.orphans.size() == BlankingReport::most_listed);
  CHECK(both.orphans.back().point == 999);
  CHECK(join(b, a).orphans == both.orphans);
}
