// Compares the transfer through chares with the transfer in one thread: both give the same bits on
// every machine and schedule.
#include "m2m/read_mesh.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/non_conforming.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/m2m/serial_transfer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <array>
#include <cstring>

using namespace tess;
using namespace tess::m2m;
using tess::test::SerialReport, tess::test::transfer_serial;

namespace {

struct Case {
  TetMesh source, target;
  std::vector<Field> source_fields, target_fields;
  OutsidePolicy policy;
  std::int32_t n_parts = 4;
  Point voxel{};
  TransferKind kind = TransferKind::linear;
};

Case make_case(TetMesh source, TetMesh target, OutsidePolicy policy) {
  Case c{std::move(source), std::move(target), {}, {}, policy, 4, {}, {}};
  const Aabb domain = bounds(c.source);
  for (const char* name : {"gaussian", "linear"}) {
    const Formula formula = make_formula(name, domain);
    c.source_fields.push_back(sample(c.source, name, formula));
    c.target_fields.push_back({name, 1, std::vector<double>(c.target.n_points(), -7.0)});
  }
  return c;
}

struct Result {
  std::vector<Status> status;
  std::vector<std::vector<double>> values;  // per field
};

Result serial(const Case& c) {
  std::vector<Field> fields = c.target_fields;
  const SerialReport report =
      transfer_serial(c.source, c.source_fields, c.target, fields, c.policy);
  Result result{report.status, {}};
  for (const Field& field : fields) result.values.push_back(field.values);
  if (c.kind != TransferKind::nearest) return result;
  for (std::size_t v = 0; v < c.target.n_points(); ++v) {
    if (std::holds_alternative<UseValue>(c.policy) && result.status[v] == Status::outside) continue;
    std::size_t nearest = 0;  // the first of several
    for (std::size_t s = 1; s < c.source.n_points(); ++s)
      if (squared_distance(c.target.points[v], c.source.points[s]) <
          squared_distance(c.target.points[v], c.source.points[nearest]))
        nearest = s;
    for (std::size_t f = 0; f < fields.size(); ++f)
      result.values[f][v] = c.source_fields[f].values[nearest];
  }
  return result;
}

Task run_case(const Case& c, Result& result) {
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(c.source, c.source_fields, c.n_parts, PartitionMethod::rcb);
    target = scatter(c.target, c.target_fields, c.n_parts + 1, PartitionMethod::hsfc);
  });
  co_await transfer(source, target, {.voxel_size = c.voxel, .policy = c.policy, .kind = c.kind});
  const Outcome all = co_await test::gathered(target);
  REQUIRE(all.points.size() == c.target.n_points());
  result.status = all.status;
  result.values.assign(2, {});
  for (std::size_t i = 0; i < all.values.size(); ++i) result.values[i % 2].push_back(all.values[i]);
}

/// `run_on_machine` runs a main function on some machine, and requires that it ends well.
void check_same(const Case& c, const Result& want, const auto& run_on_machine) {
  Result got;
  run_on_machine([&] { return run_case(c, got); });
  const bool same_status = got.status == want.status;  // so that a failure does not print the lists
  REQUIRE(same_status);
  for (std::size_t f = 0; f < 2; ++f)
    REQUIRE(std::memcmp(got.values[f].data(), want.values[f].data(),
                        want.values[f].size() * sizeof(double)) == 0);
}

/// A third of the mesh's box, or as small as cells of 32 bits allow.
double a_voxel(const TetMesh& mesh) {
  const Aabb box = bounds(mesh);
  double longest = 0, farthest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    longest = std::max(longest, box.hi[axis] - box.lo[axis]);
    farthest = std::max({farthest, -box.lo[axis], box.hi[axis]});
  }
  return std::max(longest / 3, farthest * 0x1p-29);
}

void check_on_all_machines(Case& c, std::uint64_t n_seeds) {
  const Result want = serial(c);
  test::for_seeds(1, test::n_seeds(n_seeds) + 1, [&](std::uint64_t seed) {
    const test::Machine machine{.pes = std::array{1, 2, 3, 4, 7, 8}[seed % 6], .seed = seed};
    c.n_parts = static_cast<std::int32_t>(1 + seed * 5 % 13);
    c.voxel.fill(seed % 3 == 0 ? a_voxel(c.source) : 0);
    INFO(c.n_parts << " parts");
    check_same(c, want, [&](const auto& main) { machine.run(main).require_success(); });
  });
  for (const std::int32_t pes : {1, 2, 4}) {
    INFO("threads, " << pes << " PEs");
    check_same(c, want,
               [&](const auto& main) { REQUIRE(tests::run_threads(pes, main).exit_code == 0); });
  }
}

}  // namespace

TEST_CASE("a transfer through chares gives the bits of the serial one on every schedule",
          "[m2m][parallel]") {
  const TetMesh coarse = read_mesh("kuhn:4@0.2"), fine = read_mesh("kuhn:6@0.1");
  for (const OutsidePolicy& policy :
       {OutsidePolicy{Keep{}}, OutsidePolicy{UseValue{3}}, OutsidePolicy{Nearest{}}}) {
    Case c =
        make_case(coarse, test::moved_by(fine, 1.1, -0.05), policy);  // some vertices lie outside
    check_on_all_machines(c, 60);
  }
}

TEST_CASE("nearest vertices through chares are those of the serial search, also for ties",
          "[m2m][parallel]") {
  // All vertices lie outside, then half of them. On lattices there are many ties.
  for (const auto& [scale, offset] : {std::pair{1.0, 1.25}, std::pair{2.0, -0.5}}) {
    INFO("scale " << scale << ", offset " << offset);
    Case c = make_case(read_mesh("kuhn:6"), test::moved_by(read_mesh("kuhn:8"), scale, offset),
                       Nearest{});
    check_on_all_machines(c, 40);
  }
}

TEST_CASE(
    "the kind nearest gives each point the value of the nearest vertex, or outside the given one",
    "[m2m][parallel]") {
  // A quarter of the points lie outside, and many are equally near to several vertices.
  for (const OutsidePolicy& policy : {OutsidePolicy{Keep{}}, OutsidePolicy{UseValue{3}}}) {
    Case c =
        make_case(read_mesh("kuhn:4"), test::moved_by(read_mesh("kuhn:8"), 1.25, -0.25), policy);
    c.kind = TransferKind::nearest;
    const std::vector<Status> status = serial(c).status;
    REQUIRE(std::count(status.begin(), status.end(), Status::outside) > 100);
    check_on_all_machines(c, 20);
  }
}

TEST_CASE("a mesh transferred onto itself through chares returns its values bit for bit",
          "[m2m][parallel]") {
  for (const TetMesh& mesh : {read_mesh("kuhn:5@0.1"), test::non_conforming_mesh()}) {
    INFO(mesh.name);
    Case c = make_case(mesh, mesh, Keep{});
    check_on_all_machines(c, 20);
    Result got;
    REQUIRE(tests::run_threads(2, [&] { return run_case(c, got); }).exit_code == 0);
    for (std::size_t f = 0; f < 2; ++f) {
      const bool same_values = got.values[f] == c.source_fields[f].values;
      REQUIRE(same_values);
    }
    for (const Status status : got.status) REQUIRE(status == Status::boundary);
  }
}

TEST_CASE("offsets and scales lose no vertex through chares", "[m2m][parallel]") {
  const TetMesh coarse = read_mesh("kuhn:4@0.2"), fine = read_mesh("kuhn:5");
  for (const auto& [scale, offset] :
       {std::pair{1.0, 1e9}, std::pair{1e-9, 0.0}, std::pair{1e9, 0.0}}) {
    INFO("scale " << scale << ", offset " << offset);
    Case c = make_case(test::moved_by(coarse, scale, offset), test::moved_by(fine, scale, offset),
                       Keep{});
    check_on_all_machines(c, 6);
    for (const Status status : serial(c).status) REQUIRE(status != Status::outside);
  }
}

namespace {

void check_found_both_ways(const std::string& coarse, const std::string& fine) {
  for (const bool there : {true, false}) {
    Case c = make_case(read_mesh(there ? coarse : fine), read_mesh(there ? fine : coarse), Keep{});
    check_on_all_machines(c, 2);
    for (const Status status : serial(c).status) REQUIRE(status != Status::outside);
  }
}

}  // namespace

TEST_CASE("every vertex of two gmsh cubes is found through chares, both ways",
          "[m2m][parallel][.][meshes]") {
  check_found_both_ways(test::made_mesh("cube_0.113"), test::made_mesh("cube_0.08"));
}

TEST_CASE("a transfer from a box around a shaft to a cube gives the bits of the serial one",
          "[m2m][parallel][.][meshes]") {
  // The cube reaches into the shaft and beyond the box.
  Case c = make_case(read_mesh(test::made_mesh("shaft_coarse")),
                     read_mesh(test::made_mesh("cube_0.113")), Nearest{});
  const std::vector<Status> status = serial(c).status;
  REQUIRE(std::count(status.begin(), status.end(), Status::outside) > 100);
  check_on_all_machines(c, 4);
}

TEST_CASE("every vertex of the real meshes is found through chares, both ways",
          "[m2m][parallel][.][shared_data]") {
  check_found_both_ways(test::shared_data("nalu/3d_tet4_taylor_green_0p4.exo"),
                        test::shared_data("nalu/3d_tet4_taylor_green_0p2.exo"));
}
