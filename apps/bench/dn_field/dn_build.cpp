// The speed of building distance/normal fields and of lookups, and their memory, flat and
// compressed: CSV on standard output. Times are CPU times of the one thread that builds; on an idle
// machine they equal wall-clock times, and they hardly change when other programs run. The object
// is a torus of 70 688 triangles, whose distance is known: every figure is printed after its field
// was checked. If OpenVDB was found, its own rows are printed too, and its fastest time of this run
// is the limit of ours. Figures of other machines stand in apps/bench/results/.
//
//     bench_dn_build --repeat 5
#include "apps/bench/dn_field/openvdb_field.hpp"
#include "apps/bench/dn_field/thread_watch.hpp"
#include "apps/bench/report.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/shapes.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <fmt/core.h>
#include <numbers>
#include <random>

namespace bench {
namespace {

using namespace tess::dn;

constexpr double major_radius = 1, minor_radius = 0.4, margin = 0.15;
constexpr double band = 3;  // cells; OpenVDB's default

/// The options of one run, and its report.
struct Bench {
  Report& report;
  int repeat;
  Surface torus = make_torus(major_radius, minor_radius, 188);

  [[nodiscard]] Grid grid(int n) const { return grid_around(bounds(torus), n, margin); }
};

double torus_distance(Vec3 p) {
  return std::hypot(std::hypot(p.x, p.y) - major_radius, p.z) - minor_radius;
}

/// Checks that every distance within the band is the torus's, and that signs are right beyond it,
/// up to what the triangles cut off.
void check_exact(const Field& field) {
  constexpr double cut_off = 5e-4;  // 2 R (1 − cos(π / 188)) at the outer rim
  const Grid& g = field.grid;
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i) {
        const double truth = torus_distance(g.centre(i, j, k));
        const double wanted = std::clamp(truth, -field.thickness, field.thickness);
        const auto found = static_cast<double>(field.distance[g.index(i, j, k)]);
        TESS_CHECK(std::abs(found - wanted) < cut_off, "distance ", found, " at voxel ", i, ", ", j,
                   ", ", k, ", not ", wanted);
      }
}

/// Shows the milliseconds of `build` beside a limit of the same run (0: none); returns what it made
/// last. `least_ms` receives the fastest time.
template <class Build>
auto timed(const Bench& bench, const std::string& name, double limit, const Build& build,
           double* least_ms = nullptr) {
  Samples samples;
  auto made = build();  // the first run also fetches memory and code
  for (int k = 0; k < bench.repeat; ++k) {
    const ThreadWatch watch;
    made = build();
    samples.add(1e-6 * watch.nanoseconds());
  }
  bench.report.row(name, samples, "ms", limit);
  if (least_ms != nullptr) *least_ms = samples.least();
  return made;
}

void exact_rows(const Bench& bench) {
  for (const int n : {64, 128, 256}) {
    const Grid grid = bench.grid(n);
    const FieldOptions options{Sides::one, Content::distance_and_normal, band * grid.cell, {}};
    check_exact(build_field(bench.torus, grid, options));
    double openvdb_ms = 0;
    const auto by_openvdb = [&] { return OpenVdbField::build(bench.torus, grid, band); };
    if (by_openvdb()) {
      const auto made = timed(bench, fmt::format("OpenVDB level set {}^3 of 3 cells", n), 0,
                              by_openvdb, &openvdb_ms);
      TESS_CHECK(made->n_voxels() > 0, "OpenVDB made an empty grid");
    }
    timed(bench, fmt::format("exact field {}^3 of 3 cells", n), openvdb_ms,
          [&] { return build_field(bench.torus, grid, options); });
  }
  if (!OpenVdbField::build(bench.torus, bench.grid(8), 1))
    tess::print(
        "# OpenVDB's own rows are left out: libopenvdb-dev was not found when this was built\n");
}

/// A row of a mesh whose inside only the winding number determines; some signs are checked.
void damaged_row(const Bench& bench, const std::string& what, const Surface& surface) {
  const Grid grid = bench.grid(60);
  const FieldOptions options{Sides::one, Content::distance, band * grid.cell, {}};
  const Field field = timed(bench, "exact field 60^3 of 3 cells of " + what, 0,
                            [&] { return build_field(surface, grid, options); });
  const Bvh tree(surface);
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto voxel = [&](std::size_t a) {
      return static_cast<int>(random() % static_cast<unsigned>(grid.n[a]));
    };
    const int i = voxel(0), j = voxel(1), k = voxel(2);
    const double w = tree.winding_number(grid.centre(i, j, k), 0);
    TESS_CHECK(std::abs(w - 0.5) < 0.01 || (field.distance[grid.index(i, j, k)] < 0) == (w > 0.5),
               "sign at voxel ", i, ", ", j, ", ", k, " with winding number ", w);
  }
}

void other_rows(const Bench& bench) {
  const Grid grid = bench.grid(60);
  check_exact(timed(bench, "exact field 60^3 of all voxels", 0,
                    [&] { return build_field(bench.torus, grid); }));
  Surface open = bench.torus;
  open.triangles.resize(open.triangles.size() - 6000);
  damaged_row(bench, "an open mesh", open);
  Surface flipped = bench.torus;
  std::mt19937 random(1);
  for (auto& t : flipped.triangles)
    if (random() % 10 < 3) std::swap(t[0], t[1]);
  damaged_row(bench, "a mesh with 30 % of its triangles flipped", flipped);
  for (const auto& [method, name] :
       {std::pair{Method::normals, "normals"}, std::pair{Method::potential, "potential"}})
    check_exact(timed(bench, fmt::format("{} method 60^3 of 6 cells", name), 0, [&, m = method] {
      return build_field(bench.torus, grid,
                         {Sides::one, Content::distance_and_normal, 6 * grid.cell, m, {}});
    }));
}

/// Points around the object, in random order.
struct Cloud {
  std::vector<float> x, y, z;
  explicit Cloud(std::size_t n) : x(n), y(n), z(n) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> wide(-1.5F, 1.5F), flat(-0.5F, 0.5F);
    for (std::size_t p = 0; p < n; ++p)
      x[p] = wide(random), y[p] = wide(random), z[p] = flat(random);
  }
  [[nodiscard]] Points points() const { return {x, y, z}; }
};

template <class Run>
void look_up_row(const Bench& bench, const std::string& name, std::size_t n, const Run& run) {
  Samples samples;
  run();
  for (int k = 0; k < 4 * bench.repeat; ++k) {
    const ThreadWatch watch;
    run();
    samples.add(watch.nanoseconds() / static_cast<double>(n));
  }
  bench.report.row(name, samples, "ns");
}

void compressed_rows(const Bench& bench, int n) {
  const Grid grid = bench.grid(n);
  const Field flat = build_field(bench.torus, grid,
                                 {Sides::one, Content::distance_and_normal, band * grid.cell, {}});
  const ErrorBound bound{0.05 * grid.cell, 2 * std::numbers::pi / 180};
  const Field field =
      timed(bench, fmt::format("compression {}^3", n), 0, [&] { return compress(flat, bound); });
  const auto kilobytes = [&](const std::string& name, std::size_t bytes, double limit) {
    Samples samples;
    samples.add(1e-3 * static_cast<double>(bytes));
    bench.report.row(fmt::format("{} {}^3", name, n), samples, "kB", limit);
  };
  kilobytes("memory flat", flat.bytes(), 0);
  kilobytes("memory compressed", field.bytes(), 0.2e-3 * static_cast<double>(flat.bytes()));
  tess::print(
      fmt::format("# compressed {}^3: asked for {:.3f} cells and {:.2f} degrees, measured {:.3f} "
                  "and {:.2f}\n",
                  n, bound.distance / grid.cell, bound.angle * 180 / std::numbers::pi,
                  field.planes->measured.distance / grid.cell,
                  field.planes->measured.angle * 180 / std::numbers::pi));
  const std::size_t count = 1'000'000;
  const Cloud cloud(count);
  std::vector<float> expected(count), found(count), nx(count), ny(count), nz(count);
  look_up_row(bench, fmt::format("nearest distance flat {}^3", n), count, [&] {
    look_up(flat, LookUp::nearest, cloud.points(), {expected, {}, {}, {}});
  });
  look_up_row(bench, fmt::format("nearest distance compressed {}^3", n), count, [&] {
    look_up(field, LookUp::nearest, cloud.points(), {found, {}, {}, {}});
  });
  const auto allowed = static_cast<float>(bound.distance * (1 + 1e-5));
  for (std::size_t p = 0; p < count; ++p)
    TESS_CHECK(expected[p] == out_of_reach ? found[p] == out_of_reach
                                           : std::abs(found[p] - expected[p]) <= allowed,
               "compressed distance ", found[p], " of point ", p, ", flat ", expected[p]);
  look_up_row(bench, fmt::format("nearest distance and normal compressed {}^3", n), count, [&] {
    look_up(field, LookUp::nearest, cloud.points(), {found, nx, ny, nz});
  });
}

/// Our nearest and trilinear lookups and OpenVDB's, in turn, of points all over the grid; the
/// fastest of each is compared with the other: 25 % is allowed. None where OpenVDB was not found.
void look_up_beside_openvdb(const Bench& bench, const Grid& grid) {
  const auto theirs = OpenVdbField::build(bench.torus, grid, band);
  if (!theirs) return;
  const Field ours =
      build_field(bench.torus, grid, {Sides::one, Content::distance, band * grid.cell, {}});
  constexpr std::size_t count = 1'000'000;
  std::vector<float> x(count), y(count), z(count), our_distance(count), their_distance(count);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(0, 1);
  for (std::size_t p = 0; p < count; ++p) {
    const auto at = [&](int a) {
      return static_cast<float>(component(grid.origin, a) +
                                anywhere(random) * grid.cell *
                                    (grid.n[static_cast<std::size_t>(a)] - 1));
    };
    x[p] = at(0), y[p] = at(1), z[p] = at(2);
  }
  const Points points{x, y, z};
  for (const auto& [kind, name, apart] : {std::tuple{LookUp::nearest, "nearest", 1.74},
                                          std::tuple{LookUp::trilinear, "trilinear", 0.1}}) {
    Samples our_time, their_time, percent;
    for (int k = 0; k < 4 * bench.repeat; ++k) {
      const ThreadWatch our_watch;
      look_up(ours, kind, points, {our_distance, {}, {}, {}});
      our_time.add(our_watch.nanoseconds() / count);
      const ThreadWatch their_watch;
      theirs->look_up(kind, points, their_distance);
      their_time.add(their_watch.nanoseconds() / count);
    }
    percent.add(100 * our_time.least() / their_time.least());
    // Their voxels lie elsewhere: two nearest ones differ by up to a diagonal.
    const auto inner = static_cast<float>((band - 2) * grid.cell),
               allowed = static_cast<float>(apart * grid.cell);
    std::size_t compared = 0;
    for (std::size_t p = 0; p < count; ++p) {
      if (std::fabs(our_distance[p]) > inner) continue;
      ++compared;
      TESS_CHECK(std::fabs(our_distance[p] - their_distance[p]) < allowed, name, " distance ",
                 our_distance[p], " at point ", p, ", OpenVDB's ", their_distance[p]);
    }
    TESS_CHECK(compared > count / 100, "only ", compared, " points near the surface");
    const auto row = [&, n = grid.n[0], what = name](const char* whose, const Samples& samples,
                                                     const char* unit, double limit) {
      bench.report.row(fmt::format("{} distance {}^3{}", what, n, whose), samples, unit, limit);
    };
    row("; all over the grid", our_time, "ns", 0);
    row(" by OpenVDB", their_time, "ns", 0);
    row(" against OpenVDB", percent, "%", 25);
  }
}

void measure(const Bench& bench) {
  bench.report.header();
  exact_rows(bench);
  other_rows(bench);
  for (const int n : {60, 128}) compressed_rows(bench, n);
  for (const int n : {60, 128}) look_up_beside_openvdb(bench, bench.grid(n));
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    tess::Setup setup = tess::take_options(argc, argv);
    int repeat = 5;
    tess::CommandLine line(
        "The cost of building, compressing and looking up distance/normal fields.");
    line.option("--repeat", repeat, "how often each is measured").between(1, 1000);
    if (!line.parse(argc, argv)) return 0;
    bench::Report report({"one core"});
    return tess::run(setup, [&] { bench::measure({report, repeat}); });
  });
}
