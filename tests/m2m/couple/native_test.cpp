// Kind native through chares: against one loop, for any pieces, PEs and schedules.
#include "m2m/coupling_weights.hpp"
#include "m2m/placement.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <string>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

struct NativeCase {
  TetMesh from, to;
  TransferKind kind = TransferKind::native;
  std::int32_t n_parts = 1;
  bool clamp = false;
  PartitionMethod method = PartitionMethod::curve;
};
struct NativeResult {
  std::vector<double> values{}, by_weights{};
  Tally tally{};
};

Task transfer_native(const NativeCase& c, NativeResult& result) {
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(c.from, {{"f", 1, test::sampled(c.from.points, test::smooth)}}, c.n_parts,
                     c.method, 1);
    target =
        scatter(c.to, {{"f", 1, std::vector<double>(c.to.n_points())}}, c.n_parts + 1, c.method);
  });
  Transfer transfer(source, target, {.kind = c.kind, .clamp = c.clamp});
  result.tally = (co_await transfer.search()).tally;
  co_await transfer.apply();
  result.values = (co_await test::gathered(target)).values;
  if (c.clamp) co_return;
  const WeightMatrix weights =
      co_await collect_weights(transfer, static_cast<std::int64_t>(c.from.n_points()),
                               static_cast<std::int64_t>(c.to.n_points()));
  result.by_weights.resize(c.to.n_points());
  apply(weights, test::sampled(c.from.points, test::smooth), 1, result.by_weights);
}
NativeResult native_result(const NativeCase& c, std::uint64_t seed) {
  NativeResult result;
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  machine.run([&] { return transfer_native(c, result); }).require_success();
  return result;
}
Task place_natively(const TetMesh& from, bool keeps, std::vector<double>& values) {
  const TetMesh to = read_mesh("kuhn:3");
  const std::vector<FormulaField> given{{"x*y*z", bounds(from)}}, taken{{"0", bounds(from)}};
  const PlacedMesh source = co_await place(&from, {3, 1, keeps}, given);
  const PlacedMesh target = co_await place(&to, {2}, taken);
  co_await transfer(source.mesh, target.mesh, {.kind = TransferKind::native});
  values = (co_await test::gathered(target.mesh)).values;
}

}  // namespace

TEST_CASE("kind native has the bits of one loop for any pieces and schedules", "[m2m][native]") {
  for (const ElementType type : test::native_element_types) {
    NativeCase c{
        test::shaken(test::element_mesh(type, 3), type >= ElementType::tet10 ? 0.02 : 0.06),
        read_mesh("kuhn:4@0.2")};
    std::uint64_t n_linear = 0;
    const std::vector<double> want = test::native_values(
        c.from, test::sampled(c.from.points, test::smooth), c.to.points, n_linear);
    test::for_seeds(1, 1 + test::n_seeds(8), [&](std::uint64_t seed) {
      c.n_parts = 1 + static_cast<std::int32_t>(seed % 6);
      c.method = seed % 2 == 0 ? PartitionMethod::curve : PartitionMethod::rcb;
      const NativeResult got = native_result(c, seed);
      test::expect(got.values == want, name_of(type), " gives other bits");
      test::expect(got.by_weights == want, name_of(type), " has other weights");
      test::expect(got.tally.n_linear == n_linear, got.tally.n_linear, " of ", n_linear);
    });
  }
}

TEST_CASE("kind native of tetrahedra has the bits of linear", "[m2m][native]") {
  NativeCase c{read_mesh("kuhn:3@0.2"), read_mesh("kuhn:4@0.2")};
  const NativeResult native = native_result(c, 3);
  c.kind = TransferKind::linear;
  CHECK(native.values == native_result(c, 2).values);
  CHECK(native.tally.n_linear == 0);
}

TEST_CASE("points in elements that fold over are counted, once for any pieces", "[m2m][native]") {
  NativeCase c{test::shaken(test::element_mesh(ElementType::hex8, 3), 0.3),
               read_mesh("kuhn:5@0.2")};
  const NativeResult one = native_result(c, 1);
  CHECK(one.tally.n_linear > 0);
  test::for_seeds(2, 2 + test::n_seeds(6), [&](std::uint64_t seed) {
    c.n_parts = static_cast<std::int32_t>(seed);
    const NativeResult got = native_result(c, seed);
    test::expect(got.tally.n_linear == one.tally.n_linear && got.values == one.values,
                 got.tally.n_linear, " linear");
  });
  c.clamp = true;
  const std::vector<double> values = test::sampled(c.from.points, test::smooth);
  for (const double value : native_result(c, 4).values) {
    CHECK(value >= *std::ranges::min_element(values));
    CHECK(value <= *std::ranges::max_element(values));
  }
}

TEST_CASE("kind native refuses pieces that lack their elements", "[m2m][native]") {
  const TetMesh from = test::element_mesh(ElementType::hex8, 3), to = read_mesh("kuhn:3");
  const test::Machine machine{.pes = 2, .seed = 3};
  std::vector<double> values;
  CHECK_THAT(machine.run([&] { return place_natively(from, false, values); }).failure(),
             Contains("kind native needs the elements"));
  machine.run([&] { return place_natively(from, true, values); }).require_success();
  for (std::size_t v = 0; v < values.size(); ++v) {
    const auto& [x, y, z] = to.points[v];
    CHECK(std::abs(values[v] - x * y * z) < 1e-14);
  }
}
