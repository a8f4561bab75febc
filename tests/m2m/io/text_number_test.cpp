#include "m2m/io/text_number.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "tests/m2m/io/gmsh_text.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <cmath>
#include <string>

using namespace tess::m2m;
using tess::test::as_gmsh, tess::test::Scratch;

namespace {

/// The number that the whole text is, or NaN.
template <class T>
double number_of(const std::string& text) {
  T value{};
  const char* const end = text.data() + text.size();
  const bool whole = read_text_number(text.data(), end, value) == end && !text.empty();
  return whole ? static_cast<double>(value) : std::nan("");
}

}  // namespace

TEST_CASE("numbers of text have signs, and may be beyond what floating point holds", "[m2m][io]") {
  CHECK(number_of<double>("+1.5") == 1.5);
  CHECK(number_of<double>("-1.5e+2") == -150);
  CHECK(number_of<double>("1e-400") == 0);
  CHECK(std::isinf(number_of<double>("-1e400")));
  CHECK(number_of<int>("+12") == 12);
  for (const char* text : {"", "+", "+-1", "++1", "1.#IND", "x"}) {
    CAPTURE(text);
    CHECK(std::isnan(number_of<double>(text)));
  }
  CHECK(std::isnan(number_of<int>("99999999999")));
}

TEST_CASE("gmsh's text may have plus signs and vanishing numbers; parametric nodes are refused",
          "[m2m][io]") {
  const Scratch scratch;
  const TetMesh mesh = kuhn_mesh({2});
  std::string text = as_gmsh(mesh, true, false, 1);
  const auto replace_all = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
      text.replace(at, from.size(), to), at += to.size();
  };
  replace_all(" 0.5", " +0.5");
  replace_all(" 1\n", " 1.0000e+00\n");
  const std::size_t zero = text.find(" 0 0 0\n");
  REQUIRE(zero != std::string::npos);
  text.replace(zero, 7, " 1e-400 0 0\n");
  const TetMesh read = read_mesh(scratch.write("signs.msh", text));
  CHECK(read.points == mesh.points);
  CHECK(read.tets == mesh.tets);
  replace_all("Nodes\n", "ParametricNodes\n");
  CHECK_THROWS_WITH(read_mesh(scratch.write("parametric.msh", text)),
                    Contains("Mesh.SaveParametric 0"));
}
