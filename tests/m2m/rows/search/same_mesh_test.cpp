// What a search keeps of a source that has not moved.
#include "m2m/rows/search/same_mesh.hpp"

#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_piece.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <cstring>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

struct SmallMesh {
  std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  std::vector<Tet> tets{{0, 1, 2, 3}, {1, 2, 3, 4}};
  std::vector<GlobalId> point_ids{0, 1, 2, 3, 4}, tet_ids{0, 1};
  std::int64_t n_owned = 5, n_own_tets = 2;
  [[nodiscard]] MeshView view() const {
    return {points, tets, point_ids, tet_ids, n_owned, n_own_tets};
  }
};

/// What happens to a source between two searches.
enum class Change : std::uint8_t { none, shift, one_point, back, other_corners, other_ids };

double field_at(const Point& p) {
  return p[0] * p[0] - 3 * p[1] * p[2] + p[2];
}

class MovedPatch : public tess::Chare<MovedPatch>, public MeshPiece<MovedPatch> {
 public:
  void loaded() {
    at_first_ = mesh.points;
    for (const Point& p : mesh.points) field_.push_back(field_at(p));
    kept_.assign(field_.size(), -1);
    fresh_ = kept_;
  }
  void move(const Point& by) {
    for (Point& p : mesh.points)
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += by[axis];
  }
  void change(Change what, std::uint64_t seed) {
    Random random(seed);
    switch (what) {
      case Change::none:
        break;
      case Change::shift:
        return move({0.125, 0, -0.0625});
      case Change::one_point:
        mesh.points[random.below(mesh.points.size())][random.below(3)] += 0x1p-10;
        break;
      case Change::back:
        mesh.points = at_first_;
        break;
      case Change::other_corners:  // the same tetrahedra, and their weights in another order
        for (Tet& tet : mesh.tets) std::swap(tet[0], tet[1]), std::swap(tet[2], tet[3]);
        break;
      case Change::other_ids:
        for (GlobalId& id : mesh.tet_ids) id = 100'000 - id;
        for (GlobalId& id : mesh.point_ids) id = 100'000 - id;
        break;
    }
  }
  std::span<const double> give() const { return field_; }
  std::span<double> take_kept() { return kept_; }
  std::span<double> take_fresh() { return fresh_; }
  void compare(std::pair<CouplingId, CouplingId> ids, Callback<std::uint64_t> n_different) {
    std::uint64_t n = 0;
    const auto differ = [](double a, double b) { return std::memcmp(&a, &b, sizeof a) != 0; };
    for (std::size_t v = 0; v < kept_.size(); ++v)
      n += differ(kept_[v], fresh_[v]) || differ(distance(ids.first)[v], distance(ids.second)[v]) ||
                   status(ids.first)[v] != status(ids.second)[v]
               ? 1U
               : 0U;
    contribute(sum, n, std::move(n_different));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, at_first_, field_, kept_, fresh_);
  }

 private:
  std::vector<Point> at_first_;
  std::vector<double> field_, kept_, fresh_;
};

struct Searches {
  std::uint64_t n_searches = 0, n_different = 0, n_kept = 0, n_kept_wanted = 0;
};

/// A coupling that searches again and again, beside one that is made anew each time. The target
/// moves by eighths of a cube, so many of its points are on faces, edges and vertices, and some are
/// outside.
Task search_again(std::uint64_t seed, Searches& found) {
  Random random(seed);
  ArrayProxy<MovedPatch> source, target;
  const int n_parts = 1 + static_cast<int>(random.below(3));
  co_await epoch([&] {
    source = create_pieces<MovedPatch>(kuhn_mesh({4}), n_parts);
    target = create_pieces<MovedPatch>(kuhn_mesh({3}), 2);
  });
  const CouplingOptions options{
      .policy = Nearest{},
      .kind = seed % 2 == 0 ? TransferKind::linear : TransferKind::second_order,  // with kept fits
      .tolerance = random.chance(0.5) ? 0 : 0.1};
  Coupling kept(source, target, options);
  int n_since_change = 0;
  for (int k = 0; k < 8; ++k) {
    const Change what = random.chance(0.6) ? Change::none : Change(1 + random.below(5));
    const Point by{0.125 * static_cast<double>(random.below(3)) - 0.125, 0, 0.03125};
    const std::uint64_t draw = random();
    co_await epoch([&] {
      source.broadcast<&MovedPatch::change>(what, draw);
      target.broadcast<&MovedPatch::move>(by);
    });
    n_since_change = what == Change::none ? n_since_change + 1 : 1;
    const SearchSummary summary = co_await kept.search();
    Coupling fresh(source, target, options);
    co_await fresh.search();
    co_await kept.apply<&MovedPatch::give, &MovedPatch::take_kept>();
    co_await fresh.apply<&MovedPatch::give, &MovedPatch::take_fresh>();
    found.n_different +=
        co_await target.reduce<&MovedPatch::compare>(std::pair(kept.id(), fresh.id()));
    ++found.n_searches;
    found.n_kept += summary.tally.n_kept_sources;
    if (n_since_change >= 3) found.n_kept_wanted += static_cast<std::uint64_t>(n_parts);
    co_await epoch([&] { fresh.destroy(); });
  }
}

}  // namespace

TEST_CASE("a change of any one number of a mesh changes its hash", "[m2m][search]") {
  SmallMesh mesh;
  const MeshHash before = hash_of(mesh.view());
  const auto check = [&](auto& number) {
    const auto was = number;
    number += 1;
    CHECK(hash_of(mesh.view()) != before);
    number = was;
    CHECK(hash_of(mesh.view()) == before);
  };
  for (Point& p : mesh.points)
    for (double& x : p) check(x);
  for (Tet& tet : mesh.tets)
    for (VertexId& v : tet) check(v);
  for (GlobalId& id : mesh.point_ids) check(id);
  for (GlobalId& id : mesh.tet_ids) check(id);
  check(mesh.n_owned);
  check(mesh.n_own_tets);
}

TEST_CASE("a mesh is the same from the third call on that finds it as it was", "[m2m][search]") {
  using Answer = SameMesh::Answer;
  SmallMesh mesh;
  SameMesh same;
  CHECK(same.ask(mesh.view()) == Answer::moved);
  CHECK(same.ask(mesh.view()) == Answer::stayed);
  CHECK(same.ask(mesh.view()) == Answer::same);
  mesh.tets[1][2] = 0;
  CHECK(same.ask(mesh.view()) == Answer::stayed);
  CHECK(same.ask(mesh.view()) == Answer::same);
  mesh.points[0][0] = 0.5;
  CHECK(same.ask(mesh.view()) == Answer::moved);
  CHECK(same.ask(mesh.view()) == Answer::stayed);
  CHECK(same.ask(SmallMesh{.points = {}, .tets = {}, .point_ids = {}, .tet_ids = {}}.view()) ==
        Answer::moved);
}

TEST_CASE("a search that keeps what it made of its source finds what a new one finds",
          "[m2m][search]") {
  std::uint64_t n_kept = 0;
  test::for_seeds(1, 61, [&](std::uint64_t seed) {
    Searches found;
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
    machine.run([&] { return search_again(seed, found); }).require_success();
    REQUIRE(found.n_searches == 8);
    REQUIRE(found.n_different == 0);
    REQUIRE(found.n_kept >= found.n_kept_wanted);
    n_kept += found.n_kept;
  });
  REQUIRE(n_kept > 100);
  Searches found;
  REQUIRE(tests::run_threads(2, [&] { return search_again(5, found); }).exit_code == 0);
  REQUIRE(found.n_different == 0);
}
