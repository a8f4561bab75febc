// Conservative couplings between own chares, with values at nodes and in cells.
#include "m2m/couple/point_directory.hpp"
#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh/partition/partition.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "runtime/core/error.hpp"
#include "runtime/more/testing.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

double field_at(const Point& p, int step) {
  return std::sin(3 * p[0]) * std::cos(2 * p[1]) + p[2] * step;
}

using ValueOf = std::map<GlobalId, double>;
struct JoinValues {
  ValueOf operator()(ValueOf a, const ValueOf& b) const {
    a.insert(b.begin(), b.end());
    return a;
  }
};

class Body : public Chare<Body, Index1>, public Piece<Body> {
 public:
  void load(MeshPart part) {
    part_ = std::move(part);
    result_.assign(static_cast<std::size_t>(part_.n_owned), -7);
    cell_result_.assign(static_cast<std::size_t>(part_.n_own_tets), -7);
    step(0);
  }
  MeshView mesh_view() const {
    return {part_.points,  part_.tets,    part_.point_ids,
            part_.tet_ids, part_.n_owned, part_.n_own_tets};
  }
  void step(int number) {
    nodes_.clear();
    for (const Point& p : part_.points) nodes_.push_back(field_at(p, number));
    cells_.clear();
    for (const Tet& tet : part_.tets) {
      double mean = 0;
      for (const VertexId v : tet) mean += nodes_[static_cast<std::size_t>(v)] / 4;
      cells_.push_back(mean);
    }
  }
  std::span<const double> nodes() const { return nodes_; }
  std::span<const double> cells() const { return cells_; }
  std::span<double> result() { return result_; }
  std::span<double> cell_result() { return cell_result_; }
  void received(CouplingId /*coupling*/) { ++n_rounds_; }

  /// Gives several rounds without the main coroutine.
  void run(CouplingId id, int n_steps) {
    for (int number = 1; number <= n_steps; ++number) {
      step(number);
      m2m_give<Body, &Body::nodes, &Body::result>(id);
    }
  }
  void gather(const Callback<ValueOf>& target) {
    ValueOf all;
    for (std::size_t v = 0; v < result_.size(); ++v) all[part_.point_ids[v]] = result_[v];
    contribute(JoinValues{}, std::move(all), target);
  }
  void gather_cells(const Callback<ValueOf>& target) {
    ValueOf all;
    for (std::size_t t = 0; t < cell_result_.size(); ++t) all[part_.tet_ids[t]] = cell_result_[t];
    contribute(JoinValues{}, std::move(all), target);
  }
  void count(const Callback<int>& rounds) { contribute(sum, n_rounds_, rounds); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, nodes_, cells_, result_, cell_result_, n_rounds_);
  }

 private:
  MeshPart part_;
  std::vector<double> nodes_, cells_, result_, cell_result_;
  int n_rounds_ = 0;
};

struct Cut {
  std::int32_t n_source = 1, n_target = 1;  // parts
  std::int32_t halo = 1;
  double reach = 1;  // the source covers x < reach
};
struct Transferred {
  ValueOf nodes, cells_of_nodes, nodes_of_cells, late;
  Tally tally;
  int rounds = 0;
};

TetMesh source_mesh(double reach) {
  TetMesh mesh = kuhn_mesh({4, 0.2});
  for (Point& p : mesh.points) p[0] *= reach;
  return mesh;
}

ArrayProxy<Body> bodies(const TetMesh& mesh, std::int32_t n_parts, std::int32_t halo) {
  const auto array = create<Body>(range(n_parts));
  auto parts = split(mesh, partition(mesh, n_parts, PartitionMethod::rcb), n_parts, halo);
  for (std::int32_t k = 0; k < n_parts; ++k)
    array[{k}].send<&Body::load>(std::move(parts[static_cast<std::size_t>(k)]));
  return array;
}

Task transfers(Cut c, Transferred& found) {
  ArrayProxy<Body> source, target;
  co_await epoch([&] {
    source = bodies(source_mesh(c.reach), c.n_source, 0);
    target = bodies(kuhn_mesh({5, 0.1}), c.n_target, c.halo);
  });
  CouplingOptions options;
  options.kind = TransferKind::conservative_bounded;
  Coupling nodes(source, target, options);
  found.tally = (co_await nodes.search()).tally;
  // Other couplings between the same pieces, at the same time.
  options.kind = TransferKind::conservative;
  options.target_values = Centring::cells;
  Coupling to_cells(source, target, options);
  options.source_values = Centring::cells;
  options.target_values = Centring::nodes;
  Coupling from_cells(source, target, options);
  auto first = to_cells.search(), second = from_cells.search();
  co_await first;
  co_await second;

  co_await nodes.apply<&Body::nodes, &Body::result>();
  found.nodes = co_await target.reduce<&Body::gather>();
  Task third = to_cells.apply<&Body::nodes, &Body::cell_result>();
  Task fourth = from_cells.apply<&Body::cells, &Body::result>();
  co_await third;
  co_await fourth;
  found.cells_of_nodes = co_await target.reduce<&Body::gather_cells>();
  found.nodes_of_cells = co_await target.reduce<&Body::gather>();

  co_await epoch([&] { source.broadcast<&Body::run>(nodes.id(), 5); });
  found.late = co_await target.reduce<&Body::gather>();
  found.rounds = co_await target.reduce<&Body::count>();
  co_await epoch([&] {
    nodes.destroy();
    to_cells.destroy();
    from_cells.destroy();
  });
}

Transferred transferred(const Cut& c, std::uint64_t seed) {
  const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
  Transferred found;
  machine.run([&] { return transfers(c, found); }).require_success();
  return found;
}

/// The integral of values at the nodes of the target, of the source's nodes otherwise.
double integral(const TetMesh& mesh, const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    for (const VertexId v : mesh.tets[t])
      sum += signed_volume(mesh, t) / 4 * values[static_cast<std::size_t>(v)];
  return sum;
}

std::vector<double> in_order(const ValueOf& values) {
  std::vector<double> out;
  for (const auto& [id, value] : values) out.push_back(value);
  return out;
}

}  // namespace

TEST_CASE("own chares transfer conservatively with the same bits however they are cut and moved",
          "[m2m][conservative][one_thread]") {
  for (const double reach : {1.0, 0.55}) {
    const Transferred one = transferred({1, 1, 0, reach}, 1);
    CHECK(one.rounds == 3 + 5);
    INFO("reach " << reach);
    test::for_seeds(2, 2 + test::n_seeds(24), [&](std::uint64_t seed) {
      const auto n_source = static_cast<std::int32_t>(1 + seed % 4);
      const auto n_target = static_cast<std::int32_t>(1 + seed % 6);
      const Transferred found = transferred({n_source, n_target, 1 + (seed % 2 == 0), reach}, seed);
      const bool same = found.nodes == one.nodes && found.cells_of_nodes == one.cells_of_nodes &&
                        found.nodes_of_cells == one.nodes_of_cells && found.late == one.late &&
                        found.tally.counts == one.tally.counts;
      REQUIRE(same);
      REQUIRE(found.rounds == n_target * (3 + 5));  // pieces that nothing overlaps, too
    });
  }
}

TEST_CASE("a conservative coupling keeps the integral, from nodes to cells too",
          "[m2m][conservative]") {
  const Transferred found = transferred({3, 4, 1, 1}, 5);
  const TetMesh source = source_mesh(1), target = kuhn_mesh({5, 0.1});
  std::vector<double> values;
  for (const Point& p : source.points) values.push_back(field_at(p, 0));
  const double want = integral(source, values);
  CHECK(std::abs(integral(target, in_order(found.nodes)) - want) < 1e-14);
  CHECK(std::abs(integral(target, in_order(found.nodes_of_cells)) - want) < 1e-14);
  double cells = 0;
  for (const auto& [id, value] : found.cells_of_nodes)
    cells += value * signed_volume(target, static_cast<std::size_t>(id));
  CHECK(std::abs(cells - want) < 1e-14);
}

TEST_CASE("what the source does not cover keeps its value, and is counted", "[m2m][conservative]") {
  const Transferred found = transferred({2, 3, 1, 0.55}, 3);
  const TetMesh target = kuhn_mesh({5, 0.1});
  std::uint64_t n_kept = 0;
  for (const auto& [id, value] : found.nodes) {
    n_kept += value == -7 ? 1 : 0;
    if (target.points[static_cast<std::size_t>(id)][0] < 0.55) CHECK(value != -7);
    if (target.points[static_cast<std::size_t>(id)][0] > 0.83) CHECK(value == -7);
  }
  CHECK(n_kept == found.tally.count(Status::outside));
  CHECK(found.tally.count(Status::snapped) > 0);
  CHECK(found.tally.count(Status::inside) > 0);
}

TEST_CASE("a piece that lacks tetrahedra, a point of two owners and a ghost of none are refused",
          "[m2m][conservative]") {
  const auto refusal = [](std::vector<PointReport> reports) {
    return test::message_of([&] { (void)compare(std::move(reports)); });
  };
  const collide::OwnerId a{1}, b{2};
  const PointReport owner{17, a, 0, 4, 6, 1.0}, ghost{17, b, 5, 2, -1, 0};
  CHECK_THAT(refusal({{17, b, 5, 3, -1, 0}, owner}), Contains("6 of the 7 tetrahedra around it"));
  CHECK_THAT(refusal({owner, {17, b, 5, 2, 2, 1.0}}), Contains("owned by two pieces"));
  CHECK_THAT(refusal({ghost}), Contains("no piece owns it"));
}
