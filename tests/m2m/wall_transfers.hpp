// Transfers from wall to wall, on simulated machines.
#pragma once

#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/walls.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <vector>

namespace tess::test {

using namespace m2m;

inline double smooth_on_wall(const Point& p) {
  return std::sin(2 * p[0]) * std::cos(p[1]) + p[2] * p[2];
}

struct WallCase {
  TetMesh from, to;
  TransferOptions options{};
  std::int32_t n_parts = 1;
  double (*field)(const Point&) = &smooth_on_wall;
};
struct WallResult {
  Outcome outcome;
  Tally tally;
};

inline Task run_case(const WallCase& c, WallResult& result) {
  Field field{"f", 1, {}};
  for (const Point& p : c.from.points) field.values.push_back(c.field(p));
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(c.from, {field}, c.n_parts, PartitionMethod::curve);
    target = scatter(c.to, {{"f", 1, std::vector<double>(c.to.n_points(), -7.0)}}, c.n_parts + 1,
                     PartitionMethod::curve, target_halo_layers(c.options.kind));
  });
  Transfer transfer(source, target, c.options);
  for (int k = 0; k < 3; ++k)  // the third keeps what the source has found of itself
    result.tally = (co_await transfer.search()).tally;
  co_await transfer.apply();
  result.outcome = co_await gathered(target);
}
inline WallResult result_of(const WallCase& c, std::uint64_t seed = 1) {
  const Machine machine{.pes = 1 << (seed % 3), .seed = seed};
  WallResult result;
  machine.run([&] { return run_case(c, result); }).require_success();
  return result;
}

inline void check_same(const WallResult& a, const WallResult& b) {
  expect(a.outcome.values == b.outcome.values, "values");
  expect(a.outcome.status == b.outcome.status, "status");
  expect(a.outcome.distance == b.outcome.distance, "distances");
}

}  // namespace tess::test
