#include "m2m/mesh/partition/partition.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "runtime/base/mpi_turn.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"
#include "tests/support/waits_for_turn.hpp"

#include <algorithm>
#include <cmath>

using namespace tess::m2m;
using tess::test::message_of;

TEST_CASE("parts are balanced, and the same in every call", "[m2m][partition]") {
  const TetMesh mesh = kuhn_mesh({6, 0.2});
  for (const PartitionMethod method : {PartitionMethod::rcb, PartitionMethod::hsfc}) {
    for (const std::int32_t n_parts : {1, 2, 3, 8, 64}) {
      const auto parts = partition(mesh, n_parts, method);
      CHECK(parts == partition(mesh, n_parts, method));
      std::vector<std::size_t> sizes(static_cast<std::size_t>(n_parts));
      for (const std::int32_t part : parts) ++sizes.at(static_cast<std::size_t>(part));
      const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
      const double mean = static_cast<double>(mesh.n_tets()) / n_parts;
      CAPTURE(n_parts);
      CHECK(static_cast<double>(*least) > 0.8 * mean);
      CHECK(static_cast<double>(*most) < 1.2 * mean);
    }
  }
  CHECK_NOTHROW(partition(kuhn_mesh({1}), 20, PartitionMethod::rcb));
  CHECK_THAT(
      message_of([&] { (void)split(mesh, partition(mesh, 2, PartitionMethod::rcb), 2, -1); }),
      Catch::Equals("a halo of -1 layers; choose 0 or more"));
  CHECK_THROWS_WITH(partition(mesh, 0, PartitionMethod::rcb), Contains("into 0 parts"));
  CHECK_THROWS_WITH(parse_partition_method("metis"), Contains("'metis'"));
}

TEST_CASE("a partition waits until no other thread is in MPI", "[m2m][partition]") {
  const TetMesh mesh = kuhn_mesh({3});
  const auto cut = [&] { (void)partition(mesh, 2, PartitionMethod::rcb); };
  cut();  // it initialises MPI, which takes long
  CHECK(tess::test::waits_for_turn<tess::detail::MpiTurn>(cut));
}

TEST_CASE("a split has every tetrahedron once, and one owner per vertex, which lists the ghosts",
          "[m2m][partition]") {
  TetMesh mesh = kuhn_mesh({4});
  mesh.points.push_back({7, 7, 7});  // unused
  mesh.points.insert(mesh.points.begin(), Point{8, 8, 8});
  for (Tet& tet : mesh.tets)
    for (VertexId& v : tet) ++v;
  for (const std::int32_t n_parts : {1, 5, 500}) {
    const auto parts = partition(mesh, n_parts, PartitionMethod::hsfc);
    const std::vector<MeshPart> split_parts = split(mesh, parts, n_parts);
    std::vector<int> tets(mesh.n_tets()), owners(mesh.n_points()), owner(mesh.n_points(), -1);
    for (std::size_t p = 0; p < split_parts.size(); ++p) {
      const MeshPart& part = split_parts[p];
      REQUIRE(part.points.size() == part.point_ids.size());
      for (std::size_t i = 0; i < part.points.size(); ++i) {
        const auto v = static_cast<std::size_t>(part.point_ids[i]);
        CHECK(part.points[i] == mesh.points[v]);
        if (i >= static_cast<std::size_t>(part.n_owned)) continue;
        ++owners[v];
        owner[v] = static_cast<int>(p);
      }
      for (std::size_t t = 0; t < part.tets.size(); ++t) {
        ++tets[static_cast<std::size_t>(part.tet_ids[t])];
        for (std::size_t k = 0; k < 4; ++k) {
          const VertexId global = mesh.tets[static_cast<std::size_t>(part.tet_ids[t])][k];
          if (part.point_ids[static_cast<std::size_t>(part.tets[t][k])] != global)
            FAIL("tetrahedron " << t);
        }
      }
    }
    std::size_t n_ghosts = 0, n_listed = 0;
    for (const MeshPart& part : split_parts) {
      n_ghosts += part.points.size() - static_cast<std::size_t>(part.n_owned);
      for (const Ghosts& ghosts : part.ghosts) {
        const MeshPart& user = split_parts.at(static_cast<std::size_t>(ghosts.part));
        REQUIRE(ghosts.here.size() == ghosts.there.size());
        n_listed += ghosts.here.size();
        for (std::size_t i = 0; i < ghosts.here.size(); ++i) {
          const bool same = ghosts.here[i] < part.n_owned && ghosts.there[i] >= user.n_owned &&
                            part.point_ids.at(static_cast<std::size_t>(ghosts.here[i])) ==
                                user.point_ids.at(static_cast<std::size_t>(ghosts.there[i]));
          if (!same) FAIL("ghost " << i << " of part " << ghosts.part);
        }
      }
    }
    CHECK(n_listed == n_ghosts);
    CHECK(std::count(tets.begin(), tets.end(), 1) == static_cast<std::ptrdiff_t>(mesh.n_tets()));
    CHECK(std::count(owners.begin(), owners.end(), 1) ==
          static_cast<std::ptrdiff_t>(mesh.n_points()));
    for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
      for (const VertexId v : mesh.tets[t])
        if (owner[static_cast<std::size_t>(v)] > parts[t])
          FAIL("vertex " << v << " is not owned by its lowest part");
    }
  }
}

TEST_CASE("a mesh that no validate() has seen is cut only if its corners exist",
          "[m2m][partition]") {
  for (const PartitionMethod method :
       {PartitionMethod::curve, PartitionMethod::rcb, PartitionMethod::hsfc}) {
    for (const std::int32_t n_parts : {1, 3}) {
      TetMesh mesh = kuhn_mesh({2});
      mesh.name = "";
      mesh.tets[5][2] = 1 << 30;
      CHECK_THAT(
          message_of([&] { (void)partition(mesh, n_parts, method); }),
          Catch::Equals("the mesh: tetrahedron 5 names vertex 1073741824 (counted from 0) of "
                        "27 vertices; write the mesh again"));
      mesh = kuhn_mesh({2});
      mesh.points[7][1] = std::nan("");
      CHECK_THROWS_WITH(partition(mesh, n_parts, method), Contains("vertex 7 has y = nan"));
    }
    TetMesh cloud;
    cloud.points = kuhn_mesh({2}).points;
    const auto parts = split(cloud, partition(cloud, 3, method), 3);
    std::int64_t n_owned = 0;
    for (const MeshPart& part : parts) n_owned += part.n_owned;
    CHECK(n_owned == 27);
  }
}
