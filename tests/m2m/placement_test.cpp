// Compares meshes that all PEs set up together with meshes that one PE cuts: every Worker has the
// same bytes.
#include "m2m/placement.hpp"

#include "m2m/io/exodus/netcdf_header.hpp"
#include "m2m/io/ranges/mesh_ranges.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh/partition/curve_cut.hpp"
#include "m2m/mesh/partition/id_set.hpp"
#include "m2m/mesh/partition/partition.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/write_exodus.hpp"
#include "m2m/write_vtu.hpp"
#include "runtime/core/hilbert.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/m2m/non_conforming.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <random>

using namespace tess;
using namespace tess::m2m;

namespace {

using Contents = std::map<std::int32_t, std::vector<std::byte>>;  // per part

struct JoinContents {
  Contents operator()(Contents a, const Contents& b) const {
    a.insert(b.begin(), b.end());
    return a;
  }
};

/// Shows the Workers of its PE.
struct Inspector : Group<Inspector> {
  void inspect(ArrayProxy<Worker> workers, std::int32_t n_parts, Callback<Contents> target) {
    Contents contents;
    for (std::int32_t k = 0; k < n_parts; ++k)
      if (const Worker* const worker = workers.local({k})) contents[k] = to_bytes(*worker);
    contribute(JoinContents{}, std::move(contents), std::move(target));
  }
};

Task inspect(DistributedMesh mesh, Contents* contents) {
  const auto inspectors = create<Inspector>(each_pe);
  *contents = co_await inspectors.reduce<&Inspector::inspect>(mesh.workers, mesh.n_parts);
}

struct Case {
  TetMesh mesh;
  std::int32_t n_parts = 1, halo_layers = 0;
  bool by_name = false;
};

Task compare(const Case& c, std::string* difference) {
  const Aabb domain = bounds(c.mesh);
  const std::vector<FormulaField> formulas{{"gaussian", domain}, {"x + 2*y", domain}};
  std::vector<Field> fields;
  for (const FormulaField& field : formulas)
    fields.push_back(sample(c.mesh, field.name, make_formula(field.name, field.domain)));
  DistributedMesh whole;
  co_await epoch(
      [&] { whole = scatter(c.mesh, fields, c.n_parts, PartitionMethod::curve, c.halo_layers); });
  PlacedMesh placed;
  if (c.by_name)
    placed =
        co_await place(c.mesh.name, {.n_parts = c.n_parts, .halo_layers = c.halo_layers}, formulas);
  else
    placed = co_await place(&c.mesh, {c.n_parts, c.halo_layers}, formulas);
  Contents want, got;
  co_await inspect(whole, &want);
  co_await inspect(placed.mesh, &got);
  const MeshCensus census = validate(c.mesh);
  if (static_cast<std::int32_t>(want.size()) != c.n_parts || got.size() != want.size())
    *difference = "number of parts";
  else if (census.bounds != placed.census.bounds || census.n_unused != placed.census.n_unused ||
           census.n_inverted != placed.census.n_inverted || placed.census.n_flat != census.n_flat)
    *difference = "census";
  for (std::int32_t k = 0; k < c.n_parts && difference->empty(); ++k)
    if (got[k] != want[k]) *difference = "part " + std::to_string(k);
}

void check_on(std::unique_ptr<Machine> machine, const RuntimeOptions& options, const Case& c) {
  Setup setup{std::move(machine), options};
  std::string difference;
  REQUIRE(run(setup, [&] { return compare(c, &difference); }) == 0);
  REQUIRE(difference.empty());
}

void check_seeds(Case c, std::uint64_t n_seeds) {
  for (std::uint64_t seed = 1; seed <= n_seeds; ++seed) {
    SimulatedOptions options;
    options.n_pes = std::array{1, 2, 3, 5, 8, 40}[seed % 6];
    options.cost = Time(100);
    options.seed = seed;
    options.migration_chance = 0;
    c.n_parts = std::array{1, 2, 7, 16, 61}[seed % 5];
    c.halo_layers = static_cast<std::int32_t>(seed % 3);
    INFO("--sim pes=" << options.n_pes << ",cost=100ns,migrate=0,seed=" << seed << ", " << c.n_parts
                      << " parts, halo " << c.halo_layers);
    RuntimeOptions runtime_options;
    runtime_options.seed = seed;
    check_on(make_simulated_machine(options), runtime_options, c);
  }
}

/// Unused vertices at both ends, and a flat tetrahedron.
TetMesh odd_mesh() {
  TetMesh mesh = kuhn_mesh({3, 0.1});
  mesh.points.push_back({7, 7, 7});
  mesh.points.insert(mesh.points.begin(), Point{8, 8, 8});
  for (Tet& tet : mesh.tets)
    for (VertexId& v : tet) ++v;
  mesh.tets[11][3] = mesh.tets[11][2];
  std::swap(mesh.tets[5][0], mesh.tets[5][1]);
  // In an order without locality.
  std::vector<Tet> shuffled(mesh.tets);
  for (std::size_t t = 0; t < shuffled.size(); ++t)
    shuffled[t] = mesh.tets[(t * 101) % mesh.tets.size()];
  mesh.tets = shuffled;
  return mesh;
}

std::string refusal(const TetMesh& mesh, std::int32_t n_pes, PlaceOptions options = {4},
                    const std::vector<FormulaField>& fields = {}) {
  return tests::error_of(text("pes=", n_pes), [&] { return place(&mesh, options, fields); });
}

}  // namespace

TEST_CASE("parts that all PEs set up together are those that one PE cuts, on every schedule",
          "[m2m][placement]") {
  for (const TetMesh& mesh : {kuhn_mesh({4, 0.2}), odd_mesh(), test::non_conforming_mesh()}) {
    INFO(mesh.name);
    check_seeds({mesh}, 30);
  }
  check_seeds({kuhn_mesh({5, 0.1}), 1, 0, true}, 12);
  for (const std::int32_t pes : {1, 2, 4}) {
    INFO("threads, " << pes << " PEs");
    check_on(make_threads_machine(pes), {}, {kuhn_mesh({6, 0.1}), 13, 2, true});
  }
}

TEST_CASE("pieces of the curve hold equally many tetrahedra, also where a mesh is much finer",
          "[m2m][placement]") {
  TetMesh graded = kuhn_mesh({12});
  for (Point& p : graded.points)
    for (double& x : p) x = x * x * x * x * x * x;
  for (const TetMesh& mesh : {kuhn_mesh({12}), graded}) {
    for (const std::int32_t n_parts : {2, 3, 8, 50}) {
      std::vector<std::size_t> sizes(static_cast<std::size_t>(n_parts));
      for (const std::int32_t part : partition(mesh, n_parts, PartitionMethod::curve))
        ++sizes.at(static_cast<std::size_t>(part));
      const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
      const double mean = static_cast<double>(mesh.n_tets()) / n_parts;
      CAPTURE(n_parts);
      CHECK(static_cast<double>(*least) > 0.93 * mean);
      CHECK(static_cast<double>(*most) < 1.07 * mean);
    }
  }
}

TEST_CASE("counts of ranges that are joined in any order are those of the whole mesh",
          "[m2m][placement]") {
  const TetMesh mesh = kuhn_mesh({9, 0.2});
  const HilbertCube cube(bounds(mesh));
  std::vector<std::uint64_t> cells;
  for (const Tet& tet : mesh.tets) {
    Point middle{};
    for (const VertexId v : tet)
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle[axis] += mesh.points[static_cast<std::size_t>(v)][axis] / 4;
    cells.push_back(cube.cell(middle));
  }
  CurveCut cut(mesh.n_tets(), 300);
  std::mt19937 random(5);
  for (int round = 0; !cut.is_done(); ++round) {
    REQUIRE(round < 8);
    const CellCounts whole = cut.counts(cells);
    std::vector<CellCounts> parts;
    for (std::size_t begin = 0; begin < cells.size();) {
      const std::size_t n = std::min<std::size_t>(1 + random() % 900, cells.size() - begin);
      parts.push_back(cut.counts(std::span(cells).subspan(begin, n)));
      begin += n;
    }
    std::shuffle(parts.begin(), parts.end(), random);
    CellCounts sum;
    for (const CellCounts& part : parts) sum = JoinCounts{}(std::move(sum), part);
    CHECK(sum.blocks == whole.blocks);
    CHECK(sum.counts == whole.counts);
    std::uint64_t n_counted = 0;
    for (const std::uint32_t n : sum.counts) n_counted += n;
    if (round == 0) CHECK(n_counted == cells.size());
    cut.refine(sum);
  }
  std::vector<std::uint64_t> sizes(300);
  for (const std::int32_t part : cut.parts(cells)) ++sizes.at(static_cast<std::size_t>(part));
  for (std::int32_t first = 0; first < 300; first += 7)
    for (std::int32_t end = first; end <= 300; end += 11)
      CHECK(cut.n_tets_of(first, end) ==
            std::accumulate(sizes.begin() + first, sizes.begin() + end, std::uint64_t{0}));
}

TEST_CASE("neighbours on the Hilbert curve share a face, and every cell is on it once",
          "[m2m][placement]") {
  constexpr int levels = 3;
  std::array<std::array<int, 3>, 512> cells{};
  std::array<bool, 512> seen{};
  const HilbertCube cube({{0, 0, 0}, {8, 8, 8}});
  for (int i = 0; i < 512; ++i) {
    const std::array<int, 3> at{i % 8, i / 8 % 8, i / 64};
    const std::uint64_t position = hilbert_position(
        cube.cell({at[0] + 0.5, at[1] + 0.5, at[2] + 0.5}) >> (3 * (hilbert_levels - levels)),
        levels);
    REQUIRE_FALSE(seen.at(position));
    seen.at(position) = true;
    cells[position] = at;
  }
  for (std::size_t i = 1; i < cells.size(); ++i) {
    int steps = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      steps += std::abs(cells[i][axis] - cells[i - 1][axis]);
    if (steps != 1) FAIL("position " << i);
  }
}

TEST_CASE("all PEs together refuse a bad mesh with the message of validate()", "[m2m][placement]") {
  const TetMesh good = kuhn_mesh({3});
  std::vector<TetMesh> bad(7, good);
  bad[0].points[50][1] = std::numeric_limits<double>::quiet_NaN();
  bad[0].points[20][2] = 1e200;
  bad[1].tets[100][2] = 64;
  bad[1].tets[90][1] = -3;
  for (Point& p : bad[2].points) p[0] = 1e15 + p[0];
  for (Point& p : bad[3].points)
    for (double& x : p) x *= 1e-85;
  for (Point& p : bad[4].points) p[2] = 0;
  bad[5].tets.clear();
  for (Point& p : bad[6].points)
    for (double& x : p) x = 1e14 + x;
  for (const TetMesh& mesh : bad) {
    const std::string want = test::message_of([&] { validate(mesh); });
    for (const std::int32_t n_pes : {1, 3, 7}) CHECK(refusal(mesh, n_pes) == want);
  }
  const std::vector<FormulaField> fields{{"x", bounds(good)}, {"1/(x - 1/3)", bounds(good)}};
  const std::string want = test::message_of(
      [&] { (void)sample(good, "1/(x - 1/3)", make_formula("1/(x - 1/3)", bounds(good))); });
  REQUIRE_FALSE(want.empty());
  for (const std::int32_t n_pes : {1, 3, 7}) CHECK(refusal(good, n_pes, {4}, fields) == want);
  CHECK_THAT(refusal(good, 2, {0}), Contains("into 0 parts"));
  CHECK_THAT(refusal(good, 2, {2, -1}), Contains("a halo of -1 layers"));
}

TEST_CASE("a set of vertices numbers them in ascending order", "[m2m][placement]") {
  IdSet set(-70, 900);
  const std::vector<VertexId> ids{-70, -7, -6, 57, 58, 121, 122, 899, 900};
  for (const VertexId v : {900, 57, -7, 122, -70, 58, -6, 121, 899, 58}) set.add(v);
  set.number();
  CHECK(set.list() == ids);
  for (std::size_t i = 0; i < ids.size(); ++i)
    CHECK(set.rank(ids[i]) == static_cast<std::int32_t>(i));
  CHECK(set.has(121));
  CHECK_FALSE(set.has(120));
  CHECK_FALSE(set.has(-71));
  CHECK_FALSE(set.has(5000));
}

TEST_CASE("ranges of kuhn meshes are those of the whole mesh", "[m2m][placement]") {
  const KuhnBox box{5, 0.2};
  const TetMesh whole = kuhn_mesh(box);
  for (const GlobalId first : {0, 1, 6, 17, 100}) {
    std::vector<Point> points(37);
    kuhn_points(box, first, points);
    CHECK(std::equal(points.begin(), points.end(), whole.points.begin() + first));
    std::vector<Tet> tets(41);
    kuhn_tets(box, first, tets);
    CHECK(std::equal(tets.begin(), tets.end(), whole.tets.begin() + first));
  }
}

namespace {

/// A binary file of version 4.1: two surfaces, then tetrahedra in two blocks, nodes in three.
std::string gmsh_bytes(const TetMesh& mesh, std::uint64_t first_tag, bool swaps_tags) {
  std::string out = "$MeshFormat\n4.1 1 8\n";
  const auto put = [&](const auto&... values) {
    (out.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  };
  put(1);
  out += "\n$EndMeshFormat\n$Nodes\n";
  const std::uint64_t n = mesh.n_points();
  put(std::uint64_t{3}, n, first_tag, first_tag + n - 1);
  for (std::uint64_t block = 0; block < 3; ++block) {
    const std::uint64_t begin = n * block / 3, end = n * (block + 1) / 3;
    put(3, 1, 0, end - begin);
    for (std::uint64_t i = begin; i < end; ++i)
      put(first_tag + (swaps_tags && i + 2 >= n ? 2 * n - 3 - i : i));
    for (std::uint64_t i = begin; i < end; ++i)
      put(mesh.points[i][0], mesh.points[i][1], mesh.points[i][2]);
  }
  out += "\n$EndNodes\n$Elements\n";
  const std::uint64_t n_tets = mesh.n_tets();
  put(std::uint64_t{4}, n_tets + 3, std::uint64_t{1}, n_tets + 3);
  for (const std::uint64_t n_triangles : {2U, 1U}) {
    put(2, 1, 2, n_triangles);
    for (std::uint64_t i = 0; i < n_triangles; ++i)
      put(n_tets + n_triangles + i, first_tag, first_tag + 1, first_tag + 2);
  }
  for (std::uint64_t block = 0; block < 2; ++block) {
    const std::uint64_t begin = n_tets * block / 2, end = n_tets * (block + 1) / 2;
    put(3, 1, 4, end - begin);
    for (std::uint64_t t = begin; t < end; ++t) {
      put(t + 1);
      for (const VertexId v : mesh.tets[t]) put(first_tag + static_cast<std::uint64_t>(v));
    }
  }
  return out + "\n$EndElements\n";
}

void check_ranges_of_file(const std::string& path, std::uint64_t n_seeds) {
  INFO(path);
  const TetMesh mesh = read_mesh(path);
  const auto ranges = open_ranges(path, RangeCheck::all);
  REQUIRE(ranges != nullptr);
  CHECK(ranges->skipped == skipped_text(mesh));
  check_seeds({mesh, 1, 0, true}, n_seeds);
  check_on(make_threads_machine(3), {}, {mesh, 7, 1, true});
}

}  // namespace

TEST_CASE("all PEs read their ranges of a binary gmsh file and of an ExodusII file",
          "[m2m][placement]") {
  const test::Scratch scratch;
  const TetMesh mesh = odd_mesh();
  for (const std::uint64_t first_tag : {1U, 100U})
    check_ranges_of_file(scratch.write("a.msh", gmsh_bytes(mesh, first_tag, false)), 6);
  write_exodus(scratch.path("a.exo"), mesh, {});
  check_ranges_of_file(scratch.path("a.exo"), 6);
}

TEST_CASE("a range of a file begins and ends anywhere in its blocks, and may be long",
          "[m2m][placement]") {
  const test::Scratch scratch;
  TetMesh mesh = kuhn_mesh({3, 0.1});
  mesh.blocks = {{1, "", 50}, {2, "", 1}, {3, "", mesh.n_tets() - 51}};
  TetMesh large;  // more points and tetrahedra than are read at a time
  for (int i = 0; i < 70'000; ++i) {
    large.points.push_back({std::sin(i), std::sin(2.3 * i), std::sin(3.7 * i)});
    large.tets.push_back({i, (7 * i + 1) % 70'000, (11 * i + 2) % 70'000, (13 * i + 3) % 70'000});
  }
  for (const TetMesh& whole : {mesh, large}) {
    write_exodus(scratch.path("a.exo"), whole, {});
    const std::string gmsh = scratch.write("a.msh", gmsh_bytes(whole, 1, false));
    for (const std::string& name : {scratch.path("a.exo"), gmsh}) {
      const auto ranges = open_ranges(name, RangeCheck::all);
      REQUIRE(ranges != nullptr);
      const auto n_points = static_cast<GlobalId>(whole.n_points());
      const auto n_tets = static_cast<GlobalId>(whole.n_tets());
      for (const GlobalId first : {0, 1, 49, 50, 51, 61})
        for (const GlobalId last : {1, 50, 51, 52, 64, 1'000'000}) {
          INFO(name << " of " << n_tets << " tetrahedra, from " << first << " to " << last);
          const auto end = [&](GlobalId n) { return std::max(first, std::min(last, n)); };
          std::vector<Point> points(static_cast<std::size_t>(end(n_points) - first));
          ranges->points(first, points);
          CHECK(std::equal(points.begin(), points.end(), whole.points.begin() + first));
          std::vector<Tet> tets(static_cast<std::size_t>(end(n_tets) - first));
          ranges->tets(first, tets);
          CHECK(std::equal(tets.begin(), tets.end(), whole.tets.begin() + first));
        }
    }
  }
}

TEST_CASE("a range with a vertex that does not exist is refused", "[m2m][placement]") {
  const test::Scratch scratch;
  TetMesh mesh = kuhn_mesh({2});
  for (const VertexId bad : {27, 1'000'000}) {  // it has 27 vertices
    mesh.tets[20][2] = bad;
    const std::string gmsh = scratch.write("a.msh", gmsh_bytes(mesh, 1, false));
    write_exodus(scratch.path("a.exo"), mesh, {});
    for (const auto& [name, words] : {std::pair{gmsh, "tet4 20 names node "},
                                      std::pair{scratch.path("a.exo"), "names vertex "}}) {
      const auto ranges = open_ranges(name);
      REQUIRE(ranges != nullptr);
      std::vector<Tet> tets(20);
      CHECK_NOTHROW(ranges->tets(0, tets));
      CHECK_THROWS_WITH(ranges->tets(1, tets), Contains(words + std::to_string(bad + 1)));
    }
  }
}

TEST_CASE("a file that read_mesh() refuses as a whole is not read in ranges", "[m2m][placement]") {
  const test::Scratch scratch;
  TetMesh mesh = kuhn_mesh({2});
  std::string gmsh = gmsh_bytes(mesh, 1, false);
  ++gmsh[gmsh.find("$Elements\n") + 10 + 8];  // the number of elements
  mesh.blocks = {{1, "", 20}, {2, "", mesh.n_tets() - 20}};
  write_exodus(scratch.path("a.exo"), mesh, {});
  std::string exodus = test::slurp(scratch.path("a.exo"));
  for (const NetcdfVariable& variable : read_netcdf_header("a.exo", exodus).variables)
    if (variable.name == "eb_prop1") exodus[variable.begin + 7] = 1;  // also the second block
  for (const auto& [name, words] :
       {std::pair{scratch.write("a.msh", gmsh), "elements announced"},
        std::pair{scratch.write("b.exo", exodus), "two blocks or sets with the same number"}}) {
    CHECK(open_ranges(name, RangeCheck::all) == nullptr);
    CHECK_THROWS_WITH(read_mesh(name), Contains(words));
  }
}

TEST_CASE("a file that cannot be read in ranges is read by one PE, and sent", "[m2m][placement]") {
  const test::Scratch scratch;
  const std::string path = scratch.write("swapped.msh", gmsh_bytes(kuhn_mesh({3}), 1, true));
  CHECK(open_ranges(path, RangeCheck::all) == nullptr);
  check_seeds({read_mesh(path), 1, 0, true}, 6);
}

TEST_CASE("ranges of the real ExodusII and gmsh files are those of the whole meshes",
          "[m2m][placement][.][shared_data]") {
  check_ranges_of_file(test::shared_data("nalu/3d_tet4_taylor_green_0p4.exo"), 2);
  check_ranges_of_file(test::shared_data("nalu/3d_tet4_pipe.exo"), 1);
  check_ranges_of_file(test::shared_data("mfem/simple-cube-tet4.e"), 2);
}

namespace {

MeshSurvey survey_on(int n_pes, const std::string& name,
                     const std::vector<FormulaField>& fields = {}) {
  MeshSurvey out;
  REQUIRE(tests::run_threads(n_pes, [&]() -> Task {
            out = co_await survey(name, fields);
          }).exit_code == 0);
  return out;
}

}  // namespace

TEST_CASE("a survey by all PEs finds what one PE finds", "[m2m][placement]") {
  const test::Scratch scratch;
  write_exodus(scratch.path("odd.exo"), odd_mesh(), {});
  write_vtu(scratch.path("odd.vtu"), odd_mesh(), {});
  CHECK(is_read_in_ranges("kuhn:5@0.2"));
  CHECK(is_read_in_ranges(scratch.path("odd.exo")));
  CHECK_FALSE(is_read_in_ranges(scratch.path("odd.vtu")));
  CHECK_FALSE(is_read_in_ranges(scratch.path("missing.exo")));
  for (const std::string& name :
       {std::string("kuhn:5@0.2"), scratch.path("odd.exo"), scratch.path("odd.vtu")}) {
    const MeshSurvey want = survey(read_mesh(name));
    for (const int n_pes : {1, 3}) {
      INFO(name << ", " << n_pes << " PEs");
      const MeshSurvey got = survey_on(n_pes, name);
      CHECK(got.n_points == want.n_points);
      CHECK(got.n_tets == want.n_tets);
      CHECK(got.census.n_flat == want.census.n_flat);
      CHECK(got.census.n_inverted == want.census.n_inverted);
      CHECK(got.census.n_unused == want.census.n_unused);
      CHECK(got.census.bounds == want.census.bounds);
      CHECK(got.longest_edge == want.longest_edge);
      CHECK(got.volume == want.volume);
    }
  }
  CHECK(survey(odd_mesh()).census.n_unused == 2);
  CHECK(survey(kuhn_mesh({4})).volume == Approx(1));
}

TEST_CASE("a survey refuses what a reader, validate() and sample() refuse", "[m2m][placement]") {
  const TetMesh mesh = kuhn_mesh({4});
  const std::string formula = "1/(x + y - 1.25)";
  const Aabb box = bounds(mesh);
  const std::string want =
      test::message_of([&] { (void)sample(mesh, formula, make_formula(formula, box)); });
  REQUIRE_FALSE(want.empty());
  const auto refusal_of = [](const std::string& name, const std::vector<FormulaField>& fields) {
    return tests::error_of("pes=3", [&] { return survey(name, fields); });
  };
  CHECK(refusal_of("kuhn:4", {{"x", box}, {formula, box}}) == want);
  CHECK(refusal_of("kuhn:4", {{formula, box}, {"1/z", box}}) == want);  // whose first vertex is 0
  CHECK(refusal_of("missing.msh", {}) == test::message_of([] { (void)read_mesh("missing.msh"); }));
}
