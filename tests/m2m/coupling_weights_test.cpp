// The weights of couplings against the couplings themselves.
#include "m2m/coupling_weights.hpp"

#include "apps/kit/worst.hpp"
#include "m2m/couple/row_book.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/m2m/field_values.hpp"
#include "tests/m2m/gathered.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

using namespace tess;
using namespace tess::m2m;
using tess::test::awkward_field, tess::test::bits_of, tess::test::Scratch;

namespace {

/// Two meshes that overlap in part; the vertices 0 to 63 of both coincide.
struct Weighed {
  TetMesh source = read_mesh("kuhn:5@0.2"), target = read_mesh("kuhn:6@0.1");
  Field field{};
  OutsidePolicy policy{};
  TransferKind kind = TransferKind::linear;
  std::int32_t n_source_parts = 3, n_target_parts = 4;

  Weighed() {
    target = test::moved_by(std::move(target), 1.1, -0.05);
    std::copy_n(source.points.begin(), 8, target.points.begin() + 60);
    field = awkward_field("f", source.n_points(), 2, 9);
    for (std::size_t i = 0; i < field.values.size(); ++i)
      field.values[i] = std::sin(static_cast<double>(i));
    field.values[0] = -0.0;
  }
};

/// The values of the target before a transfer.
constexpr double before = -7;

struct Moved {
  std::vector<double> values{};
  WeightMatrix weights{};
};

Task transfer_with_weights(const Weighed& c, Moved* result) {
  DistributedMesh source, target;
  const Field empty{"f", 2, std::vector<double>(2 * c.target.n_points(), before)};
  co_await epoch([&] {
    source = scatter(c.source, {c.field}, c.n_source_parts, PartitionMethod::rcb,
                     source_halo_layers(c.kind));
    target = scatter(c.target, {empty}, c.n_target_parts, PartitionMethod::rcb);
  });
  TransferOptions options;
  options.policy = c.policy;
  options.kind = c.kind;
  Transfer transfer(source, target, options);
  co_await transfer.search();
  result->weights =
      co_await collect_weights(transfer, static_cast<std::int64_t>(c.source.n_points()),
                               static_cast<std::int64_t>(c.target.n_points()));
  co_await transfer.apply();
  result->values = (co_await test::gathered(target)).values;
}

Moved run_case(const Weighed& c, std::int32_t n_pes) {
  Moved result;
  REQUIRE(tests::run_threads(n_pes, [&] { return transfer_with_weights(c, &result); }).exit_code ==
          0);
  // The same on a simulated machine that delays messages and migrates Workers.
  Moved again;
  SimulatedOptions options;
  options.n_pes = n_pes + 1;
  options.cost = Time(100);
  options.seed = static_cast<std::uint64_t>(n_pes);
  RuntimeOptions runtime_options;
  runtime_options.migration_chance = 0.02;
  Setup simulated{make_simulated_machine(options), runtime_options};
  REQUIRE(run(simulated, [&] { return transfer_with_weights(c, &again); }) == 0);
  CHECK(bits_of(again.values) == bits_of(result.values));
  CHECK(again.weights.rows.columns == result.weights.rows.columns);
  CHECK(bits_of(again.weights.rows.weights) == bits_of(result.weights.rows.weights));
  return result;
}

/// The values of the target by the weights, after a round trip through a file.
std::vector<double> by_weights(const Weighed& c, const WeightMatrix& weights) {
  const Scratch scratch;
  const std::string path = scratch.path("w.nc");
  write_weights(path, weights);
  const WeightMatrix read = read_weights(path);
  check_fits(read, path, c.source, c.target);
  std::vector<double> out(2 * c.target.n_points(), before);
  apply(read, c.field.values, 2, out);
  return out;
}

}  // namespace

TEST_CASE("weights from a file give the bits of the transfer", "[m2m][weights]") {
  for (const bool nearest : {false, true}) {
    Weighed c;
    if (nearest) c.policy = Nearest{};
    std::optional<WeightMatrix> first;
    for (const std::int32_t n_pes : {1, 3}) {
      CAPTURE(nearest, n_pes);
      c.n_source_parts = 2 * n_pes;
      const Moved result = run_case(c, n_pes);
      CHECK(bits_of(by_weights(c, result.weights)) == bits_of(result.values));
      const bool all_inside = std::none_of(result.values.begin(), result.values.end(),
                                           [](double v) { return v == before; });
      CHECK(all_inside == nearest);
      CHECK(result.weights.rows.columns_of(60).size() == 1);  // a common vertex
      CHECK(result.weights.rows.columns_of(60)[0] == 0);
      if (!first) first = result.weights;
      CHECK(result.weights.rows.begin == first->rows.begin);
      CHECK(result.weights.rows.columns == first->rows.columns);
      CHECK(bits_of(result.weights.rows.weights) == bits_of(first->rows.weights));
    }
  }
}

TEST_CASE("weights of second-order transfers give the values up to rounding", "[m2m][weights]") {
  Weighed c;
  c.kind = TransferKind::second_order;
  const Moved result = run_case(c, 2);
  const std::vector<double> out = by_weights(c, result.weights);
  double worst = 0;
  for (std::size_t i = 0; i < out.size(); ++i)
    kit::worsen(worst, std::abs(out[i] - result.values[i]));
  CHECK(worst < 1e-13);
  const Weighed linear;
  CHECK(by_weights(linear, run_case(linear, 2).weights) != out);
}

TEST_CASE("kinds whose values are no matrix times the source have no weights", "[m2m][weights]") {
  CHECK_THROWS_WITH(require_weights(TransferKind::limited, false),
                    Contains("kind limited has no weights"));
  CHECK_THROWS_WITH(require_weights(TransferKind::conservative, false),
                    Contains("kind conservative has no weights"));
  CHECK_THROWS_WITH(require_weights(TransferKind::linear, true), Contains("leave out clamp"));
}

TEST_CASE("rows over ids that are no numbering of vertices are refused", "[m2m][weights]") {
  const GlobalRows rows{{2, 0}, {1, 2}, {4, 1, 3}, {1.0, 0.5, 0.25}};
  const WeightMatrix matrix = matrix_of(rows, 5, 4);
  CHECK(matrix.rows.begin == std::vector<std::uint64_t>{0, 2, 2, 3, 3});
  CHECK(matrix.rows.columns == std::vector<VertexId>{1, 3, 4});
  CHECK_THROWS_WITH(matrix_of(rows, 4, 4),
                    Contains("source vertices with ids from 0 to 3, but one has the id 4"));
  CHECK_THROWS_WITH(matrix_of(rows, 5, 2),
                    Contains("target vertices with ids from 0 to 1, but one has the id 2"));
  CHECK_THROWS_WITH(matrix_of({{1, 1}, {0, 0}, {}, {}}, 5, 4),
                    Contains("two target vertices have the id 1"));
}
