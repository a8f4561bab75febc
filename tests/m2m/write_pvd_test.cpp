#include "m2m/write_pvd.hpp"

#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "tests/apps/xml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <array>

using namespace tess::m2m;
using tess::test::Scratch;

TEST_CASE("a series names a file per step with its time, and each is read back", "[m2m][io]") {
  const Scratch scratch;
  TetMesh mesh = kuhn_mesh({1});
  const std::string path = scratch.path("r & s.pvd");
  PvdSeries out(path);
  for (std::size_t step = 0; step < 3; ++step) {
    const double time = 0.1 * static_cast<double>(step);
    out.add(time, mesh, std::array{Field{"t", 1, std::vector<double>(8, time)}});
    std::vector<std::string> files;
    for (const auto& element : tess::test::read_xml(tess::test::slurp(path)))
      if (element.name == "DataSet") files.push_back(element.attributes);
    REQUIRE(files.size() == step + 1);
    CHECK_THAT(files.back(), Contains("file=\"r & s." + std::to_string(step) + ".vtu\""));
    const std::string file = scratch.path("r & s." + std::to_string(step) + ".vtu");
    CHECK(FieldFile(file).times() == std::vector{time});
    CHECK(FieldFile(file).vertex_field(read_mesh(file), "t", 0).values[7] == time);
    mesh.points[7][0] += 1;
  }
  CHECK_THROWS_WITH(out.add(0.2, mesh, {}),
                    Contains("step 3 has time 0.2, which is not after 0.2"));
  CHECK_THROWS_WITH(PvdSeries("r.vtu"), "r.vtu: a series of VTU files ends in .pvd; rename it");
  CHECK_THROWS_WITH(PvdSeries("r\xff.pvd"), Contains("cannot hold the name of this file"));
  CHECK_THROWS_WITH(PvdSeries("no/such/r.pvd").add(0, mesh, {}), Contains("no/such/r.0.vtu"));
}
