// Fields in elements, moved by each kind between meshes of each type of element.
#include "m2m/cell_transfer.hpp"

#include "apps/kit/worst.hpp"
#include "runtime/core/error.hpp"
#include "runtime/here.hpp"
#include "runtime/more/testing.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

using namespace tess;
using namespace tess::m2m;
using tess::test::element_mesh;

namespace {

constexpr int source_bricks = 3, target_bricks = 4;

std::array<Point, 4> corners_at(const TetMesh& mesh, std::size_t tet) {
  std::array<Point, 4> out;
  for (std::size_t c = 0; c < 4; ++c)
    out[c] = mesh.points[static_cast<std::size_t>(mesh.tets[tet][c])];
  return out;
}
double volume_at(const TetMesh& mesh, std::size_t tet) {
  return std::abs(signed_volume(mesh, tet));
}
double mean_at(const TetMesh& mesh, std::size_t tet) {
  return test::linear_at(mean_of_corners(corners_at(mesh, tet)));
}

/// The means of a linear function over the elements.
Field cell_field(const TetMesh& mesh) {
  std::map<GlobalId, std::array<double, 2>> sums;
  const auto element = [&](std::size_t t) {
    return mesh.element_of_tet.empty() ? static_cast<GlobalId>(t) : mesh.element_of_tet[t];
  };
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    sums[element(t)][0] += volume_at(mesh, t) * mean_at(mesh, t);
    sums[element(t)][1] += volume_at(mesh, t);
  }
  Field field{"q", 2, {}};
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    const auto& [sum, all] = sums[element(t)];
    field.values.push_back(sum / all);
    field.values.push_back(-2 * sum / all);
  }
  return field;
}

double cell_integral(const TetMesh& mesh, const Field& field) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) sum += volume_at(mesh, t) * field.values[2 * t];
  return sum;
}

struct CellCase {
  TransferKind kind{};
  const TetMesh* source = nullptr;
  const TetMesh* target = nullptr;
  std::int32_t n_parts = 1;
  OutsidePolicy policy = Keep{};
};
CellOutcome moved_cells(const CellCase& c, std::uint64_t seed, const std::vector<Field>& fields) {
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
  CellOutcome outcome;
  machine
      .run([&]() -> Task {
        outcome =
            co_await transfer_cells(*c.source, fields, *c.target, c.n_parts, PartitionMethod::curve,
                                    {.policy = c.policy, .kind = c.kind});
      })
      .require_success();
  return outcome;
}
CellOutcome moved_cells(const CellCase& c, std::uint64_t seed) {
  return moved_cells(c, seed, {cell_field(*c.source)});
}

bool is_exact(TransferKind kind) {
  return kind == TransferKind::second_order || kind == TransferKind::conservative;
}

Task refused_cells(const TetMesh& mesh, TransferOptions options, std::string* message,
                   std::size_t* n_left) {
  const std::vector<Field> fields{cell_field(mesh)};
  const std::size_t before = n_collections();
  try {
    co_await transfer_cells(mesh, fields, mesh, 2, PartitionMethod::curve, options);
  } catch (const Error& error) {
    *message = error.what();
  }
  *n_left = n_collections() - before;
}

/// Options are looked at before anything is sent, so the arrays may have no elements.
Task search_with(CouplingOptions options) {
  const auto none = create<Worker>(sparse);
  Coupling<Worker, Worker> coupling(none, none, options);
  co_await coupling.search();
}

}  // namespace

TEST_CASE("kinds with gradients are exact for linear fields between all types of elements",
          "[m2m][cells][one_thread]") {
  for (const ElementType from : test::all_element_types)
    for (const ElementType to : test::all_element_types) {
      const TetMesh source = element_mesh(from, source_bricks),
                    target = element_mesh(to, target_bricks);
      const Field given = cell_field(source);
      const auto [low, high] = std::minmax_element(given.values.begin(), given.values.end());
      for (const TransferKind kind : all_transfer_kinds) {
        INFO(name_of(kind) << " from " << source.name << " to " << target.name);
        const CellOutcome found = moved_cells({kind, &source, &target, 3}, 3);
        const Field& got = found.fields.front();
        const auto n_outside =
            std::count(found.status.begin(), found.status.end(), Status::outside);
        CHECK(n_outside == (kind == TransferKind::nearest ? std::ssize(found.status) : 0));
        double error = 0;
        bool twice = true;
        for (std::size_t t = 0; t < target.n_tets(); ++t) {
          kit::worsen(error, std::abs(got.values[2 * t] - mean_at(target, t)));
          twice = twice && std::abs(got.values[2 * t + 1] + 2 * got.values[2 * t]) < 1e-13;
        }
        CHECK(twice);
        // The centroid of the cell that gives the value is at most a brick away along each axis.
        CHECK(error < (is_exact(kind) ? 2e-13 : (2 + 3 + 5) * 1.2 / source_bricks));
        if (is_conservative(kind))
          CHECK(std::abs(cell_integral(target, got) - cell_integral(source, given)) < 1e-13);
        if (kind == TransferKind::linear || kind == TransferKind::nearest) {
          // The value of some source cell, unchanged.
          CHECK(std::all_of(got.values.begin(), got.values.end(), [&](double value) {
            return std::find(given.values.begin(), given.values.end(), value) != given.values.end();
          }));
        } else if (!is_exact(kind) && kind != TransferKind::moving_least_squares) {
          CHECK(*std::min_element(got.values.begin(), got.values.end()) >= *low - 1e-13);
          CHECK(*std::max_element(got.values.begin(), got.values.end()) <= *high + 1e-13);
        }
      }
    }
}

TEST_CASE("limits leave linear fields as they are inside", "[m2m][cells]") {
  const TetMesh source = element_mesh(ElementType::hex8, 5);
  const TetMesh target = element_mesh(ElementType::tet4, 7);
  for (const TransferKind kind : {TransferKind::limited, TransferKind::conservative_bounded}) {
    const CellOutcome found = moved_cells({kind, &source, &target, 3}, 1);
    std::size_t n_inner = 0;
    double error = 0;
    for (std::size_t t = 0; t < target.n_tets(); ++t) {
      const std::array<Point, 4> at = corners_at(target, t);
      const bool inner = std::all_of(at.begin(), at.end(), [](const Point& p) {
        return std::all_of(p.begin(), p.end(), [](double x) { return x > 0.23 && x < 0.82; });
      });
      if (!inner) continue;
      ++n_inner;
      kit::worsen(error, std::abs(found.fields[0].values[2 * t] - mean_at(target, t)));
    }
    CHECK(n_inner > 100);
    CHECK(error < 1e-13);
  }
}

TEST_CASE("from a single layer of elements, flat up to rounding or curved, cells get near values",
          "[m2m][cells][one_thread]") {
  for (const test::Layer& layer : test::layers) {
    const TetMesh source = test::layer_mesh(20, layer.place),
                  target = test::layer_mesh(27, layer.place);
    Field field{"q", 1, {}};
    std::map<GlobalId, std::vector<std::size_t>> tets;
    for (std::size_t t = 0; t < source.n_tets(); ++t) tets[source.element_of_tet[t]].push_back(t);
    field.values.resize(source.n_tets());
    for (const auto& [element, its] : tets) {
      double mean = 0;
      for (const std::size_t t : its)
        mean += test::wave_at(mean_of_corners(corners_at(source, t)), layer.origin);
      for (const std::size_t t : its) field.values[t] = mean / static_cast<double>(its.size());
    }
    for (const TransferKind kind : {TransferKind::second_order, TransferKind::conservative}) {
      INFO(name_of(kind) << " between layers on a " << layer.name);
      const CellOutcome found = moved_cells({kind, &source, &target, 3}, 1, {field});
      double error = 0;
      std::size_t n_found = 0;
      for (std::size_t t = 0; t < target.n_tets(); ++t) {
        if (found.status[t] == Status::outside) continue;
        ++n_found;
        const double want = test::wave_at(mean_of_corners(corners_at(target, t)), layer.origin);
        kit::worsen(error, std::abs(found.fields[0].values[t] - want));
      }
      CHECK(n_found > target.n_tets() / 2);
      CHECK(error < 0.1);
    }
  }
}

TEST_CASE("without fields the cells get their status", "[m2m][cells]") {
  const TetMesh source = element_mesh(ElementType::hex8, source_bricks);
  TetMesh target = element_mesh(ElementType::tet4, target_bricks);
  for (Point& p : target.points) p[0] += 0.5;
  for (const TransferKind kind : all_transfer_kinds) {
    INFO(name_of(kind));
    const CellOutcome found = moved_cells({kind, &source, &target, 3}, 2, {});
    CHECK(found.fields.empty());
    CHECK(found.status == moved_cells({kind, &source, &target, 3}, 2).status);
  }
}

TEST_CASE("transfers of cells that are refused leave no pieces behind", "[m2m][cells]") {
  const TetMesh mesh = element_mesh(ElementType::wedge6, 2);
  const auto refusal = [&](TransferOptions options) {
    std::string message;
    std::size_t n_left = 1;
    const test::Machine machine{.pes = 2, .seed = 1};
    machine.run([&] { return refused_cells(mesh, options, &message, &n_left); }).require_success();
    CHECK(n_left == 0);
    return message;
  };
  CHECK_THAT(refusal({.kind = TransferKind::second_order, .tolerance = -1}),
             Contains("tolerance -1 is not a length"));
  CHECK_THAT(refusal({.kind = TransferKind::conservative, .clamp = true}),
             Contains("kind conservative has no donors"));
}

TEST_CASE("fields in elements get the same bits for any number of parts and any schedule",
          "[m2m][cells][one_thread]") {
  for (const ElementType type : test::all_element_types) {
    const TetMesh source = element_mesh(type, source_bricks);
    const TetMesh target = element_mesh(ElementType::hex8, target_bricks);
    for (const TransferKind kind : all_transfer_kinds) {
      const CellOutcome one = moved_cells({kind, &source, &target, 1}, 4);
      for (std::uint64_t seed = 1; seed < 4; ++seed) {
        const auto n_parts = static_cast<std::int32_t>(3 * seed);
        const CellOutcome found = moved_cells({kind, &source, &target, n_parts}, seed);
        test::expect(found.fields[0].values == one.fields[0].values && found.status == one.status,
                     name_of(kind), " gives other bits from ", source.name);
      }
    }
  }
}

TEST_CASE("cells outside follow the policy, and a policy without a nearest cell is refused",
          "[m2m][cells]") {
  const TetMesh source = element_mesh(ElementType::wedge6, source_bricks);
  TetMesh target = element_mesh(ElementType::hex8, target_bricks);
  for (Point& p : target.points) p[0] += 2;
  for (const TransferKind kind : {TransferKind::linear, TransferKind::conservative}) {
    const CellOutcome kept = moved_cells({kind, &source, &target, 2}, 1);
    CHECK(std::all_of(kept.fields[0].values.begin(), kept.fields[0].values.end(),
                      [](double value) { return value == 0; }));
    const CellOutcome given = moved_cells({kind, &source, &target, 2, UseValue{7}}, 1);
    CHECK(std::all_of(given.fields[0].values.begin(), given.fields[0].values.end(),
                      [](double value) { return value == 7; }));
    const std::vector<Field> fields{cell_field(source)};
    const std::string message = tests::error_of("pes=1,seed=1", [&] {
      return transfer_cells(source, fields, target, 2, PartitionMethod::curve,
                            {.policy = Nearest{}, .kind = kind});
    });
    CHECK_THAT(message, Contains(std::string("kind ") + name_of(kind) + " has no nearest cell"));
  }
  const CellOutcome nearest = moved_cells({TransferKind::nearest, &source, &target, 2}, 1);
  CHECK(*std::min_element(nearest.fields[0].values.begin(), nearest.fields[0].values.end()) != 0);
}

TEST_CASE("couplings refuse kinds and centrings that do not go together by name", "[m2m][cells]") {
  const auto refusal = [](TransferKind kind, Centring source, Centring target) {
    return tests::error_of("pes=1,seed=1", [=] {
      return search_with({.kind = kind, .source_values = source, .target_values = target});
    });
  };
  for (const TransferKind kind : {TransferKind::second_order, TransferKind::nearest})
    for (const Centring source : {Centring::cells, Centring::corners})
      CHECK_THAT(refusal(kind, source, Centring::nodes),
                 Contains(std::string("kind ") + name_of(kind) + " takes values at nodes") &&
                     Contains("choose linear, projection or a conservative kind"));
  for (const TransferKind kind : {TransferKind::linear, TransferKind::limited})
    CHECK_THAT(refusal(kind, Centring::nodes, Centring::cells),
               Contains(std::string("kind ") + name_of(kind) + " gives values at points") &&
                   Contains("centroids"));
  CHECK_THAT(refusal(TransferKind::conservative, Centring::nodes, Centring::corners),
             Contains("choose nodes or cells"));
}
