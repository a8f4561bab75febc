#include <m2m/kuhn.hpp>
#include <m2m/transfer.hpp>

using namespace tess;
using namespace tess::m2m;

Task move() {
  const TetMesh from = kuhn_mesh({4}), to = kuhn_mesh({5});
  const Field f = sample(from, "f", make_formula("x + y", bounds(from)));
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(from, {f}, 4, PartitionMethod::rcb);
    target = scatter(to, {{"g", 1, std::vector<double>(to.n_points())}}, 4, PartitionMethod::rcb);
  });
  const TransferSummary summary = co_await transfer(source, target, {.policy = Nearest{}});
  const auto& n = summary.search.tally.counts;
  print("inside ", n[0], ", boundary ", n[1], "\n");
}

int main(int argc, char** argv) {
  return run(argc, argv, move);
}
