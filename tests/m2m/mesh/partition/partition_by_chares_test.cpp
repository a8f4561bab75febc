// A program of its own, so that MPI is not initialised when the first chares partition.
#include "m2m/kuhn.hpp"
#include "m2m/mesh/partition/partition.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <thread>

using namespace tess;
using namespace tess::m2m;

namespace {

using Parts = std::vector<std::int32_t>;

struct Partitioner : Chare<Partitioner, Index1> {
  /// Waits until all PEs of the process are here, then partitions.
  void cut(Callback<std::vector<Parts>> target) {
    waiting.fetch_add(1);
    while (waiting.load() < tess::n_pes()) std::this_thread::yield();
    const TetMesh mesh = kuhn_mesh({6, 0.2});
    std::vector<Parts> parts;
    for (const PartitionMethod method : {PartitionMethod::rcb, PartitionMethod::hsfc})
      parts.push_back(partition(mesh, 7, method));
    contribute(Join{}, std::move(parts), std::move(target));
  }

  struct Join {
    std::vector<Parts> operator()(std::vector<Parts> a, const std::vector<Parts>& b) const {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    }
  };
  static inline std::atomic<std::int32_t> waiting{0};
};

Task cut_everywhere(std::vector<Parts>* out) {
  const auto chares = create<Partitioner>(range(tess::n_pes()));
  Future<std::vector<Parts>> parts;
  chares.broadcast<&Partitioner::cut>(parts.callback());
  *out = co_await parts;
}

}  // namespace

TEST_CASE("chares on all PEs of a process can partition at the same time", "[m2m][partition]") {
  std::vector<Parts> parts;
  Setup setup{make_threads_machine(4), {}};
  REQUIRE(run(setup, [&]() -> Task { return cut_everywhere(&parts); }) == 0);
  const TetMesh mesh = kuhn_mesh({6, 0.2});
  REQUIRE(parts.size() == 8);
  for (std::size_t i = 0; i < parts.size(); ++i)
    CHECK(parts[i] ==
          partition(mesh, 7, i % 2 == 0 ? PartitionMethod::rcb : PartitionMethod::hsfc));
}
