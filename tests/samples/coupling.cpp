// The sample of m2m/coupling.hpp, compiled and run. tests/samples/check.py compares the text.
#include "m2m/coupling.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <vector>

using namespace tess;
using namespace tess::m2m;

namespace {

/// The unit cube from x = `low` on in n × n × n cubes of six tetrahedra, owned by one piece.
struct Slab {
  std::vector<Point> points;
  std::vector<Tet> tets;
  std::vector<GlobalId> point_ids, tet_ids;

  Slab(double low, int n, GlobalId first) {
    const auto at = [n](int x, int y, int z) { return (x * (n + 1) + y) * (n + 1) + z; };
    for (int x = 0; x <= n; ++x)
      for (int y = 0; y <= n; ++y)
        for (int z = 0; z <= n; ++z)
          points.push_back({low + double(x) / n, double(y) / n, double(z) / n});
    constexpr std::array<std::array<int, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y)
        for (int z = 0; z < n; ++z)
          for (const auto& order : orders) {
            std::array<int, 3> corner{x, y, z};
            Tet tet{at(x, y, z)};
            for (std::size_t step = 0; step < 3; ++step) {
              ++corner[static_cast<std::size_t>(order[step])];
              tet[step + 1] = at(corner[0], corner[1], corner[2]);
            }
            tets.push_back(tet);
          }
    for (std::size_t i = 0; i < points.size(); ++i)
      point_ids.push_back(first + static_cast<GlobalId>(i));
    for (std::size_t i = 0; i < tets.size(); ++i)
      tet_ids.push_back(first + static_cast<GlobalId>(i));
  }
  Slab() = default;
  [[nodiscard]] MeshView view() const {
    return {points, tets, point_ids, tet_ids, static_cast<std::int64_t>(points.size())};
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(points, tets, point_ids, tet_ids);
  }
};

double field_at(const Point& p, int step) {
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2] + step;
}

class Fluid : public tess::Chare<Fluid, tess::Index1>, public tess::m2m::Piece<Fluid> {
 public:
  tess::m2m::MeshView mesh_view() const { return mesh_.view(); }
  std::span<const double> temperature() const { return temperature_; }
  // …
  void make(int n) {
    mesh_ = Slab(index().x, n, index().x * 100000);
    step(0);
  }
  void step(int number) {
    temperature_.clear();
    for (const Point& p : mesh_.points) temperature_.push_back(field_at(p, number));
  }
  /// Gives without the main coroutine.
  void run(CouplingId id, int n_steps);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh_, temperature_);
  }

 private:
  Slab mesh_;
  std::vector<double> temperature_;
};

class Solid : public tess::Chare<Solid, tess::Index2>, public tess::m2m::Piece<Solid> {
 public:
  tess::m2m::MeshView mesh_view() const { return mesh_.view(); }
  std::span<double> heat() { return heat_; }
  void received(tess::m2m::CouplingId coupling) { n_outside_ += count_outside(coupling); }
  // …
  void make(int n) {
    mesh_ = Slab(0.25 + index().x * 0.5 + index().y, n, (index().x * 10 + index().y) * 100000);
    heat_.assign(mesh_.points.size(), 0);
  }
  /// Moves the mesh along x.
  void move(double way) {
    for (Point& p : mesh_.points) p[0] += way;
  }
  /// The largest error where the fluid is.
  void check(int number, Callback<double> worst) {
    double error = 0;
    for (std::size_t i = 0; i < heat_.size(); ++i)
      if (mesh_.points[i][0] >= 0 && mesh_.points[i][0] <= 2)
        error = std::max(error, std::abs(heat_[i] - field_at(mesh_.points[i], number)));
    contribute(max, error, std::move(worst));
  }
  void count(Callback<std::uint64_t> outside) {
    contribute(sum, std::exchange(n_outside_, 0), std::move(outside));
  }
  void count_rounds(Callback<std::uint64_t> rounds) {
    contribute(sum, n_rounds_, std::move(rounds));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh_, heat_, n_outside_, n_rounds_);
  }

 private:
  std::uint64_t count_outside(CouplingId coupling) {
    ++n_rounds_;
    std::uint64_t n = 0;
    for (const Status status : this->status(coupling)) n += status == Status::outside ? 1 : 0;
    return n;
  }
  Slab mesh_;
  std::vector<double> heat_;
  std::uint64_t n_outside_ = 0, n_rounds_ = 0;
};

void Fluid::run(CouplingId id, int n_steps) {
  for (int number = 1; number <= n_steps; ++number) {
    step(number);
    m2m_give<Solid, &Fluid::temperature, &Solid::heat>(id);
  }
}

struct Findings {
  double error = 1, moved_error = 1, alone_error = 1;
  std::uint64_t outside = 0, rounds = 0;
  Tally tally;
};

/// Two fluid pieces in 0 <= x <= 2, four solid ones in 0.25 <= x <= 2.75, two of them overlapping.
Task program(Findings& found) {
  const auto fluid = create<Fluid>(range(2));
  const auto solid = create<Solid>(range(2, 2));
  co_await epoch([&] {
    fluid.broadcast<&Fluid::make>(3);
    solid.broadcast<&Solid::make>(4);
  });
  tess::m2m::Coupling to_solid(fluid, solid);
  co_await to_solid.search();
  for (int step = 1; step <= 10; ++step) {
    co_await tess::epoch([&] { fluid.broadcast<&Fluid::step>(step); });
    co_await to_solid.apply<&Fluid::temperature, &Solid::heat>();
  }

  Future<double> worst;
  solid.broadcast<&Solid::check>(10, worst.callback());
  found.error = co_await worst;
  Future<std::uint64_t> outside;
  solid.broadcast<&Solid::count>(outside.callback());
  found.outside = co_await outside;

  co_await epoch([&] { solid.broadcast<&Solid::move>(-0.5); });
  const SearchSummary summary = co_await to_solid.search();
  found.tally = summary.tally;
  co_await to_solid.apply<&Fluid::temperature, &Solid::heat>();
  Future<double> worst_moved;
  solid.broadcast<&Solid::check>(10, worst_moved.callback());
  found.moved_error = co_await worst_moved;

  co_await epoch([&] { fluid.broadcast<&Fluid::run>(to_solid.id(), 20); });
  Future<double> worst_alone;
  solid.broadcast<&Solid::check>(20, worst_alone.callback());
  found.alone_error = co_await worst_alone;
  Future<std::uint64_t> rounds;
  solid.broadcast<&Solid::count_rounds>(rounds.callback());
  found.rounds = co_await rounds;
  co_await epoch([&] { to_solid.destroy(); });
}

void check_run(const auto& run_on_machine) {
  Findings found;
  run_on_machine([&]() -> Task { return program(found); });
  REQUIRE(found.error < 1e-13);
  REQUIRE(found.moved_error < 1e-13);
  REQUIRE(found.alone_error < 1e-13);
  REQUIRE(found.outside == 10 * (1 + 3) * 25);        // planes with x > 2 of two pieces
  REQUIRE(found.tally.count(Status::outside) == 50);  // x = -0.25 and x = 2.25
  REQUIRE(found.rounds == 4 * (10 + 1 + 20));
}

}  // namespace

TEST_CASE("the sample of m2m/coupling.hpp moves a linear field exactly between own chares",
          "[m2m][sample]") {
  Setup threads{make_threads_machine(2), {}};
  check_run([&](const auto& main) { REQUIRE(run(threads, main) == 0); });
}

TEST_CASE("own chares may migrate while they are coupled", "[m2m]") {
  test::for_seeds(1, 41, [](std::uint64_t seed) {
    const test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    check_run([&](const auto& main) { machine.run(main).require_success(); });
  });
}
