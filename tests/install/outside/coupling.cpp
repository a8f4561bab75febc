// A field that cools on a mesh, and on a small one that moves through it. Both are in chares of the
// program, which balancers migrate. There are a search and two transfers in each step.
#include <cmath>
#include <m2m/coupling.hpp>
#include <m2m/kuhn.hpp>
#include <m2m/mesh_piece.hpp>
#include <runtime/balance.hpp>

using namespace tess::m2m;

double exact(const Point& p, int step) {
  return (1 + p[0] + 2 * p[1] - p[2]) * std::pow(0.5, step);
}

struct Patch : tess::Chare<Patch>, MeshPiece<Patch> {
  void loaded() {
    for (const Point& p : mesh.points) field.push_back(exact(p, 0));
  }
  void cool() {
    for (double& value : field) value /= 2;
  }
  void move(double by) {  // its values stay behind
    for (Point& p : mesh.points) p[0] += by;
    field.assign(field.size(), 0);
  }
  void compare(int step, tess::Callback<double> worst) {
    double error = 0;
    for (std::size_t v = 0; v < field.size(); ++v)
      error = std::max(error, std::abs(field[v] - exact(mesh.points[v], step)));
    contribute(tess::max, error, std::move(worst));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, field);
  }
  std::vector<double> field;
};

tess::ArrayProxy<Patch> patches(int n, double low, double edge) {
  TetMesh mesh = kuhn_mesh({n});
  for (Point& p : mesh.points)
    for (double& x : p) x = low + edge * x;
  return create_pieces<Patch>(mesh, 4);
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
    co_await down.apply<&Patch::field, &Patch::field>();
    co_await up.apply<&Patch::field, &Patch::field>();
    co_await balancer.round();
  }
  tess::print("error below 1e-14: ",
              co_await large.reduce<&Patch::compare>(4) < 1e-14 ? "yes" : "no", "\n");
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, couple);
}
