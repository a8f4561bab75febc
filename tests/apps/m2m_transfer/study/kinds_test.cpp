// Studies of kinds, of steps and of PEs.
#include "apps/m2m_transfer/study/study.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/radial_basis.hpp"
#include "tests/apps/m2m_transfer/program.hpp"

#include <algorithm>
#include <cmath>

using namespace tess;
using namespace m2m_transfer;
using tess::test::Scratch, tess::test::slurp, tests::exit_code, tests::results_of, tests::threads,
    tests::Words;

namespace {

/// The largest second derivative along many directions at many points, by differences.
double by_differences(const std::string& name, const Aabb& domain) {
  const Formula f = make_formula(name, domain);
  constexpr double step = 1e-3;
  constexpr int n = 12;
  double most = 0;
  for (int i = 0; i < n * n * n; ++i) {
    Point p{};
    const std::array<int, 3> at{i % n, i / n % n, i / n / n};
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = domain.lo[axis] + (domain.hi[axis] - domain.lo[axis]) * at[axis] / (n - 1.0);
    for (int d = 1; d < 27; ++d) {
      const Point v{d % 3 - 1.0, d / 3 % 3 - 1.0, d / 9 - 1.0};
      const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (length == 0) continue;
      const double s = step / length;
      const double second = f({p[0] + s * v[0], p[1] + s * v[1], p[2] + s * v[2]}) - 2 * f(p) +
                            f({p[0] - s * v[0], p[1] - s * v[1], p[2] - s * v[2]});
      most = std::max(most, std::abs(second) / (step * step));
    }
  }
  return most;
}

}  // namespace

TEST_CASE("the largest second derivatives of the fields are those by differences",
          "[apps][study]") {
  const Aabb domain{{-1, 0, 2}, {0.5, 1, 3.5}};
  for (const char* name : {"sin", "gaussian"}) {
    const double known = largest_second_derivative(name, domain).value();
    const double found = by_differences(name, domain);
    INFO(name << ": " << known << ", by differences " << found);
    CHECK(found <= known * (1 + 1e-4));
    CHECK(found >= known * 0.9);
  }
  CHECK(largest_second_derivative("linear", domain) == 0.0);
  CHECK_FALSE(largest_second_derivative("x*y", domain));
}

TEST_CASE("the longest edge of a cube's tetrahedra is its diagonal", "[apps][study]") {
  CHECK(survey(kuhn_mesh({4})).longest_edge == Approx(std::sqrt(3) / 4));
}

TEST_CASE("a study of kinds has the order of each, and the linear bound holds", "[apps][study]") {
  const Scratch scratch;
  const std::string plots = scratch.path("study");
  REQUIRE(exit_code(threads(2), {"kuhn:12,24@0.1", "--fields", "sin,linear", "--chares", "2",
                                 "--study", "kind", "--plot", plots, "--repeat", "1"}) == 0);
  const auto report = nlohmann::json::parse(slurp(plots + "/study.json"));
  CHECK(report["results"].size() == 2 * 2 * all_transfer_kinds.size());
  for (const auto& trend : report["trends"]) {
    INFO(trend.dump());
    if (trend["exact"].get<bool>() || trend["field"] != "sin") continue;
    const double order = trend["l2_of_edge"].get<double>();
    if (trend["kind"] == "linear") CHECK(order == Approx(2.0).margin(0.1));
    if (trend["kind"] == "second-order") CHECK(order > 2.8);
  }
  int n_bounds = 0, n_orders = 0;
  for (const auto& check : report["checks"]) {
    CHECK(check["ok"].get<bool>());
    const auto what = check["what"].get<std::string>();
    n_bounds += what.find("max|D2f|") != std::string::npos ? 1 : 0;
    n_orders += what.find("order") != std::string::npos ? 1 : 0;
  }
  CHECK(n_bounds == 4);
  CHECK(n_orders == static_cast<int>(all_transfer_kinds.size()));
}

TEST_CASE("a study whose error exceeds the bound, or whose order is too low, fails",
          "[apps][study]") {
  TransferReport coarse;
  coarse.source = "a";
  coarse.kind = "linear";
  coarse.source_edge = 0.2;
  FieldError error;
  error.name = "sin";
  error.norms.l2 = error.norms.l2_relative = 0.1;
  error.found.linf = 0.3;
  error.found.n_vertices = 10;
  error.bound = 0.31;
  coarse.fields = {error};
  TransferReport fine = coarse;
  fine.source_edge = 0.1;
  fine.fields[0].norms.l2 = 0.025;
  std::vector<TransferReport> study{coarse, fine};
  CHECK(checks(study).size() == 3);
  CHECK(failures(checks(study)).empty());
  study[1].fields[0].norms.l2 = 0.05;
  CHECK_THAT(check_rows().table(checks(study)), Contains("FAILED"));
  CHECK_THAT(failures(checks(study)),
             Contains("FAILED: linear, a to a, sin: order of L2 at least: claimed "
                      "1.7500e+00, measured 1.0000e+00") &&
                 Contains("finer"));
  study[1].fields[0].norms.l2 = 0.025;
  study[0].fields[0].bound = 0.29;
  CHECK_THAT(failures(checks(study)),
             Contains("claimed 2.9000e-01, measured 3.0000e-01") && !Contains("finer"));
  study[0].fields[0].bound = 0.31;
  CHECK(failures(checks(study)).empty());
}

TEST_CASE("a study of steps has the same bits with donors that are kept", "[apps][study]") {
  const Scratch scratch;
  const nlohmann::json rows =
      results_of(threads(2), {"kuhn:5", "kuhn:6@0.2", "--study", "steps", "--plot",
                              scratch.path("study"), "--repeat", "1"});
  REQUIRE(rows.size() == 14);  // there and back
  const std::string csv = slurp(scratch.path("study/steps.csv"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 14);
  for (const auto& row : rows) {
    CHECK(row["same_bits"].get<bool>());
    CHECK(row["seconds_per_step_kept"].get<double>() > 0);
    CHECK(row["seconds_per_step_again"].get<double>() > 0);
  }
}

TEST_CASE("kind all runs every kind, each with the result that it has alone", "[apps][study]") {
  const auto rows_of = [&](const std::string& kind) {
    return results_of(
        threads(2), {"kuhn:4@0.2", "kuhn:5", "kuhn:3", "--pairs", "A:B,B:C", "--fields", "sin,x*y",
                     "--steps", "2", "--move", "B:translate(0.01,0,0)", "--kind", kind});
  };
  const nlohmann::json all = rows_of("all");
  REQUIRE(all.size() == 4 * all_transfer_kinds.size());
  for (std::size_t k = 0; k < all_transfer_kinds.size(); ++k) {
    const std::string kind = name_of(all_transfer_kinds[k]);
    const nlohmann::json alone = rows_of(kind);
    for (std::size_t row = 0; row < 4; ++row) {
      CHECK(all[4 * k + row]["kind"] == kind);
      for (const char* name :
           {"result_hash", "field", "l2", "linf", "found", "integral_source", "integral_target"})
        CHECK(all[4 * k + row][name] == alone[row][name]);
    }
  }
}

TEST_CASE("a reference by radial basis functions is one more row", "[apps][study]") {
  const Scratch scratch;
  const Words reference{"--fields", "sin,linear", "--reference", "radial-basis"};
  const auto rows_of = [&](Words words) {
    words.insert(words.end(), reference.begin(), reference.end());
    return results_of(threads(2), words);
  };
  const nlohmann::json rows = rows_of({"kuhn:5@0.2", "kuhn:6"});
  REQUIRE(rows.size() == 4);
  const TetMesh source = kuhn_mesh({5, 0.2}), target = kuhn_mesh({6});
  const Formula sine = make_formula("sin", bounds(source));
  const std::vector<double> values =
      RadialBasis(source.points).values(sample(source, "sin", sine).values, 1, target.points);
  double largest = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    largest = std::max(largest, std::abs(values[i] - sine(target.points[i])));
  CHECK(rows[2]["kind"] == "radial-basis");
  CHECK(rows[2]["linf"].get<double>() == Approx(largest).epsilon(1e-12));
  CHECK(rows[2]["l2"].get<double>() < rows[0]["l2"].get<double>());
  CHECK(rows[2]["transfer_seconds"].get<double>() > 0);
  CHECK(rows[2]["integral_source"] == rows[0]["integral_source"]);
  CHECK(rows[3]["linf"].get<double>() < 1e-11);
  CHECK(rows_of({"kuhn:2", "kuhn:3", "--kind", "all"}).size() ==
        2 * (all_transfer_kinds.size() + 1));
  CHECK(rows_of({"kuhn:2,3", "--study", "h", "--policy", "keep", "--policy", "nearest", "--plot",
                 scratch.path("study")})
            .size() == 2 * 2 * 3);
}

TEST_CASE("the order of moving least squares can be chosen", "[apps][study]") {
  const auto error = [](const char* order) {
    return results_of(threads(1), {"kuhn:8@0.2", "kuhn:9", "--fields", "x^2+y*z", "--kind",
                                   "moving-least-squares", "--order", order})[0]["linf"]
        .get<double>();
  };
  CHECK(error("1") > 1e-3);
  CHECK(error("2") < 1e-12);
}

TEST_CASE("kind all leaves out the kinds that options do not fit", "[apps][study]") {
  const auto n_left_out = [](const Words& more) {
    Words words{"kuhn:2", "kuhn:3", "--kind", "all"};
    words.insert(words.end(), more.begin(), more.end());
    return all_transfer_kinds.size() - results_of(threads(1), words).size();
  };
  CHECK(n_left_out({"--clamp"}) == 3);             // those that conserve
  CHECK(n_left_out({"--tolerance", "0.1"}) == 4);  // and moving least squares
}

TEST_CASE("kind all is refused where one result is wanted", "[apps][study]") {
  const auto code = [&](const Words& more) {
    Words words{"kuhn:2", "kuhn:3", "--kind", "all"};
    words.insert(words.end(), more.begin(), more.end());
    return exit_code(threads(1), words);
  };
  CHECK(code({"--study", "steps"}) == 2);
  CHECK(code({"--study", "pes"}) == 2);
  CHECK(code({"--weights", "/tmp/never.nc"}) == 2);
}
