// Kinds of transfer through chares: the same bits for any number of parts, and their orders.
#include "apps/kit/worst.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/transfer.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/m2m/error_norms.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

using namespace tess;
using namespace tess::m2m;
using tess::test::error_norms;

namespace {

constexpr const char* smooth = "sin(3*x)*cos(2*y) + z^2*x";

struct KindCase {
  TransferKind kind{};
  int n = 4;
  std::int32_t n_parts = 1;
  std::string formula = smooth;
};

Task transfer_twice(const KindCase& c, std::vector<double>& values, double& error) {
  const TetMesh from = read_mesh(fmt::format("kuhn:{}@0.2", c.n));
  const TetMesh to = read_mesh(fmt::format("kuhn:{}", c.n + 1));
  const Formula formula = make_formula(c.formula, bounds(from));
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(from, {sample(from, "f", formula)}, c.n_parts, PartitionMethod::rcb,
                     source_halo_layers(c.kind));
    target = scatter(to, {{"f", 1, std::vector<double>(to.n_points())}}, c.n_parts + 1,
                     PartitionMethod::hsfc, target_halo_layers(c.kind));
  });
  Transfer transfer(source, target, {.kind = c.kind});
  co_await transfer.search();
  co_await transfer.apply();
  co_await transfer.apply();  // the second uses what the first prepared
  values = (co_await test::gathered(target)).values;
  error = error_norms(to, values, sample(to, "f", formula).values).l2;
}

struct KindResult {
  std::vector<double> values;
  double error = 0;
};

KindResult result_of(const KindCase& c, std::uint64_t seed) {
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  KindResult result;
  machine.run([&] { return transfer_twice(c, result.values, result.error); }).require_success();
  return result;
}

struct KindCut {
  TransferKind kind{};
  std::int32_t n_parts = 1;
  OutsidePolicy policy = Keep{};
};
Task transfer_linear(const TetMesh& from, const TetMesh& to, KindCut cut,
                     std::vector<double>& values, TransferSummary& summary) {
  Field field{"f", 1, {}};
  for (const Point& p : from.points) field.values.push_back(test::linear_at(p));
  DistributedMesh source, target;
  co_await epoch([&] {
    source =
        scatter(from, {field}, cut.n_parts, PartitionMethod::curve, source_halo_layers(cut.kind));
    target = scatter(to, {{"f", 1, std::vector<double>(to.n_points())}}, cut.n_parts,
                     PartitionMethod::curve, target_halo_layers(cut.kind));
  });
  summary = co_await transfer(source, target, {.policy = cut.policy, .kind = cut.kind});
  values = (co_await test::gathered(target)).values;
}
std::vector<double> linear_result(const TetMesh& from, const TetMesh& to, KindCut cut,
                                  std::uint64_t seed, Tally* tally = nullptr) {
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  std::vector<double> values;
  TransferSummary summary;
  machine.run([&] { return transfer_linear(from, to, cut, values, summary); }).require_success();
  if (tally != nullptr) *tally = summary.search.tally;
  return values;
}

}  // namespace

TEST_CASE("each kind gives the same bits for any number of parts and any schedule",
          "[m2m][kinds][one_thread]") {
  for (const TransferKind kind : all_transfer_kinds) {
    const KindResult one = result_of({kind}, 1);
    test::for_seeds(2, 2 + test::n_seeds(9), [&](std::uint64_t seed) {
      const KindCase c{kind, 4, static_cast<std::int32_t>(seed % 9) + 1};
      test::expect(result_of(c, seed).values == one.values, name_of(kind), " gives other bits");
    });
  }
}

TEST_CASE("a vertex that no tetrahedron uses is the nearest of no point", "[m2m][kinds]") {
  const TetMesh source = read_mesh("kuhn:1");
  TetMesh with_unused = source, target = read_mesh("kuhn:2");
  with_unused.points.push_back({2.4, 0.1, 0.2});
  for (Point& p : target.points) p[0] += 2.5;
  const auto want = linear_result(source, target, {TransferKind::nearest, 1}, 1);
  test::for_seeds(1, 8, [&](std::uint64_t seed) {
    // Of many parts most have no tetrahedron, and one of these has the vertex.
    const KindCut cut{TransferKind::nearest, static_cast<std::int32_t>(seed % 2 == 0 ? seed : 40)};
    test::expect(linear_result(with_unused, target, cut, seed) == want, "it gives its value");
  });
}

TEST_CASE("the nearest vertex gives its value outside, too, unless the policy is a value",
          "[m2m][kinds]") {
  const TetMesh source = read_mesh("kuhn:2");
  TetMesh target = read_mesh("kuhn:3");
  for (Point& p : target.points) p[0] += 0.6;
  const KindCut nearest{TransferKind::nearest, 3};
  const std::vector<double> all = linear_result(source, target, nearest, 1);
  test::for_seeds(1, 1 + test::n_seeds(8), [&](std::uint64_t seed) {
    const auto parts = static_cast<std::int32_t>(1 + seed % 5);
    const std::vector<double> some =
        linear_result(source, target, {TransferKind::nearest, parts, UseValue{-7}}, seed);
    for (std::size_t v = 0; v < all.size(); ++v)
      test::expect(some[v] == (target.points[v][0] > 1 ? -7 : all[v]), "vertex ", v, " has ",
                   some[v]);
  });
}

TEST_CASE("what a conservative source covers more than once is counted", "[m2m][kinds]") {
  const TetMesh source = read_mesh("kuhn:2"), target = read_mesh("kuhn:3@0.2");
  TetMesh doubled = source;
  doubled.tets.insert(doubled.tets.end(), source.tets.begin(), source.tets.begin() + 6);
  test::for_seeds(1, 1 + test::n_seeds(8), [&](std::uint64_t seed) {
    const KindCut cut{TransferKind::conservative, static_cast<std::int32_t>(1 + seed % 5)};
    Tally once, twice;
    (void)linear_result(source, target, cut, seed, &once);
    (void)linear_result(doubled, target, cut, seed, &twice);
    test::expect(once.n_overcovered == 0 && once.most_covered == 0, once.n_overcovered);
    test::expect(twice.n_overcovered > 0 && twice.n_overcovered < target.n_points() &&
                     twice.most_covered > 1.5 && twice.most_covered < 2 + 1e-12,
                 twice.n_overcovered, " up to ", twice.most_covered);
  });
}

TEST_CASE("what a conservative source covers up to four times has the same bits for any cut",
          "[m2m][kinds]") {
  const TetMesh source = read_mesh("kuhn:2@0.1"), target = read_mesh("kuhn:3@0.2");
  for (const int times : {2, 3, 4}) {
    TetMesh covering = source;
    for (int k = 1; k < times; ++k)
      covering.tets.insert(covering.tets.end(), source.tets.begin(), source.tets.end() - 12);
    const std::vector<double> one =
        linear_result(covering, target, {TransferKind::conservative, 1}, 1);
    test::for_seeds(2, 2 + test::n_seeds(8), [&](std::uint64_t seed) {
      const KindCut cut{TransferKind::conservative, static_cast<std::int32_t>(1 + seed % 5)};
      test::expect(linear_result(covering, target, cut, seed) == one, times, " times");
    });
  }
}

TEST_CASE("the error falls with the order of the kind", "[m2m][kinds][one_thread]") {
  const auto order = [](TransferKind kind) {
    return std::log2(result_of({kind, 6, 3}, 1).error / result_of({kind, 12, 3}, 1).error);
  };
  const double linear = order(TransferKind::linear), second = order(TransferKind::second_order);
  CHECK(linear > 1.8);
  CHECK(linear < 2.2);
  CHECK(second > 2.8);
  CHECK(order(TransferKind::conservative) > 1.9);
}

TEST_CASE("a limited transfer stays within the values of a step, a second-order one does not",
          "[m2m][kinds]") {
  const auto range = [](TransferKind kind) {
    const std::vector<double> values =
        result_of({kind, 8, 3, "(x - 0.4) / abs(x - 0.4)"}, 1).values;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return std::pair(*low, *high);
  };
  CHECK(range(TransferKind::limited) == std::pair(-1.0, 1.0));
  CHECK(range(TransferKind::second_order).second > 1.01);
}

TEST_CASE("every kind takes and gives values at the vertices of every type of element",
          "[m2m][kinds][one_thread]") {
  for (const ElementType from_type : test::all_element_types)
    for (const ElementType to_type : test::all_element_types) {
      const TetMesh from = test::element_mesh(from_type, 3), to = test::element_mesh(to_type, 4);
      for (const TransferKind kind : all_transfer_kinds) {
        INFO(name_of(kind) << " from " << from.name << " to " << to.name);
        const bool smooths =
            kind == TransferKind::nearest || kind == TransferKind::conservative_lumped;
        const std::vector<double> one = linear_result(from, to, {kind, 1}, 4);
        double error = 0;
        for (std::size_t v = 0; v < to.n_points(); ++v)
          kit::worsen(error, std::abs(one[v] - test::linear_at(to.points[v])));
        CHECK(error < (smooths ? (2 + 3 + 5) * 1.2 / 3 : 1e-12));
        CHECK(linear_result(from, to, {kind, 5}, 3) == one);
      }
    }
}
