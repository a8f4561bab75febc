// Sections of values in gmsh files whose counts are wrong.
#include "m2m/field_file.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "tests/m2m/io/gmsh_text.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

using namespace tess::m2m;
using tess::test::as_gmsh, tess::test::message_of, tess::test::Scratch;

namespace {

/// Reads the field `p` in the six tetrahedra of a cube, which have the tags 2 to 7.
std::string refusal_of_section(const Scratch& scratch, const std::string& section) {
  const std::string path =
      scratch.write("p.msh", as_gmsh(kuhn_mesh({1}), false, false, 1) + section);
  const TetMesh mesh = read_mesh(path);
  return message_of([&] { (void)FieldFile(path).tet_field(mesh, "p", 0); });
}

}  // namespace

TEST_CASE("more rows of a gmsh section than it announces are refused", "[m2m][io]") {
  const Scratch scratch;
  const auto section = [](const char* n_rows) {
    return std::string("$ElementData\n1\n\"p\"\n1\n0\n3\n0\n1\n") + n_rows +
           "\n2 0\n3 0\n4 0\n5 0\n6 0\n7 0\n1 0\n$EndElementData\n";
  };
  CHECK(refusal_of_section(scratch, section("7")).empty());
  CHECK_THAT(refusal_of_section(scratch, section("6")),
             Contains("expected $EndElementData, found '1'"));
}

TEST_CASE("a gmsh section has no more names than fit in the file", "[m2m][io]") {
  const Scratch scratch;
  CHECK_THAT(refusal_of_section(scratch, "$ElementData\n4294967295\n\"p\"\n$EndElementData\n"),
             Contains("4294967295 names do not fit in the file"));
}
