// A field that cools on a mesh, and on a small one that moves through it. Both are in chares of the
// program, which balancers migrate. There are a search and two transfers in each step.
#include <cmath>
#include <m2m/coupling.hpp>
#include <m2m/kuhn.hpp>
#include <m2m/mesh_parts.hpp>
#include <runtime/balance.hpp>

using namespace tess::m2m;

double exact(const Point& p, int step) {
  return (1 + p[0] + 2 * p[1] - p[2]) * std::pow(0.5, step);
}

class Patch : public tess::Chare<Patch>, public Piece<Patch> {
 public:
  void load(const MeshPart& part) {
    mesh_ = part;
    for (const Point& p : mesh_.points) field_.push_back(exact(p, 0));
  }
  void cool() {
    for (double& value : field_) value /= 2;
  }
  void move(double by) {  // its values stay behind
    for (Point& p : mesh_.points) p[0] += by;
    field_.assign(field_.size(), 0);
  }
  void compare(int step, tess::Callback<double> worst) {
    double error = 0;
    for (std::size_t v = 0; v < field_.size(); ++v)
      error = std::max(error, std::abs(field_[v] - exact(mesh_.points[v], step)));
    contribute(tess::max, error, std::move(worst));
  }
  // What a coupling calls: the mesh, what the patch gives, and where it takes values, ghosts too.
  MeshView mesh_view() const {
    return {mesh_.points, mesh_.tets, mesh_.point_ids, mesh_.tet_ids, std::ssize(mesh_.points)};
  }
  std::span<const double> give() const { return field_; }
  std::span<double> take() { return field_; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh_, field_);
  }

 private:
  MeshPart mesh_;
  std::vector<double> field_;
};

tess::ArrayProxy<Patch> patches(int n, double low, double edge) {
  TetMesh mesh = kuhn_mesh({n});
  for (Point& p : mesh.points)
    for (double& x : p) x = low + edge * x;
  const auto array = tess::create<Patch>(tess::range(4));
  const auto parts = mesh_parts(mesh, 4, PartitionMethod::curve);
  for (int k = 0; k < 4; ++k) array[{k}].send<&Patch::load>(parts[static_cast<std::size_t>(k)]);
  return array;
}

tess::Task couple() {
  tess::ArrayProxy<Patch> large, small;
  co_await tess::epoch([&] { large = patches(6, 0, 1), small = patches(5, 0.2, 0.4); });
  const auto balancer = tess::start_balancing(large, {.strategy = "rotate"});
  co_await balancer.begin_phase();
  Coupling down(large, small), up(small, large);
  for (int step = 1; step <= 4; ++step) {
    co_await tess::epoch(
        [&] { large.broadcast<&Patch::cool>(), small.broadcast<&Patch::move>(0.05); });
    co_await down.search();
    co_await up.search();
    co_await down.apply<&Patch::give, &Patch::take>();
    co_await up.apply<&Patch::give, &Patch::take>();
    co_await balancer.round();
  }
  tess::Future<double> error;
  large.broadcast<&Patch::compare>(4, error.callback());
  tess::print("error below 1e-14: ", co_await error < 1e-14 ? "yes" : "no", "\n");
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, couple);
}
