// The sample of m2m/overset.hpp, compiled and run. tests/samples/check.py compares the text.
#include "m2m/overset.hpp"

#include "m2m/coupling.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_parts.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

double field_at(const Point& p) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2];
}

class Grid : public tess::Chare<Grid, tess::Index1>, public tess::m2m::Piece<Grid> {
 public:
  tess::m2m::MeshView mesh_view() const { return view_of(part_); }
  void cut(const tess::m2m::Wall& wall) { blanking_.cut(mesh_view(), {&wall, 1}, on_outer_); }
  std::span<const double> flags() const { return blanking_.flags(); }
  std::span<double> offered(CouplingId from) { return blanking_.offered(from); }
  void settle(CouplingId from, std::int32_t mesh_number) {
    blanking_.settle(mesh_view(), from, status(from), mesh_number);
  }
  // …
  void load(MeshPart part, const std::vector<std::uint8_t>& on_outer) {
    part_ = std::move(part);
    for (const GlobalId id : part_.point_ids) on_outer_.push_back(on_outer[std::size_t(id)]);
    for (const Point& p : part_.points) values_.push_back(field_at(p));
    taken_.assign(std::size_t(part_.n_owned), 0);
  }
  std::span<const double> values() const { return values_; }
  std::span<double> taken() { return taken_; }
  void report(Callback<BlankingReport> result) {
    contribute(JoinBlankingReports{}, blanking_.report(mesh_view()), std::move(result));
  }
  void check(Callback<double> worst) {
    double error = 0;
    for (std::size_t v = 0; v < taken_.size(); ++v)
      if (blanking_.iblank()[v] < 0)
        error = std::max(error, std::abs(taken_[v] - field_at(part_.points[v])));
    contribute(max, error, std::move(worst));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, part_, on_outer_, blanking_, values_, taken_);
  }

 private:
  MeshPart part_;
  std::vector<std::uint8_t> on_outer_;
  Blanking blanking_;
  std::vector<double> values_, taken_;
};

/// From 0.2 to 0.8, with a cavity from 0.4 to 0.6.
TetMesh box_around_box() {
  TetMesh mesh = kuhn_mesh({6});
  std::erase_if(mesh.tets, [&](const Tet& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](VertexId v) {
      const Point& p = mesh.points[std::size_t(v)];
      return std::all_of(p.begin(), p.end(), [](double x) { return std::abs(x - 0.5) < 0.2; });
    });
  });
  for (Point& p : mesh.points)
    for (double& x : p) x = 0.2 + 0.6 * x;
  return mesh;
}

ArrayProxy<Grid> place(const TetMesh& mesh, const std::vector<std::uint8_t>& on_outer) {
  const auto grids = create<Grid>(range(3));
  std::vector<MeshPart> parts = mesh_parts(mesh, 3, PartitionMethod::rcb, 1);
  for (std::int32_t k = 0; k < 3; ++k)
    grids[{k}].send<&Grid::load>(std::move(parts[std::size_t(k)]), on_outer);
  return grids;
}

struct OversetFindings {
  BlankingReport background, overset;
  double error = 1, overset_error = 1;
};

Task couple(OversetFindings& found) {
  const TetMesh big = kuhn_mesh({12}), small = box_around_box();
  const OversetBoundary boundary = overset_boundary(small);
  const Wall wall(small.points, boundary.wall);
  ArrayProxy<Grid> background, overset;
  co_await epoch([&] {
    background = place(big, std::vector<std::uint8_t>(big.n_points()));
    overset = place(small, boundary.on_outer);
  });
  tess::m2m::Coupling to_background(overset, background), to_overset(background, overset);
  co_await tess::epoch([&] {
    background.broadcast<&Grid::cut>(wall);
    overset.broadcast<&Grid::cut>(tess::m2m::Wall());
  });
  co_await to_background.search();
  co_await to_overset.search();
  co_await to_background.apply<&Grid::flags, &Grid::offered>();
  co_await to_overset.apply<&Grid::flags, &Grid::offered>();
  co_await tess::epoch([&] {
    background.broadcast<&Grid::settle>(to_background.id(), 2);
    overset.broadcast<&Grid::settle>(to_overset.id(), 1);
  });
  co_await to_background.apply<&Grid::values, &Grid::taken>();
  co_await to_overset.apply<&Grid::values, &Grid::taken>();

  Future<BlankingReport> of_background, of_overset;
  background.broadcast<&Grid::report>(of_background.callback());
  found.background = co_await of_background;
  overset.broadcast<&Grid::report>(of_overset.callback());
  found.overset = co_await of_overset;
  Future<double> worst, worst_overset;
  background.broadcast<&Grid::check>(worst.callback());
  found.error = co_await worst;
  overset.broadcast<&Grid::check>(worst_overset.callback());
  found.overset_error = co_await worst_overset;
}

}  // namespace

TEST_CASE("the sample of m2m/overset.hpp cuts a hole and fills both fringes", "[m2m][sample]") {
  Setup setup{make_threads_machine(2), {}};
  OversetFindings found;
  REQUIRE(run(setup, [&]() -> Task { return couple(found); }) == 0);
  CHECK(found.background.n_hole == 27);  // 5/12, 6/12 and 7/12 on each axis
  CHECK(found.background.n_fringe == 4 * 4 * 4 * 2 - 3 * 3 * 3 - 27);
  CHECK(found.background.n_orphans == 0);
  CHECK(found.overset.n_hole == 0);
  CHECK(found.overset.n_fringe == 7 * 7 * 7 - 5 * 5 * 5);
  CHECK(found.overset.n_orphans == 0);
  CHECK(found.error < 1e-13);
  CHECK(found.overset_error < 1e-13);
}
