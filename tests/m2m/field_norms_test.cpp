// Norms and hashes by reductions, against the serial functions over the whole mesh.
#include "m2m/field_norms.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/transfer.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/error_norms.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

using namespace tess;
using namespace tess::m2m;
using tess::test::error_norms;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// What the reductions gave, and what all of it follows from.
struct Answer {
  std::vector<FieldNorms> norms;
  std::vector<std::uint64_t> hashes;  // of both fields, of each
  std::vector<Status> status;
  std::vector<std::vector<double>> values;
  std::string refusal;
};

struct Layout {
  std::int32_t n_parts = 1;
  PartitionMethod method = PartitionMethod::curve;
  std::int32_t halo = 0;
};

/// A target that a source covers in part, so that some of its vertices are outside.
TetMesh target_mesh() {
  TetMesh mesh = kuhn_mesh({7, 0.2});
  for (Point& p : mesh.points) p[0] += 0.3;
  return mesh;
}

/// Moves two fields, and measures them on the target.
Task measure(Layout layout, std::vector<double> second, std::vector<FormulaField> truth,
             Answer& answer) {
  const TetMesh a = kuhn_mesh({5, 0.1}), b = target_mesh();
  DistributedMesh from, to;
  co_await epoch([&] {
    from = scatter(a, {sample(a, "x*y", make_formula("x*y", {})), {"s", 1, second}}, 4,
                   PartitionMethod::curve);
    const std::vector<double> start(b.n_points(), 0.25);
    to = scatter(b, {{"p", 1, start}, {"q", 1, start}}, layout.n_parts, layout.method, layout.halo);
  });
  co_await transfer(from, to, {});
  const std::vector<RigidMotion> back{{.translation = {-0.1, 0, 0}}};
  try {
    answer.norms = co_await measure_norms(to, "the target", std::move(truth), back);
  } catch (const Error& error) {
    answer.refusal = error.what();
  }
  const auto n = static_cast<GlobalId>(b.n_points());
  const std::vector<std::vector<FieldColumns>> columns{
      scalar_columns(2), {{0, 1}}, {{1, 1}}, {{0, 2}}};
  for (const std::vector<FieldColumns>& some : columns)
    answer.hashes.push_back(co_await hash_values(to, n, some));
  const Outcome all = co_await test::gathered(to);
  answer.status = all.status;
  answer.values.resize(2);
  for (std::size_t i = 0; i < all.values.size(); ++i) answer.values[i % 2].push_back(all.values[i]);
}

std::vector<double> smooth_values() {
  const TetMesh a = kuhn_mesh({5, 0.1});
  return sample(a, "sin(3*z)", make_formula("sin(3*z)", {})).values;
}

Answer run_threads(int pes, const Layout& layout, const std::vector<double>& second,
                   const std::vector<FormulaField>& truth) {
  Answer answer;
  REQUIRE(tests::run_threads(pes, [&] {
            return measure(layout, second, truth, answer);
          }).exit_code == 0);
  return answer;
}

const std::vector<FormulaField> usual_truth{{"x*y", {}}, {"sin(3*z)", {}}};

void check_close(const ErrorNorms& found, const ErrorNorms& wanted) {
  CHECK(found.l2 == Approx(wanted.l2).epsilon(1e-12));
  CHECK(found.l2_relative == Approx(wanted.l2_relative).epsilon(1e-12));
  CHECK(found.rms == Approx(wanted.rms).epsilon(1e-12));
  CHECK(found.linf == wanted.linf);
  CHECK(found.worst == wanted.worst);
  CHECK(found.n_vertices == wanted.n_vertices);
}

std::vector<std::uint64_t> bits_of(const FieldNorms& n) {
  std::vector<std::uint64_t> out;
  for (const double x :
       {n.all.l2, n.all.l2_relative, n.all.rms, n.all.linf, n.found.l2, n.found.l2_relative,
        n.found.rms, n.found.linf, n.worst_at[0], n.worst_at[1], n.worst_at[2], n.integral, n.l2,
        n.truth_integral, n.truth_l2, n.truth_magnitude})
    out.push_back(std::bit_cast<std::uint64_t>(x));
  for (const auto k : {n.all.worst, n.found.worst}) out.push_back(static_cast<std::uint64_t>(k));
  return out;
}

}  // namespace

TEST_CASE("norms by reductions are those of the whole mesh", "[m2m][norms]") {
  const Answer answer = run_threads(2, {5}, smooth_values(), usual_truth);
  const TetMesh mesh = target_mesh();
  TetMesh there = mesh;
  move_points(there.points, {.translation = {-0.1, 0, 0}});
  std::vector<bool> found;
  std::size_t n_found = 0;
  for (const Status status : answer.status) {
    found.push_back(status != Status::outside);
    n_found += found.back() ? 1U : 0U;
  }
  REQUIRE(n_found > 0);
  REQUIRE(n_found < mesh.n_points());
  REQUIRE(answer.norms.size() == 2);
  for (std::size_t f = 0; f < 2; ++f) {
    const auto truth =
        sample(there, "t", make_formula(usual_truth[f].name, usual_truth[f].domain)).values;
    const FieldNorms& norms = answer.norms[f];
    check_close(norms.all, error_norms(mesh, answer.values[f], truth));
    check_close(norms.found, error_norms(mesh, answer.values[f], truth, found));
    CHECK(norms.worst_at == mesh.points[static_cast<std::size_t>(norms.all.worst)]);
    const std::vector<double> zero(truth.size(), 0.0);
    CHECK(norms.l2 == Approx(error_norms(mesh, answer.values[f], zero).l2).epsilon(1e-12));
    CHECK(norms.truth_l2 == Approx(error_norms(mesh, truth, zero).l2).epsilon(1e-12));
    double integral = 0, of_truth = 0, magnitude = 0;
    for (std::size_t t = 0; t < mesh.n_tets(); ++t)
      for (const VertexId corner : mesh.tets[t]) {
        const auto v = static_cast<std::size_t>(corner);
        const double quarter = std::abs(signed_volume(mesh, t)) / 4;
        integral += quarter * answer.values[f][v];
        of_truth += quarter * truth[v];
        magnitude += quarter * std::abs(truth[v]);
      }
    CHECK(norms.integral == Approx(integral).epsilon(1e-12));
    CHECK(norms.truth_integral == Approx(of_truth).epsilon(1e-12));
    CHECK(norms.truth_magnitude == Approx(magnitude).epsilon(1e-12));
  }
}

TEST_CASE("a hash by ranges is that of the values in order", "[m2m][norms]") {
  const Answer answer = run_threads(2, {3}, smooth_values(), usual_truth);
  CHECK(answer.hashes[0] == result_hash(answer.values[1], result_hash(answer.values[0])));
  CHECK(answer.hashes[1] == result_hash(answer.values[0]));
  CHECK(answer.hashes[2] == result_hash(answer.values[1]));
  std::vector<double> rows;
  for (std::size_t v = 0; v < answer.values[0].size(); ++v)
    rows.insert(rows.end(), {answer.values[0][v], answer.values[1][v]});
  CHECK(answer.hashes[3] == result_hash(rows));
}

TEST_CASE("norms and hashes have the same bits for any parts, PEs and order of messages",
          "[m2m][norms]") {
  const std::vector<double> second = smooth_values();
  const Answer first = run_threads(1, {1}, second, usual_truth);
  test::for_seeds(1, 13, [&](std::uint64_t seed) {
    Random random(seed);
    const Layout layout{1 + static_cast<std::int32_t>(random.below(20)),
                        random.chance(0.5) ? PartitionMethod::curve : PartitionMethod::rcb,
                        static_cast<std::int32_t>(random.below(3))};
    const test::Machine machine{.pes = 1 + static_cast<int>(random.below(9)), .seed = seed};
    Answer answer;
    machine.run([&] { return measure(layout, second, usual_truth, answer); }).require_success();
    for (std::size_t f = 0; f < 2; ++f)
      REQUIRE(bits_of(answer.norms[f]) == bits_of(first.norms[f]));
    REQUIRE(answer.hashes == first.hashes);
  });
}

TEST_CASE("a NaN is the largest error, at the first vertex that has one", "[m2m][norms]") {
  std::vector<double> second = smooth_values();
  second[100] = nan_value;
  const Answer answer = run_threads(2, {6}, second, usual_truth);
  const auto first = std::find_if(answer.values[1].begin(), answer.values[1].end(),
                                  [](double x) { return std::isnan(x); });
  REQUIRE(first != answer.values[1].end());
  const FieldNorms& norms = answer.norms[1];
  CHECK(std::isnan(norms.all.l2));
  CHECK(std::isnan(norms.all.linf));
  CHECK(norms.all.worst == first - answer.values[1].begin());
  CHECK(std::isfinite(answer.norms[0].all.l2));
}

TEST_CASE("a truth that is not finite is refused with its first vertex", "[m2m][norms]") {
  const std::vector<double> second = smooth_values();
  // The points move back by 0.1, to x from about 0.2 on.
  const Answer answer = run_threads(2, {4}, second, {{"x*y", {}}, {"sqrt(x - 0.25)", {}}});
  CHECK_THAT(answer.refusal, Contains("field sqrt(x - 0.25) is") && Contains("at vertex ") &&
                                 Contains("of the target"));
  CHECK(run_threads(1, {1}, second, {{"x*y", {}}, {"sqrt(x - 0.25)", {}}}).refusal ==
        answer.refusal);
  CHECK_THAT(run_threads(1, {1}, second, {{"x*y", {}}}).refusal,
             Contains("2 components, and 1 formulas"));
  CHECK_THAT(run_threads(1, {1}, second, {{"x*y", {}}, {"x*", {}}}).refusal, Contains("x*"));
}

TEST_CASE("of equal errors the first vertex is named, of bad truths the first component's",
          "[m2m][norms]") {
  std::vector<LargestError> errors{{1, 9}, {3, 7}, {3, 4}, {nan_value, 6}, {nan_value, 5}};
  std::vector<NotFinite> truths{{2, 1, nan_value}, {1, 8, nan_value}, {1, 6, nan_value}, {}};
  std::vector<std::size_t> order{0, 1, 2, 3, 4};
  do {
    LargestError all, numbers;
    NotFinite refused;
    for (const std::size_t i : order) {
      all.add(errors[i]);
      if (i < 3) numbers.add(errors[i]);
      if (i < truths.size()) refused.keep_first(truths[i]);
    }
    CHECK(all.vertex == 5);
    CHECK(numbers.vertex == 4);
    CHECK(refused.component == 1);
    CHECK(refused.vertex == 6);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("norms whose squares leave the range of double are NaN, not zero", "[m2m][norms]") {
  for (const double scale : {1e-170, 1e170}) {
    std::vector<double> second = smooth_values();
    for (double& x : second) x *= scale;
    const std::string formula = scale < 1 ? "1e-170*sin(3*z)" : "1e170*sin(3*z)";
    const Answer answer = run_threads(2, {6}, second, {{"x*y", {}}, {formula, {}}});
    const FieldNorms& norms = answer.norms.at(1);
    CAPTURE(scale);
    CHECK(norms.found.linf > 0);
    CHECK(norms.found.linf < scale);
    CHECK(std::isnan(norms.found.l2));
    CHECK(std::isnan(norms.found.l2_relative));
    CHECK(std::isnan(norms.found.rms));
    CHECK(answer.norms.at(0).found.l2 > 0);
  }
}
