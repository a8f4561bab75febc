// Chares that get their parts from the library, and whose values are member vectors.
#include "m2m/mesh_piece.hpp"

#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "runtime/testing.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>

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
    for (const Point& p : mesh.points) field.push_back(field_at(p));
  }
  void forget() { field.assign(field.size(), -100); }
  std::span<const double> give() const { return field; }
  std::span<double> take() { return by_accessor; }
  void make_room() { by_accessor.assign(field.size(), -100); }
  void count(Callback<Counts> counts) {
    std::uint64_t n_wrong = 0;
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      n_wrong += !(std::abs(field[v] - field_at(mesh.points[v])) < 1e-13) ||
                         (!by_accessor.empty() && by_accessor[v] != field[v])
                     ? 1U
                     : 0U;
    contribute(
        AddAll{},
        Counts{n_loaded, mesh.tets.size(), mesh.points.size() - std::size_t(mesh.n_owned), n_wrong},
        std::move(counts));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, field, by_accessor, n_loaded);
  }
  std::vector<double> field, by_accessor;
  std::uint64_t n_loaded = 0;
};

/// A field goes there and back. What comes back goes over ghosts that took it on the way.
Task there_and_back(Counts& there_found, Counts& back_found) {
  ArrayProxy<Patch> large, small;
  co_await epoch([&] {
    large = create_pieces<Patch>(kuhn_mesh({3}), 3);
    small = create_pieces<Patch>(kuhn_mesh({4}), 4, PartitionMethod::rcb);
  });
  Coupling there(large, small), back(small, large);
  co_await there.search();
  co_await back.search();
  co_await epoch([&] {
    small.broadcast<&Patch::forget>();
    small.broadcast<&Patch::make_room>();
  });
  co_await there.apply<&Patch::field, &Patch::field>();
  co_await there.apply<&Patch::give, &Patch::take>();
  co_await epoch([&] { large.broadcast<&Patch::forget>(); });
  co_await back.apply<&Patch::field, &Patch::field>();
  Future<Counts> there_counts, back_counts;
  small.broadcast<&Patch::count>(there_counts.callback());
  there_found = co_await there_counts;
  large.broadcast<&Patch::count>(back_counts.callback());
  back_found = co_await back_counts;
}

}  // namespace

TEST_CASE("pieces that the library creates take a field in their ghosts and give it back",
          "[m2m]") {
  test::for_seeds(1, 21, [](std::uint64_t seed) {
    Counts there{}, back{};
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    machine.run([&]() -> Task { return there_and_back(there, back); }).require_success();
    REQUIRE(there[0] == 4);
    REQUIRE(there[1] == 6 * 64);
    REQUIRE(there[2] > 0);
    REQUIRE(there[3] == 0);
    REQUIRE(back[0] == 3);
    REQUIRE(back[1] == 6 * 27);
    REQUIRE(back[3] == 0);
  });
}
