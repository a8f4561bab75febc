#include "apps/m2m_transfer/study/study.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/write_exodus.hpp"
#include "tests/apps/m2m_transfer/program.hpp"
#include "tests/apps/xml.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace tess;
using namespace tess::m2m;
using namespace m2m_transfer;
using tess::test::Scratch, tess::test::slurp, tests::exit_code, tests::results_of, tests::threads;

namespace {

using Strings = tests::Words;

Strings pairs_of(const std::string& source, const std::string& target, const Strings& policies) {
  Request request;
  request.source = source;
  request.target = target;
  Strings out;
  for (const Request& one : plan_study(request, policies, {"linear"}))
    out.push_back(one.source + " " + one.target + " " + one.policy);
  return out;
}

}  // namespace

TEST_CASE("a ladder of meshes expands to its meshes", "[apps][study]") {
  CHECK(expand("kuhn:8,16@0.2") == Strings{"kuhn:8@0.2", "kuhn:16@0.2"});
  CHECK(expand("kuhn:4") == Strings{"kuhn:4"});
  CHECK(expand("a.msh,b.exo") == Strings{"a.msh", "b.exo"});
  const Scratch scratch;
  const std::string odd = scratch.write("a,b.msh", "");
  CHECK(expand(odd) == Strings{odd});
  CHECK_THROWS_WITH(expand("kuhn:8,x"), Contains("'kuhn:x'"));
}

TEST_CASE("a study pairs its sources and targets", "[apps][study]") {
  CHECK(pairs_of("kuhn:2,4", "", {"keep"}) == Strings{"kuhn:2 kuhn:3 keep", "kuhn:4 kuhn:5 keep"});
  CHECK(pairs_of("kuhn:2,4", "kuhn:9", {"keep"}) ==
        Strings{"kuhn:2 kuhn:9 keep", "kuhn:4 kuhn:9 keep"});
  CHECK(pairs_of("kuhn:2", "kuhn:3", {"keep", "nearest"}) ==
        Strings{"kuhn:2 kuhn:3 keep", "kuhn:3 kuhn:2 keep", "kuhn:2 kuhn:3 nearest",
                "kuhn:3 kuhn:2 nearest"});
  CHECK_THROWS_WITH(pairs_of("kuhn:2,3", "kuhn:4,5,6", {"keep"}),
                    Contains("2 source meshes and 3 target meshes"));
  CHECK_THROWS_WITH(pairs_of("absent.msh", "kuhn:4", {"keep"}),
                    Contains("absent.msh: cannot be opened"));
  CHECK_THROWS_WITH(pairs_of("absent.msh", "", {"keep"}), Contains("TARGET is missing"));
  CHECK_THROWS_WITH(pairs_of("kuhn:2", "kuhn:4", {"perhaps"}), Contains("perhaps"));
}

TEST_CASE("a study shows second order, and writes the same numbers to its files", "[apps][study]") {
  const Scratch scratch;
  const std::string plots = scratch.path("deep/study");
  const auto code_with = [&](const std::string& field) {
    return exit_code(
        threads(2), {"kuhn:6,12,24@0.2", "--fields", "sin", "--fields", "linear", "--fields", field,
                     "--chares", "2", "--study", "h", "--plot", plots, "--repeat", "1"});
  };
  SECTION("an error in a field leaves only the empty folder") {
    CHECK(code_with("x*y, or worse") == 2);
    CHECK(std::filesystem::is_empty(plots));
  }
  SECTION("correct fields") {
    REQUIRE(code_with("min(x, 1)") == 0);
    const auto report = nlohmann::json::parse(slurp(plots + "/study.json"));
    const auto& rows = report["results"];
    REQUIRE(rows.size() == 3 * 3);
    CHECK(rows[3]["l2_found"] == rows[3]["l2"]);  // all are found
    CHECK(report["definitions"]["found"].get<std::string>().find("inside") != std::string::npos);
    const auto& trends = report["trends"];
    REQUIRE(trends.size() == 3);
    CHECK(trends[0]["l2_of_edge"].get<double>() == Approx(2).margin(0.25));
    CHECK(trends[0]["l2_of_seconds"].get<double>() < 0);
    CHECK_FALSE(trends[0]["exact"].get<bool>());
    CHECK(trends[1]["exact"].get<bool>());
    CHECK(trends[1]["l2_of_edge"].is_null());
    CHECK(trends[2]["exact"].get<bool>());
    const std::string csv = slurp(plots + "/study.csv");
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 3 * 3);
    CHECK_THAT(csv, Contains("\"min(x, 1)\""));
    for (const auto& row : rows) CHECK_THAT(csv, Contains(row["result_hash"].get<std::string>()));
    // The picture shows the only field with an error, in two norms.
    const std::string data = slurp(plots + "/error_time.csv");
    CHECK(std::count(data.begin(), data.end(), '\n') == 1 + 2 * 3);
  }
}

TEST_CASE("the picture of a study has a curve per norm, and one of order 2",
          "[apps][study][.][gnuplot]") {
  const Scratch scratch;
  const std::string plots = scratch.path("study");
  REQUIRE(exit_code(threads(2), {"kuhn:3,6", "--fields", "sin", "--study", "h", "--plot", plots,
                                 "--repeat", "1"}) == 0);
  const auto elements = test::read_xml(slurp(plots + "/error_edge.svg"));
  CHECK(std::count_if(elements.begin(), elements.end(), [](const test::XmlElement& e) {
          return e.attributes.find("id=\"gnuplot_plot_") != std::string::npos;
        }) == 3);
}

TEST_CASE("norms over found vertices leave out values of the policy", "[apps][transfer]") {
  const Scratch scratch;
  TetMesh target = kuhn_mesh({5});
  for (Point& p : target.points) p[0] *= 2;  // half outside
  write_exodus(scratch.path("wide.exo"), target, {});
  const auto row =
      results_of(threads(2), {"kuhn:4", scratch.path("wide.exo"), "--fields", "linear", "--policy",
                              "value:1000", "--picture", scratch.path("cut.svg")})[0];
  CHECK(row["outside"] == 3 * 36);
  CHECK(row["found"] == 3 * 36);
  CHECK(row["linf_found"].get<double>() < 1e-12);
  CHECK(row["l2_found"].get<double>() < 1e-12);
  CHECK(row["linf"].get<double>() > 900);
  CHECK(row["l2"].get<double>() > 100);
  // The picture shows the plane across the first of the two short sides. It uses both ends of the
  // colour scale.
  const std::string svg = slurp(scratch.path("cut.svg"));
  const auto elements = test::read_xml(svg);
  const auto count = [&](const std::string& name) {
    return std::count_if(elements.begin(), elements.end(),
                         [&](const test::XmlElement& e) { return e.name == name; });
  };
  CHECK(count("text") == 6);
  CHECK(count("path") >= 4);
  CHECK_THAT(svg, Contains(">linear, z = 0.3<") && Contains(">1000<"));
}
