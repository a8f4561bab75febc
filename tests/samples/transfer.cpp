// The samples of m2m/transfer.hpp, compiled and run. tests/samples/check.py compares the text.
#include "m2m/transfer.hpp"

#include "m2m/read_mesh.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

using namespace tess;
using namespace tess::m2m;

namespace {

/// A mesh with the field x + 2y, and one with zeros.
struct Scene {
  TetMesh mesh_a = read_mesh("kuhn:4@0.2"), mesh_b = read_mesh("kuhn:5");
  Formula formula = make_formula("x + 2*y", bounds(mesh_a));
  Field field = sample(mesh_a, "f", formula);
  Field other{"f", 1, std::vector<double>(mesh_b.n_points())};
};

double largest_error(const Scene& scene, const Outcome& all) {
  double worst = 0;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const Point& p = scene.mesh_b.points[static_cast<std::size_t>(all.points[i])];
    worst = std::max(worst, std::abs(all.values[i] - scene.formula(p)));
  }
  return worst;
}

Task one_transfer(const Scene& scene, double& error, TransferSummary& result) {
  const auto& [mesh_a, mesh_b, formula, field, other] = scene;
  DistributedMesh source, target;
  const auto place = [&] {
    source = scatter(mesh_a, {field}, 16, PartitionMethod::rcb);
    target = scatter(mesh_b, {other}, 16, PartitionMethod::rcb);
  };
  co_await epoch(place);

  const TransferSummary summary = co_await transfer(source, target, {.policy = Nearest{}});

  Future<Outcome> outcome;
  target.workers.broadcast<&Worker::gather>(outcome.callback());
  const Outcome all = co_await outcome;
  error = largest_error(scene, all);
  result = summary;
}

/// A search and ten applications.
Task repeated_transfer(const Scene& scene, double& error) {
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(scene.mesh_a, {scene.field}, 4, PartitionMethod::rcb);
    target = scatter(scene.mesh_b, {scene.other}, 4, PartitionMethod::rcb);
  });
  Transfer repeated(source, target, {.policy = Nearest{}});
  co_await repeated.search();
  for (int step = 0; step < 10; ++step) co_await repeated.apply();
  co_await epoch([&] { repeated.destroy(); });

  Future<Outcome> outcome;
  target.workers.broadcast<&Worker::gather>(outcome.callback());
  error = largest_error(scene, co_await outcome);
}

Task two_transfers(const Scene& scene, double& error) {
  DistributedMesh a, b, c;
  const auto place = [&] {
    a = scatter(scene.mesh_a, {scene.field}, 4, PartitionMethod::rcb);
    b = scatter(scene.mesh_b, {scene.other}, 4, PartitionMethod::rcb);
    c = scatter(scene.mesh_b, {scene.other}, 3, PartitionMethod::hsfc);
  };
  co_await epoch(place);
  auto first = transfer(a, b, {});
  auto second = transfer(a, c, {});
  co_await first;
  co_await second;
  for (const DistributedMesh& mesh : {b, c}) {
    Future<Outcome> outcome;
    mesh.workers.broadcast<&Worker::gather>(outcome.callback());
    const Outcome all = co_await outcome;
    error = std::max(error, largest_error(scene, all));
  }
}

}  // namespace

TEST_CASE("the samples of m2m/transfer.hpp move a linear field exactly", "[m2m][sample]") {
  const Scene scene;
  double error = 1;
  TransferSummary summary;
  Setup one{make_threads_machine(2), {}};
  REQUIRE(run(one, [&]() -> Task { return one_transfer(scene, error, summary); }) == 0);
  CHECK(error < 1e-14);
  CHECK(summary.search.tally.counts[static_cast<std::size_t>(Status::outside)] == 0);

  double repeated = 1;
  Setup ten{make_threads_machine(2), {}};
  REQUIRE(run(ten, [&]() -> Task { return repeated_transfer(scene, repeated); }) == 0);
  CHECK(repeated < 1e-14);

  double worst = 0;
  Setup two{make_threads_machine(2), {}};
  REQUIRE(run(two, [&]() -> Task { return two_transfers(scene, worst); }) == 0);
  CHECK(worst < 1e-14);
}
