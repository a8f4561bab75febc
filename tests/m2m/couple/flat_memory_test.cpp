// Transfers in a loop leave no memory behind, as the system sees it.
#include "m2m/read_mesh.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/scoped.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/resident.hpp"
#include "tests/support/run.hpp"

namespace {

using namespace tess;
using namespace tess::m2m;

struct Scene {
  TetMesh mesh_a = read_mesh("kuhn:1"), mesh_b = read_mesh("kuhn:2");
  Field field = sample(mesh_a, "f", make_formula("x + 2*y", bounds(mesh_a)));
  Field other{"f", 1, std::vector<double>(mesh_b.n_points())};
};

Task transfer_often(const Scene& scene, tess::test::Growth& growth, std::uint64_t& n_found) {
  Scoped<DistributedMesh> source, target;
  const auto place = [&] {
    source = Scoped(scatter(scene.mesh_a, {scene.field}, 2, PartitionMethod::rcb));
    target = Scoped(scatter(scene.mesh_b, {scene.other}, 2, PartitionMethod::rcb));
  };
  co_await epoch(place);
  const TransferOptions options{.policy = Nearest{}};
  for (int round = 1; round <= growth.n_rounds(); ++round) {
    const TransferSummary summary = co_await transfer(source, target, options);
    for (const Status status : {Status::inside, Status::boundary})
      n_found += summary.search.tally.counts[static_cast<std::size_t>(status)];
    growth.after(round);
  }
}

TEST_CASE("ten thousand transfers leave memory flat", "[m2m]") {
  tess::test::Growth growth(10'000);
  const Scene scene;
  std::uint64_t n_found = 0;
  REQUIRE(tests::run_threads(2, [&] { return transfer_often(scene, growth, n_found); }).exit_code ==
          0);
  CHECK(n_found == 10'000 * scene.mesh_b.n_points());
  INFO("grows by " << growth.bytes() << " bytes from round 2500 to 10000");
  REQUIRE(growth.bytes() >= 0);
  CHECK(growth.bytes() < 1 << 20);
}

}  // namespace
