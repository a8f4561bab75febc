#include "apps/bench/dn_field/openvdb_look_up.hpp"

#include "apps/bench/dn_field/openvdb_field.hpp"
#include "apps/bench/dn_field/thread_watch.hpp"
#include "collide/dn_field/build_field.hpp"
#include "runtime/core/check.hpp"

#include <fmt/core.h>
#include <random>

namespace bench {

using namespace tess::dn;

void look_up_beside_openvdb(Report& report, const Surface& surface, const Grid& grid,
                            double half_width, int repeat) {
  const auto theirs = OpenVdbField::build(surface, grid, half_width);
  if (!theirs) return;
  const Field ours =
      build_field(surface, grid, {Sides::one, Content::distance, half_width * grid.cell, {}});
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
    for (int k = 0; k < 4 * repeat; ++k) {
      const ThreadWatch our_watch;
      look_up(ours, kind, points, {our_distance, {}, {}, {}});
      our_time.add(our_watch.nanoseconds() / count);
      const ThreadWatch their_watch;
      theirs->look_up(kind, points, their_distance);
      their_time.add(their_watch.nanoseconds() / count);
    }
    percent.add(100 * our_time.least() / their_time.least());
    // Their voxels lie elsewhere: two nearest ones differ by up to a diagonal.
    const auto inner = static_cast<float>((half_width - 2) * grid.cell),
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
      report.row(fmt::format("{} distance {}^3{}", what, n, whose), samples, unit, limit);
    };
    row("; all over the grid", our_time, "ns", 0);
    row(" by OpenVDB", their_time, "ns", 0);
    row(" against OpenVDB", percent, "%", 25);
  }
}

}  // namespace bench
