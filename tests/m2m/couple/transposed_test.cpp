// Transposed couplings: against the transposed matrix of weights, and what they keep of forces.
#include "m2m/coupling_weights.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/surface.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

using Vectors = std::vector<Point>;

/// Of the points of a body: where they are, what they give, and what they took.
using Shown = std::vector<std::pair<GlobalId, std::array<Point, 3>>>;

/// A piece of a body, whose points have displacements and forces.
class Body : public Chare<Body, Index1>, public Piece<Body> {
 public:
  void load(const MeshPart& part, bool owns_ghosts) {
    mesh_ = part;
    owns_ghosts_ = owns_ghosts;
    given_.assign(mesh_.points.size(), Point{});
    taken_.assign(n_owned(), Point{1e9, 1e9, 1e9});
    velocity_.assign(n_owned(), Point{});
  }
  [[nodiscard]] MeshView mesh_view() const {
    MeshView view = view_of(mesh_);
    view.n_owned = static_cast<std::int64_t>(n_owned());
    return view;
  }
  [[nodiscard]] std::span<const double> given() const {
    return {given_.empty() ? nullptr : given_[0].data(), 3 * given_.size()};
  }
  [[nodiscard]] std::span<double> taken() {
    return {taken_.empty() ? nullptr : taken_[0].data(), 3 * taken_.size()};
  }
  /// Gives numbers of all sizes, by id.
  void make_forces() {
    for (std::size_t v = 0; v < given_.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k)
        given_[v][k] = std::sin(static_cast<double>(3 * mesh_.point_ids[v]) + double(k)) *
                       std::pow(10.0, double(mesh_.point_ids[v] % 7));
  }
  void move(double way) {
    for (Point& p : mesh_.points) p[0] += way;
  }
  /// A spring at each point pulls it back from the displacement that it took.
  void pull(int step) {
    make_forces();
    for (std::size_t v = 0; v < taken_.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k)
        given_[v][k] = 1e-3 * std::cos(step) * given_[v][k] - 5 * taken_[v][k];
  }
  /// Moves by the forces that it took, and reports the displacements to the holders of ghosts.
  void accelerate() {
    for (std::size_t v = 0; v < taken_.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k)
        given_[v][k] += 0.01 * (velocity_[v][k] += 0.01 * taken_[v][k]);
    for (const Ghosts& ghosts : mesh_.ghosts) {
      Vectors values;
      for (const std::int32_t v : ghosts.here) values.push_back(given_[std::size_t(v)]);
      array()[{ghosts.part}].send<&Body::take_ghosts>(ghosts.there, std::move(values));
    }
  }
  void take_ghosts(const std::vector<std::int32_t>& points, const Vectors& values) {
    for (std::size_t k = 0; k < points.size(); ++k) given_[std::size_t(points[k])] = values[k];
  }
  void show(Callback<Shown> target) {
    Shown shown;
    for (std::size_t v = 0; v < n_owned(); ++v)
      shown.push_back({mesh_.point_ids[v], {mesh_.points[v], given_[v], taken_[v]}});
    contribute(concatenate, std::move(shown), std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh_, owns_ghosts_, given_, taken_, velocity_);
  }

 private:
  [[nodiscard]] std::size_t n_owned() const {
    return owns_ghosts_ ? mesh_.points.size() : static_cast<std::size_t>(mesh_.n_owned);
  }
  MeshPart mesh_;
  bool owns_ghosts_ = false;
  Vectors given_;     // per point
  Vectors taken_;     // per point owned
  Vectors velocity_;  // per point owned
};

/// With kind projection both bodies are walls.
struct ForceCase {
  TransferKind kind = TransferKind::linear;
  OutsidePolicy policy{};
  double offset = -0.1;  // of the structure, which is 1.2 wide, before the wall
  std::int32_t n_structures = 1, n_walls = 1;
  LostForces lost = LostForces::refuse;
  bool walls_own_ghosts = false, structures_own_ghosts = false;

  [[nodiscard]] TetMesh structure() const {
    if (kind == TransferKind::native)
      return test::moved_by(test::shaken(test::element_mesh(ElementType::hex8, 3), 0.05), 1.2,
                            offset);
    return part(test::moved_by(read_mesh("kuhn:3@0.2"), 1.2, offset));
  }
  [[nodiscard]] TetMesh wall() const { return part(read_mesh("kuhn:4@0.1")); }

 private:
  [[nodiscard]] TetMesh part(TetMesh mesh) const {
    return kind == TransferKind::projection ? skin_of(mesh).mesh : mesh;
  }
};

ArrayProxy<Body> bodies(const TetMesh& mesh, std::int32_t n, bool owns_ghosts) {
  const auto array = create<Body>(range(n));
  const auto parts = mesh_parts(mesh, n, PartitionMethod::curve, 2);
  for (std::int32_t k = 0; k < n; ++k)
    array[{k}].send<&Body::load>(parts[static_cast<std::size_t>(k)], owns_ghosts);
  return array;
}
TaskOf<Shown> shown(ArrayProxy<Body> body) {
  Shown all = co_await body.reduce<&Body::show>();
  std::sort(all.begin(), all.end());
  co_return all;
}

struct Forces {
  Shown structure{}, wall{};
  WeightMatrix weights{};
  Tally tally{};
  std::uint64_t n_outside = 0;
};

/// The largest difference between the sums, over both bodies, of forces and of their moments about
/// a point, as a part of the sum of magnitudes.
double imbalance(const Shown& taken, const Shown& given) {
  std::array<long double, 6> sum{};
  long double magnitude = 0;
  const auto add = [&](const Shown& body, std::size_t which, int sign) {
    for (const auto& [id, row] : body) {
      const Point arm = difference(row[0], {0.3, -0.2, 2}), moment = cross(arm, row[which]);
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += sign * row[which][k];
        sum[3 + k] += sign * moment[k];
        magnitude += std::abs(row[which][k]);
      }
    }
  };
  add(given, 1, 1);
  add(taken, 2, -1);
  double worst = 0;
  for (const long double s : sum) worst = std::max(worst, double(std::abs(s) / magnitude));
  return worst;
}

Task exchange(const ForceCase& c, std::vector<Forces>& out) {
  ArrayProxy<Body> structure, wall;
  co_await epoch([&] {
    structure = bodies(c.structure(), c.n_structures, c.structures_own_ghosts);
    wall = bodies(c.wall(), c.n_walls, c.walls_own_ghosts);
  });
  Coupling forth(structure, wall, {.policy = c.policy, .kind = c.kind});
  const SearchSummary found = co_await forth.search();
  Coupling back = forth.transposed(c.lost);
  for (int search = 0; search < 2; ++search) {
    Forces result;
    result.tally = (co_await back.search()).tally;
    result.n_outside = found.tally.count(Status::outside);
    co_await epoch([&] { wall.broadcast<&Body::make_forces>(); });
    co_await back.apply<&Body::given, &Body::taken>();
    result.structure = co_await shown(structure);
    result.wall = co_await shown(wall);
    const auto n_s = std::ssize(result.structure), n_w = std::ssize(result.wall);
    result.weights = co_await collect_weights(forth, n_s, n_w);
    out.push_back(std::move(result));
    if (search == 1) break;
    co_await epoch([&] { wall.broadcast<&Body::move>(0.01); });
    co_await forth.search();
  }
  co_await epoch([&] {
    back.destroy();
    forth.destroy();
  });
}

Task round_trips(double& worst_sum) {
  const ForceCase c{.n_structures = 3, .n_walls = 4};
  ArrayProxy<Body> structure, wall;
  co_await epoch([&] {
    structure = bodies(c.structure(), c.n_structures, false);
    wall = bodies(c.wall(), c.n_walls, false);
  });
  Coupling displacements(structure, wall, {.policy = Nearest{}});
  co_await displacements.search();
  Coupling forces = displacements.transposed();  // from the wall to the structure
  co_await forces.search();                      // no geometry: the donors are those found above
  for (int step = 0; step < 100; ++step) {
    co_await displacements.apply<&Body::given, &Body::taken>();
    co_await epoch([&] { wall.broadcast<&Body::pull>(step); });
    co_await forces.apply<&Body::given, &Body::taken>();
    co_await epoch([&] { structure.broadcast<&Body::accelerate>(); });
    const Shown of_structure = co_await shown(structure), of_wall = co_await shown(wall);
    worst_sum = std::max(worst_sum, imbalance(of_structure, of_wall));
  }
}

std::vector<Forces> forces(const ForceCase& c, std::uint64_t seed) {
  std::vector<Forces> out;
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  machine.run([&] { return exchange(c, out); }).require_success();
  return out;
}
std::string refusal(const ForceCase& c) {
  std::vector<Forces> out;
  const test::Machine machine{.pes = 2, .seed = 3};
  return machine.run([&] { return exchange(c, out); }).failure();
}

/// By the matrix, in one loop.
Vectors by_matrix(const Forces& of) {
  Vectors sums(of.structure.size(), Point{});
  const Rows<double>& rows = of.weights.rows;
  for (std::size_t t = 0; t < rows.n_rows(); ++t)
    for (std::uint64_t k = rows.begin[t]; k < rows.begin[t + 1]; ++k)
      for (std::size_t c = 0; c < 3 && rows.weights[k] != 0; ++c)
        sums[static_cast<std::size_t>(rows.columns[k])][c] +=
            rows.weights[k] * of.wall[t].second[1][c];
  return sums;
}
Vectors forces_on(const Shown& shown) {
  Vectors out;
  for (const auto& [id, row] : shown) out.push_back(row[2]);
  return out;
}

}  // namespace

TEST_CASE("a transposed coupling gives the bits of the transposed matrix", "[m2m][transposed]") {
  for (const ForceCase& given :
       {ForceCase{}, ForceCase{.policy = Nearest{}, .offset = 0.1},
        ForceCase{.kind = TransferKind::nearest}, ForceCase{.kind = TransferKind::projection},
        ForceCase{.kind = TransferKind::second_order}, ForceCase{.kind = TransferKind::native}}) {
    INFO(name_of(given.kind) << " offset " << given.offset);
    const std::vector<Forces> one = forces(given, 0);
    test::for_seeds(1, 1 + test::n_seeds(8), [&](std::uint64_t seed) {
      ForceCase c = given;
      c.n_structures = 1 + static_cast<std::int32_t>(seed % 5);
      c.n_walls = 1 + static_cast<std::int32_t>(seed % 7);
      const std::vector<Forces> all = forces(c, seed);
      for (std::size_t k = 0; k < 2; ++k) {
        test::expect(forces_on(all[k].structure) == by_matrix(all[k]), "not the transposed matrix");
        test::expect(forces_on(all[k].structure) == forces_on(one[k].structure), "other bits");
        test::expect(all[k].tally.counts == one[k].tally.counts && all[k].tally.n_lost == 0,
                     "other counts");
      }
    });
  }
}

TEST_CASE("sums of forces and moments stay over 100 round trips", "[m2m][transposed]") {
  double worst_sum = 0;
  const test::Machine machine{.pes = 3, .seed = 7};
  machine.run([&] { return round_trips(worst_sum); }).require_success();
  CHECK(worst_sum < 1e-12);
  CHECK(worst_sum > 0);
}

TEST_CASE("forces at the feet of a projection keep sums and, but for the gap, moments",
          "[m2m][transposed]") {
  const Forces of =
      forces({.kind = TransferKind::projection, .n_structures = 3, .n_walls = 4}, 2).front();
  const Rows<double>& rows = of.weights.rows;
  Shown at_feet = of.wall;
  double widest = 0;
  for (std::size_t t = 0; t < at_feet.size(); ++t) {
    Point foot{};
    for (std::uint64_t k = rows.begin[t]; k < rows.begin[t + 1]; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        foot[axis] += rows.weights[k] *
                      of.structure[static_cast<std::size_t>(rows.columns[k])].second[0][axis];
    Point& at = at_feet[t].second[0];
    widest = std::max(widest, collide::length(difference(foot, at)));
    at = foot;
  }
  CHECK(widest > 0.05);
  CHECK(of.tally.n_lost == 0);
  CHECK(imbalance(of.structure, at_feet) < 1e-13);
  CHECK(imbalance(of.structure, of.wall) > 1e-4);  // moments
}

TEST_CASE("forces of points without a donor are refused, or counted", "[m2m][transposed]") {
  ForceCase c{.offset = 0.1, .n_structures = 2, .n_walls = 3};
  CHECK_THAT(refusal(c), Contains("points that give forces have no donor, and their forces would "
                                  "be lost: couple forth with policy Nearest{}"));
  c.lost = LostForces::allow;
  const Forces allowed = forces(c, 5).front();
  CHECK(allowed.n_outside > 0);
  CHECK(allowed.tally.n_lost == allowed.n_outside);
  CHECK(forces_on(allowed.structure) == by_matrix(allowed));
  // No piece gives forces to structures that the wall does not touch.
  const Forces apart =
      forces({.offset = 5, .n_structures = 2, .lost = LostForces::allow}, 6).front();
  CHECK(apart.tally.count(Status::outside) == apart.structure.size());
  CHECK(forces_on(apart.structure) == Vectors(apart.structure.size(), Point{}));
}

TEST_CASE("couplings that cannot be transposed are refused", "[m2m][transposed]") {
  CHECK_THAT(refusal({.n_walls = 3, .walls_own_ghosts = true}),
             Contains("would count twice, since two pieces own the point"));
  CHECK_THAT(refusal({.n_structures = 3, .structures_own_ghosts = true}),
             Contains("is owned by two pieces"));
  for (const TransferKind kind : {TransferKind::limited, TransferKind::conservative})
    CHECK_THAT(refusal({.kind = kind}), Contains(std::string(name_of(kind)) + " has no weights"));
}
