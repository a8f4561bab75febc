// Chares that get their parts from the library, and whose values are member vectors.
#include "m2m/mesh_piece.hpp"

#include "collide/collider.hpp"
#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <map>

using namespace tess;
using namespace tess::m2m;

namespace {

double field_at(const Point& p) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2];
}

using Counts = std::array<std::uint64_t, 4>;  // calls of loaded(), tetrahedra, ghosts, wrong values

struct AddAll {
  Counts operator()(Counts a, const Counts& b) const {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
  }
};

struct Patch : Chare<Patch>, MeshPiece<Patch> {
  void loaded() {
    ++n_loaded;
    for (const Point& p : mesh.points) {
      field.push_back(field_at(p));
      opposite.push_back(-field_at(p));
    }
  }
  void forget() { field.assign(field.size(), -100); }
  std::span<const double> give() const { return opposite; }
  std::span<double> take() { return by_accessor; }
  void make_room() { by_accessor.assign(field.size(), -100); }
  void count(Callback<Counts> counts) {
    std::uint64_t n_wrong = 0;
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      n_wrong += !(std::abs(field[v] - field_at(mesh.points[v])) < 1e-13) ||
                         (!by_accessor.empty() && by_accessor[v] != -field[v])
                     ? 1U
                     : 0U;
    contribute(
        AddAll{},
        Counts{n_loaded, mesh.tets.size(), mesh.points.size() - std::size_t(mesh.n_owned), n_wrong},
        std::move(counts));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, field, opposite, by_accessor, n_loaded);
  }
  std::vector<double> field, opposite, by_accessor;
  std::uint64_t n_loaded = 0;
};

/// A field goes there, at once with its opposite, and back. What comes back goes over ghosts that
/// took it on the way. The second search makes the voxels again.
Task there_and_back(Counts& there_found, Counts& back_found) {
  ArrayProxy<Patch> large, small;
  co_await epoch([&] {
    large = create_pieces<Patch>(kuhn_mesh({3}), 3);
    small = create_pieces<Patch>(kuhn_mesh({4}), 4, PartitionMethod::rcb);
  });
  Coupling there(large, small), back(small, large);
  co_await there.search();
  co_await back.search();
  for (int call = 0; call < 2; ++call)  // the first one finds them used
    co_await epoch([&] { there.collider().retire(); });
  co_await there.search();
  co_await epoch([&] {
    small.broadcast<&Patch::forget>();
    small.broadcast<&Patch::make_room>();
  });
  for (int time = 0; time < 2; ++time) {
    Task one = there.apply<&Patch::field, &Patch::field>();
    Task other = there.apply<&Patch::give, &Patch::take>();
    co_await one;
    co_await other;
  }
  co_await epoch([&] { large.broadcast<&Patch::forget>(); });
  co_await back.apply<&Patch::field, &Patch::field>();
  there_found = co_await small.reduce<&Patch::count>();
  back_found = co_await large.reduce<&Patch::count>();
}

using ValueOf = std::map<GlobalId, double>;

struct JoinValues {
  ValueOf operator()(ValueOf a, const ValueOf& b) const {
    for (const auto& [point, value] : b) {
      TESS_CHECK(!a.contains(point) || a[point] == value, "two values at point ", point);
      a[point] = value;
    }
    return a;
  }
};

enum class Targets : std::uint8_t { owned, with_ghosts };

/// Its ghosts are targets or, as conservative kinds want it, not.
template <Targets targets>
struct Wave : Chare<Wave<targets>>, MeshPiece<Wave<targets>> {
  void loaded() {
    for (const Point& p : this->mesh.points) field.push_back(std::sin(3 * p[0]) * p[1] + p[2]);
    result.assign(static_cast<std::size_t>(mesh_view().n_owned), -100);
  }
  [[nodiscard]] MeshView mesh_view() const {
    if constexpr (targets == Targets::owned)
      return view_of(this->mesh);
    else
      return MeshPiece<Wave>::mesh_view();
  }
  void values(Callback<ValueOf> target) {
    ValueOf all;
    for (std::size_t v = 0; v < result.size(); ++v) all[this->mesh.point_ids[v]] = result[v];
    this->contribute(JoinValues{}, std::move(all), std::move(target));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(this->couplings, this->mesh, field, result);
  }
  std::vector<double> field, result;
};
using Owner = Wave<Targets::owned>;
using WithGhosts = Wave<Targets::with_ghosts>;

/// One transfer of C's field by a kind, between meshes in so many pieces, with the halos of the
/// kind.
template <class C>
Task transfer_in(std::int32_t n_source, std::int32_t n_target, TransferKind kind, ValueOf& found) {
  ArrayProxy<C> source, target;
  co_await epoch([&] {
    source = create_pieces<C>(kuhn_mesh({4, 0.2}), n_source, PartitionMethod::curve,
                              source_halo_layers(kind));
    target = create_pieces<C>(kuhn_mesh({5, 0.1}), n_target, PartitionMethod::rcb,
                              target_halo_layers(kind));
  });
  Coupling coupling(source, target, {.kind = kind});
  co_await coupling.search();
  co_await coupling.template apply<&C::field, &C::result>();
  found = co_await target.template reduce<&C::values>();
}

/// The integral of the linear interpolant.
double integral(const TetMesh& mesh, const ValueOf& values) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (const VertexId v : mesh.tets[t])
      sum += std::abs(signed_volume(mesh, t)) / 4 * values.at(v);
  return sum;
}

template <class C>
void check_same_in_any_pieces(TransferKind kind, ValueOf& whole) {
  const test::Machine one{.pes = 1, .seed = 1};
  one.run([&] { return transfer_in<C>(1, 1, kind, whole); }).require_success();
  REQUIRE(whole.size() == 216);
  test::for_seeds(1, 9, [&](std::uint64_t seed) {
    ValueOf found;
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
    const auto n = static_cast<std::int32_t>(seed);
    machine.run([&] { return transfer_in<C>(1 + n % 5, 2 + n % 3, kind, found); })
        .require_success();
    REQUIRE(found == whole);
  });
}

}  // namespace

TEST_CASE("pieces in a conservative coupling keep the integral, and the same bits in any number",
          "[m2m]") {
  ValueOf whole, start;
  check_same_in_any_pieces<Owner>(TransferKind::conservative, whole);
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  for (std::size_t v = 0; v < mesh.n_points(); ++v) {
    const Point& p = mesh.points[v];
    start[static_cast<GlobalId>(v)] = std::sin(3 * p[0]) * p[1] + p[2];
  }
  CHECK(integral(kuhn_mesh({5, 0.1}), whole) == Approx(integral(mesh, start)).epsilon(1e-13));
}

TEST_CASE("pieces with halos have the same bits by kinds with gradients, in any number", "[m2m]") {
  ValueOf whole;
  for (const TransferKind kind : {TransferKind::second_order, TransferKind::limited})
    check_same_in_any_pieces<WithGhosts>(kind, whole);
}

TEST_CASE("pieces that the library creates take a field in their ghosts and give it back",
          "[m2m]") {
  test::for_seeds(1, 21, [](std::uint64_t seed) {
    Counts there{}, back{};
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    machine.run([&] { return there_and_back(there, back); }).require_success();
    REQUIRE(there[0] == 4);
    REQUIRE(there[1] == 6 * 64);
    REQUIRE(there[2] > 0);
    REQUIRE(there[3] == 0);
    REQUIRE(back[0] == 3);
    REQUIRE(back[1] == 6 * 27);
    REQUIRE(back[3] == 0);
  });
}
