#include "m2m/read_mesh.hpp"

#include "m2m/kuhn.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>

using namespace tess::m2m;
using tess::test::made_mesh, tess::test::message_of, tess::test::Scratch, tess::test::shared_data;

namespace {

double total_volume(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) sum += std::abs(signed_volume(mesh, t));
  return sum;
}

bool one_line(const std::string& text) {
  return !text.empty() && text.find('\n') == std::string::npos;
}

}  // namespace

TEST_CASE("a Kuhn box fills the unit cube with 6 n cubed positive tetrahedra", "[m2m][io]") {
  for (const char* name : {"kuhn:1", "kuhn:5", "kuhn:4@0.2"}) {
    const TetMesh mesh = read_mesh(name);
    const MeshCensus census = validate(mesh);
    CHECK(mesh.name == name);
    CHECK(census.n_flat == 0);
    CHECK(census.n_inverted == 0);
    CHECK(census.n_unused == 0);
    CHECK(total_volume(mesh) == Approx(1).epsilon(1e-12));
  }
  CHECK(read_mesh("kuhn:5").n_tets() == 750);
  CHECK(read_mesh("kuhn:5").n_points() == 216);
  // The jitter is the same on every machine.
  CHECK(read_mesh("kuhn:4@0.2").points.at(31) ==
        Point{0x1.f996b397d1e07p-3, 0x1.9e2d564ebe42fp-3, 0x1.a8c502bbcf924p-3});
}

TEST_CASE("the real ExodusII meshes have their known counts and volumes",
          "[m2m][io][.][shared_data]") {
  struct Known {
    const char* name;
    std::size_t points, tets;
    double volume;
  };
  constexpr double box = 6.28318 * 6.28318 * 6.28318;  // the files have 6 digits
  for (const Known& known : {Known{"nalu/3d_tet4_taylor_green_0p4.exo", 2650, 10548, box},
                             Known{"nalu/3d_tet4_taylor_green_0p2.exo", 11205, 46673, box},
                             Known{"nalu/3d_tet4_pipe.exo", 14905, 77952, 0}}) {
    const TetMesh mesh = read_mesh(shared_data(known.name));
    CHECK(mesh.n_points() == known.points);
    CHECK(mesh.n_tets() == known.tets);
    if (known.volume > 0) CHECK(total_volume(mesh) == Approx(known.volume).epsilon(1e-6));
  }
}

TEST_CASE("the real gmsh meshes are read in both versions and modes", "[m2m][io][.][shared_data]") {
  for (const char* name : {"mfem/indheat.asc.v22.msh", "mfem/indheat.bin.v41.msh",
                           "mfem/homology.asc.v41.msh", "skfem/cuubat.msh"}) {
    CAPTURE(name);
    const TetMesh mesh = read_mesh(shared_data(name));
    CHECK(mesh.n_tets() > 1000);
    CHECK(total_volume(mesh) > 0);
  }
  CHECK(total_volume(read_mesh(shared_data("mfem/indheat.asc.v22.msh"))) ==
        Approx(total_volume(read_mesh(shared_data("mfem/indheat.bin.v41.msh")))));
}

TEST_CASE("gmsh's files of both versions and modes give the same mesh", "[m2m][io][.][meshes]") {
  const TetMesh mesh = read_mesh(made_mesh("shaft_coarse"));
  CHECK(mesh.n_tets() > 500);
  const double whole = 2 * 1.5 * 1.5, shaft = 2 * M_PI * 0.3 * 0.3;
  CHECK(total_volume(mesh) > whole - shaft);  // the cut is a polygon within the circle
  CHECK(total_volume(mesh) < whole - 0.8 * shaft);
  for (const char* name : {"shaft_binary", "shaft_22", "shaft_22_binary"}) {
    CAPTURE(name);
    const TetMesh other = read_mesh(made_mesh(name));
    CHECK(other.tets == mesh.tets);
    REQUIRE(other.n_points() == mesh.n_points());
    double farthest = 0;
    for (std::size_t v = 0; v < mesh.n_points(); ++v)
      for (std::size_t k = 0; k < 3; ++k)
        farthest = std::max(farthest, std::abs(other.points[v][k] - mesh.points[v][k]));
    CHECK(farthest < 1e-15 * 4);  // text has 16 digits
  }
}

TEST_CASE("gmsh's hexahedra and quadratic tetrahedra are split", "[m2m][io][.][meshes]") {
  const TetMesh hexes = read_mesh(made_mesh("hexes"));
  CHECK(split_text(hexes) == "8 HEX8 into 48 tetrahedra");
  CHECK(total_volume(hexes) == Approx(1).epsilon(1e-14));
  const TetMesh shaft = read_mesh(made_mesh("shaft_quadratic"));
  REQUIRE(shaft.split.size() == 1);
  CHECK(shaft.split[0].type == "TET10");
  CHECK(shaft.n_tets() == 8 * shaft.split[0].n_elements);
}

TEST_CASE("real meshes of hexahedra, wedges, pyramids and quadratic tetrahedra are split",
          "[m2m][io][.][shared_data]") {
  struct Known {
    const char* file;
    const char* split;
    double volume;
  };
  for (const Known& known :
       {Known{"mfem/simple-cube-hex8.e", "27 HEX8 into 162 tetrahedra", 1},
        Known{"mfem/simple-cube-wedge6.e", "250 WEDGE6 into 750 tetrahedra", 1},
        Known{"mfem/simple-cube-pyramid5.e", "750 PYRAMID5 into 1500 tetrahedra", 1},
        Known{"mfem/simple-cube-tet10.e", "295 TET10 into 2360 tetrahedra", 1},
        Known{"mfem/simple-cube-hex27.e", "27 HEX27 into 1296 tetrahedra", 1},
        Known{"mfem/simple-cube-multi-element-order1.e",
              "27 HEX8 into 162 tetrahedra, 250 WEDGE6 into 750 tetrahedra, "
              "750 PYRAMID5 into 1500 tetrahedra",
              4},
        Known{"mfem/simple-cube-tet4.e", "", 1},
        Known{"nalu/3d_hex8_taylor_green_0p2.exo", "29791 HEX8 into 178746 tetrahedra",
              std::pow(2 * M_PI, 3)},
        Known{"skfem/quadratic_sphere_tet.msh", "722 TET10 into 5776 tetrahedra", 0.519}}) {
    const TetMesh mesh = read_mesh(shared_data(known.file));
    CAPTURE(known.file);
    CHECK(split_text(mesh) == known.split);
    CHECK(total_volume(mesh) == Approx(known.volume).epsilon(1e-3));
    CHECK(mesh.element_of_tet.size() == (mesh.split.empty() ? 0 : mesh.n_tets()));
    CHECK(validate(mesh).n_inverted == 0);
    // Every triangle belongs to one or two tetrahedra: neighbours are split alike.
    std::map<std::array<VertexId, 3>, int> count;
    for (const Tet& tet : mesh.tets) {
      for (std::size_t k = 0; k < 4; ++k) {
        std::array<VertexId, 3> face{tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
        std::sort(face.begin(), face.end());
        ++count[face];
      }
    }
    CHECK(
        std::all_of(count.begin(), count.end(), [](const auto& face) { return face.second <= 2; }));
    for (const SideSet& set : mesh.side_sets) CHECK_FALSE(set.entries.empty());
  }
}

TEST_CASE("elements of higher order are refused by name", "[m2m][io][.][shared_data]") {
  struct Known {
    const char* file;
    const char* word;
  };
  for (const Known& known : {Known{"mfem/simple-cube-wedge18.e", "WEDGE18"},
                             Known{"mfem/simple-cube-pyramid14.e", "PYRAMID14"}}) {
    const std::string path = shared_data(known.file);
    const std::string message = message_of([&] { (void)read_mesh(path); });
    CHECK(one_line(message));
    CHECK_THAT(message, Contains(known.word) && Contains(known.file));
  }
  CHECK(total_volume(read_mesh(shared_data("mfem/simple-cube-tet4.e"))) > 0);
  CHECK(read_mesh(shared_data("skfem/cylinder_stokes.msh")).dimension == 2);
}

TEST_CASE("a missing, empty or foreign file gives one line of error that names it", "[m2m][io]") {
  Scratch scratch;
  const std::string empty = scratch.write("empty.msh", "");
  const std::string foreign = scratch.write("foreign.exo", "hello, I am not a mesh\n");
  const std::string short_cdf = scratch.write("short.exo", "CDF");
  const std::string short_hdf = scratch.write("short4.exo", "\x89HDF\r\n");
  for (const std::string& path :
       {empty, foreign, short_cdf, short_hdf, scratch.path("missing.exo"), scratch.path("")}) {
    const std::string message = message_of([&] { (void)read_mesh(path); });
    CAPTURE(path);
    CHECK(one_line(message));
    CHECK_THAT(message, Contains(path));
  }
  for (const char* name : {"kuhn:", "kuhn:0", "kuhn:-1", "kuhn:x", "kuhn:3x", "kuhn:3@", "kuhn:3@1",
                           "kuhn:99999999999"}) {
    CHECK_THROWS_WITH(read_mesh(name), Contains(name));
  }
}

TEST_CASE("validate() names a wrong element, and allows flat and inverted tetrahedra", "[m2m]") {
  TetMesh mesh = kuhn_mesh({2});
  mesh.name = "the mesh";
  std::swap(mesh.tets[3][0], mesh.tets[3][1]);
  mesh.tets[7] = {0, 1, 2, 1};
  mesh.points.push_back({9, 9, 9});
  const MeshCensus census = validate(mesh);
  CHECK(census.n_inverted == 1);
  CHECK(census.n_flat == 1);
  CHECK(census.n_unused == 1);
  CHECK(census.bounds.hi[0] == 9);
  CHECK(unused_text(census.n_unused, mesh.n_points()) == "1 of 28 vertices belong to no element");
  CHECK(unused_text(0, 28).empty());
  CHECK(coincident_text(mesh).empty());
  TetMesh seam = mesh;
  seam.points[3] = seam.points[20] = seam.points[9];
  CHECK(coincident_text(seam) == "3 of 28 vertices have the place of another");
  CHECK(repeated_text(mesh).empty());
  seam.tets.push_back(seam.tets[5]);
  std::swap(seam.tets.back()[0], seam.tets.back()[2]);
  CHECK(repeated_text(seam) ==
        tess::text("2 of ", seam.n_tets(), " tetrahedra have the corners of another"));

  TetMesh bad = mesh;
  bad.points[5][1] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(validate(bad), Contains("the mesh: vertex 5 has y = "));
  bad = mesh;
  bad.points[5][2] = -std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(validate(bad), Contains("vertex 5 has z = "));
  bad = mesh;
  bad.tets[4][2] = 28;
  CHECK_THROWS_WITH(validate(bad), Contains("tetrahedron 4 names vertex 28"));
  bad = mesh;
  bad.tets.clear();
  CHECK_THROWS_WITH(validate(bad), Contains("no tetrahedra"));
}

TEST_CASE("a mesh whose coordinates have collapsed is refused by name, with the remedy", "[m2m]") {
  const auto moved = [](double scale, double shift) {
    TetMesh mesh = kuhn_mesh({4, 0.2});
    mesh.name = "the mesh";
    for (Point& p : mesh.points)
      for (double& x : p) x = x * scale + shift;
    return mesh;
  };
  const auto refused = [](const TetMesh& mesh, const char* word) {
    const std::string message = message_of([&] { validate(mesh); });
    CHECK(one_line(message));
    CHECK_THAT(message, Catch::StartsWith("the mesh: ") && Contains(word));
  };
  refused(moved(1, 1e15), "shift the mesh towards the origin");
  refused(moved(1, -1e14), "shift the mesh towards the origin");
  refused(moved(1e-150, 0), "rescale the mesh");
  refused(moved(1e-320, 0), "rescale the mesh");
  refused(moved(0, 0), "rescale the mesh");
  refused(moved(0, 3), "shift the mesh");
  TetMesh flat = moved(1, 0);
  for (Point& p : flat.points) p[2] = 0;
  refused(flat, "no tetrahedron has a volume");

  for (const auto& [scale, shift] :
       {std::pair{1.0, 1e9}, std::pair{1e-9, 0.0}, std::pair{1e9, 0.0}, std::pair{1e-70, 0.0},
        std::pair{1e60, 0.0}, std::pair{1.0, 1e12}})
    CHECK_NOTHROW(validate(moved(scale, shift)));
  TetMesh graded = moved(1, 0);  // one collapsed tetrahedron among many
  graded.tets.push_back({1, 1, 1, 1});
  CHECK(validate(graded).n_flat == 1);
}
