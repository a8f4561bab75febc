// Scaled transfers: integrals against the sum over all cells, and what cannot be scaled.
#include "m2m/scaled.hpp"

#include "m2m/mesh_piece.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

/// Takes values for the points that it owns only.
class Slab : public Chare<Slab>, public MeshPiece<Slab> {
 public:
  std::vector<double> field{}, taken{};

  void loaded() {
    for (const Point& p : mesh.points) {
      field.push_back(test::smooth(p));
      field.push_back(p[0] - 0.5);  // its integral over the cube is 0
    }
    taken.assign(2 * static_cast<std::size_t>(mesh.n_owned), 1);
  }
  [[nodiscard]] MeshView mesh_view() const { return view_of(mesh); }
  void shift(double by) {
    for (std::size_t i = 1; i < field.size(); i += 2) field[i] += by;
  }
  void show(Callback<std::vector<std::pair<GlobalId, double>>> target) {
    std::vector<std::pair<GlobalId, double>> values;
    for (std::size_t i = 0; i < taken.size(); ++i)
      values.emplace_back(2 * mesh.point_ids[i / 2] + static_cast<GlobalId>(i % 2), taken[i]);
    contribute(concatenate, std::move(values), std::move(target));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, field, taken);
  }
};

struct ScaledCase {
  std::int32_t n_sources = 1, n_targets = 1, halo = 1;
  double shift = 1, offset = 0;
};
struct Scaled {
  FieldIntegrals integrals{};
  std::vector<std::pair<GlobalId, double>> values{};
};

Task scale(const ScaledCase& c, Scaled& out) {
  ArrayProxy<Slab> source, target;
  co_await epoch([&] {
    source = create_pieces<Slab>(read_mesh("kuhn:4@0.2"), c.n_sources);
    target = create_pieces<Slab>(test::moved_by(read_mesh("kuhn:3"), 1, c.offset), c.n_targets,
                                 PartitionMethod::curve, c.halo);
  });
  co_await epoch([&] { source.broadcast<&Slab::shift>(c.shift); });
  Coupling coupling(source, target, {.policy = UseValue{0}});
  co_await coupling.search();
  out.integrals = co_await apply_scaled<&Slab::field, &Slab::taken>(coupling);
  out.values = co_await target.reduce<&Slab::show>();
  std::sort(out.values.begin(), out.values.end());
  co_await epoch([&] { coupling.destroy(); });
}
Scaled scaled(const ScaledCase& c, std::uint64_t seed) {
  Scaled out;
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  machine.run([&] { return scale(c, out); }).require_success();
  return out;
}
std::string refusal_to_scale(const ScaledCase& c) {
  Scaled out;
  const test::Machine machine{.pes = 2, .seed = 3};
  return machine.run([&] { return scale(c, out); }).failure();
}

/// Of a component that values give, by one loop over the cells.
double integral(const TetMesh& mesh, const std::vector<double>& values, std::size_t component) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (const VertexId v : mesh.tets[t])
      sum += std::abs(signed_volume(mesh, t)) / 4 *
             values[2 * static_cast<std::size_t>(v) + component];
  return sum;
}

}  // namespace

TEST_CASE("a scaled transfer keeps integrals, with the same bits however meshes are cut",
          "[m2m][scaled]") {
  const Scaled one = scaled({}, 0);
  const TetMesh from = read_mesh("kuhn:4@0.2"), to = read_mesh("kuhn:3");
  std::vector<double> given, taken;
  for (const Point& p : from.points) given.insert(given.end(), {test::smooth(p), p[0] + 0.5});
  for (const auto& [key, value] : one.values) taken.push_back(value);
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(one.integrals.source[c] == Approx(integral(from, given, c)).epsilon(1e-13));
    CHECK(integral(to, taken, c) == Approx(one.integrals.source[c]).epsilon(1e-13));
  }
  CHECK(std::abs(one.integrals.target[0] / one.integrals.source[0] - 1) > 1e-4);  // it had to scale
  test::for_seeds(1, 1 + test::n_seeds(6), [&](std::uint64_t seed) {
    const auto n = static_cast<std::int32_t>(seed);
    const Scaled again = scaled({.n_sources = 1 + n % 5, .n_targets = 1 + n % 4}, seed);
    test::expect(again.values == one.values, "other bits");
    test::expect(again.integrals.target == one.integrals.target, "other integrals");
  });
}

TEST_CASE("what cannot be scaled is refused", "[m2m][scaled]") {
  CHECK_THAT(refusal_to_scale({.n_targets = 3, .halo = 0}),
             Contains("around their points, of 1: show a halo of one layer"));
  CHECK_THAT(refusal_to_scale({.offset = 5}),
             Contains("component 0 of the target has the integral 0, and"));
  CHECK(refusal_to_scale({.n_targets = 3, .shift = 0}).empty());  // both integrals are 0
}
