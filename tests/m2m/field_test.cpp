#include "m2m/field.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/mesh/fields/expression.hpp"
#include "tests/m2m/error_norms.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <bit>
#include <cmath>
#include <limits>

using namespace tess::m2m;
using tess::test::error_norms, tess::test::message_of;

TEST_CASE("an expression has the value of the same expression in C++", "[m2m][field]") {
  const Point p{0.3, -1.5, 2};
  const double x = p[0], y = p[1], z = p[2];
  CHECK(Expression("x+y*z")(p) == x + y * z);
  CHECK(Expression(" ( x + y ) * z ")(p) == (x + y) * z);
  CHECK(Expression("1-2-3")(p) == -4);
  CHECK(Expression("12/2/3")(p) == 2);
  CHECK(Expression("2^3^2")(p) == 512);
  CHECK(Expression("-z^2")(p) == -4);
  CHECK(Expression("2^-1")(p) == 0.5);
  CHECK(Expression("--z")(p) == 2);
  CHECK(Expression("1.5e-3*pi")(p) == 1.5e-3 * M_PI);
  CHECK(Expression("sin(x)*cos(y)+exp(x)-log(z)+tan(x)")(p) ==
        std::sin(x) * std::cos(y) + std::exp(x) - std::log(z) + std::tan(x));
  CHECK(Expression("sqrt(abs(y))")(p) == std::sqrt(1.5));
  CHECK(Expression("min(x, max(y, z)) + pow(z, 3)")(p) == x + 8);
  for (const char* text :
       {"min(1, sqrt(y))", "min(sqrt(y), 1)", "max(1, sqrt(y))", "max(sqrt(y), 1)"})
    CHECK(std::isnan(Expression(text)(p)));
}

TEST_CASE("an error in an expression names its position", "[m2m][field]") {
  const auto message = [](const char* text) { return message_of([&] { Expression e{text}; }); };
  CHECK_THAT(message(""), Contains("position 1: expected a value"));
  CHECK_THAT(message("x +"), Contains("position 4: expected a value"));
  CHECK_THAT(message("x + foo(y)"), Contains("position 5: unknown name 'foo'"));
  CHECK_THAT(message("sin x"), Contains("position 5: expected '('"));
  CHECK_THAT(message("min(x)"), Contains("position 6: expected ','"));
  CHECK_THAT(message("(x"), Contains("position 3: expected ')'"));
  CHECK_THAT(message("x y"), Contains("position 3: expected an operator"));
  CHECK_THAT(message(std::string(100000, '(').c_str()), Contains("nested too deeply"));
  CHECK_THAT(message(std::string(100000, '-').c_str()), Contains("nested too deeply"));
}

TEST_CASE("error norms of a constant error are exact, and a NaN is the largest error",
          "[m2m][field]") {
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  const std::vector<double> truth(mesh.n_points(), 2.0);
  std::vector<double> values(mesh.n_points(), 2.5);
  values[17] = 1;
  values[30] = 1;
  const ErrorNorms norms = error_norms(mesh, values, truth);
  CHECK(norms.linf == 1);
  CHECK(norms.worst == 17);
  const ErrorNorms even = error_norms(mesh, std::vector<double>(mesh.n_points(), 2.5), truth);
  CHECK(even.l2 == Approx(0.5));  // the box has volume 1
  CHECK(even.l2_relative == Approx(0.25));
  CHECK(even.rms == Approx(0.5));
  // Vertices that do not count change nothing.
  std::vector<bool> counts(mesh.n_points(), true);
  counts[17] = counts[30] = false;
  const ErrorNorms some = error_norms(mesh, values, truth, counts);
  CHECK(some.n_vertices == mesh.n_points() - 2);
  CHECK(even.n_vertices == mesh.n_points());
  CHECK(some.linf == 0.5);
  CHECK(some.rms == Approx(0.5));
  CHECK(some.l2_relative == Approx(0.25));
  CHECK(some.l2 < even.l2);
  CHECK(error_norms(mesh, values, truth, std::vector<bool>(mesh.n_points())).n_vertices == 0);
  values[5] = std::numeric_limits<double>::quiet_NaN();
  CHECK(error_norms(mesh, values, truth).worst == 5);
  CHECK(std::isnan(error_norms(mesh, values, truth).linf));
}

TEST_CASE("the hash depends on every bit, and can be computed in pieces", "[m2m][field]") {
  const std::vector<double> a{1, 2, 3}, b{1, 2, std::nextafter(3.0, 4)};
  CHECK(result_hash(a) != result_hash(b));
  CHECK(result_hash({}) == 0xcbf29ce484222325U);
  CHECK(result_hash(std::span(a).subspan(1), result_hash(std::span(a).first(1))) == result_hash(a));
  // FNV-1a of the text "aaaaaaaa", by its definition.
  std::uint64_t wanted = 0xcbf29ce484222325U;
  for (int i = 0; i < 8; ++i) wanted = (wanted ^ 0x61U) * 0x100000001b3U;
  const std::vector<double> letters{std::bit_cast<double>(0x6161616161616161U)};
  CHECK(result_hash(letters) == wanted);
}

TEST_CASE("the error for a formula that is not finite names the vertex", "[m2m][field]") {
  const TetMesh mesh = kuhn_mesh({2});
  const Formula formula = make_formula("1/(x-0.5)", bounds(mesh));
  CHECK_THROWS_WITH(sample(mesh, "f", formula), Contains("at vertex 1 of kuhn:2"));
}
