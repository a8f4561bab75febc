// The step loop of particles against a distance/normal field, per particle and step: CSV rows as of
// the other benches, in picoseconds of processor time. A row is printed after its result was
// checked. "spread": particles all over the grid; "near": all within two voxels of the surface, the
// worst case.
//
//     bench_dn_field --pes 1 [--particles 1000000] [--repeat 5]
#include "apps/bench/report.hpp"
#include "apps/command_line.hpp"
#include "collide/dn_field/build_exact.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/shapes.hpp"
#include "collide/dn_field/stepper.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <ctime>
#include <random>

namespace bench {
namespace {

using namespace tess::dn;

constexpr int resolution = 60;
constexpr double step = 1e-3;
constexpr int n_steps = 32;
constexpr double half = 0.5;  // of the box

struct Options {
  std::size_t particles = 1'000'000;
  int repeat = 5;
};

/// The box, each triangle cut into n².
Surface cut_box(int n) {
  const Surface box = make_box({half, half, half});
  Surface cut;
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto [a, b, c] = box.corners(t);
    const auto at = [&, from = a, u = b - a, v = c - a](int i, int j) {
      cut.vertices.push_back(from + (1.0 * i / n) * u + (1.0 * j / n) * v);
      return static_cast<std::uint32_t>(cut.vertices.size() - 1);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto p = at(i, j), q = at(i + 1, j), r = at(i, j + 1);
        cut.triangles.push_back({p, q, r});
        if (i + j + 1 < n) cut.triangles.push_back({q, at(i + 1, j + 1), r});
      }
  }
  return welded(cut);
}

double box_distance(Vec3 p) {
  const Vec3 q{std::abs(p.x) - half, std::abs(p.y) - half, std::abs(p.z) - half};
  const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(outside) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

Particles placed(std::size_t count, double furthest) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const double reach = std::min(0.95, half + furthest);
  Particles particles;
  while (particles.size() < count) {
    const Vec3 x = reach * Vec3{anywhere(random), anywhere(random), anywhere(random)};
    const double distance = box_distance(x);
    if (distance > 1e-3 && distance < furthest)
      particles.push_back(x, 0.5 * Vec3{anywhere(random), anywhere(random), anywhere(random)});
  }
  return particles;
}

/// Processor time of this thread, so that other programs on the machine count less.
double cpu_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Time of `run` on a copy of `from`, per particle and step; leaves the last result in `end`.
template <class Run>
Samples measured(const Options& options, const Particles& from, Particles& end, const Run& run) {
  Samples samples;
  for (int i = 0; i < options.repeat; ++i) {
    end = from;
    const double begin = cpu_nanoseconds();
    run(end);
    samples.add(1e3 * (cpu_nanoseconds() - begin) / (n_steps * static_cast<double>(from.size())));
  }
  return samples;
}

void require(bool holds, const char* what) {
  if (!holds) tess::fail(tess::ErrorCode::bad_value, "benchmark: wrong result: ", what);
}

double loss(Particles& from, Particles& end) {
  return kinetic_energy(end.span()) / kinetic_energy(from.span()) - 1;
}

double deepest(const Particles& particles) {
  double depth = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    depth = std::max(depth, -box_distance(particles.position(p)));
  return depth;
}

Rules impact(LookUp look_up, Sweep sweep = Sweep::off) {
  Rules rules;
  rules.look_up = look_up;
  rules.impact = Impact{1, 0, sweep};
  return rules;
}

Rules all_rules(double cell) {
  Rules rules = impact(LookUp::nearest);
  rules.impact->restitution = 0.7;
  rules.spring = Spring{100, 1, cell};
  rules.surface_drag = SurfaceDrag{1, 2 * cell, DragLaw::linear};
  rules.surface_flow = SurfaceFlow{1, 1, 2 * cell};
  rules.gravity = Gravity{{0, 0, -1}};
  rules.wind = Wind{{0.1, 0, 0}, 0.1};
  rules.air_drag = AirDrag{0.1, DragLaw::linear};
  rules.explosions = {Explosion{{}, 0.5, 2, 0, 1}};
  return rules;
}

/// Gravity alone, as one would write it: the parabola.
void gravity_by_hand(const ParticleSpan& all, Vec3 g) {
  constexpr std::size_t block = 256;
  const Vec3 dv = step * g, half_dv = 0.5 * dv;
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    for (int i = 0; i < n_steps; ++i) {
#pragma GCC ivdep
      for (std::size_t p = 0; p < b.count; ++p) {
        b.x[p] += step * (b.vx[p] + half_dv.x);
        b.y[p] += step * (b.vy[p] + half_dv.y);
        b.z[p] += step * (b.vz[p] + half_dv.z);
        b.vx[p] += dv.x;
        b.vy[p] += dv.y;
        b.vz[p] += dv.z;
      }
    }
  }
}

/// Nearest look-up and impact of restitution 1, as one would write it.
void impact_by_hand(const ParticleSpan& all, const Field& field) {
  constexpr std::size_t block = 256;
  const Grid& g = field.grid;
  const double per_cell = 1 / g.cell;
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    for (int i = 0; i < n_steps; ++i)
      for (std::size_t p = 0; p < b.count; ++p) {
        const double u = (b.x[p] - g.origin.x) * per_cell + 0.5,
                     v = (b.y[p] - g.origin.y) * per_cell + 0.5,
                     w = (b.z[p] - g.origin.z) * per_cell + 0.5;
        double kick = 0, rest = 0;
        Normal n{};
        if (u >= 0 && v >= 0 && w >= 0 && u < g.n[0] && v < g.n[1] && w < g.n[2]) {
          const std::size_t at =
              g.index(static_cast<int>(u), static_cast<int>(v), static_cast<int>(w));
          const double d = static_cast<double>(field.distance[at]);
          const double speed2 = b.vx[p] * b.vx[p] + b.vy[p] * b.vy[p] + b.vz[p] * b.vz[p];
          if (d < 0 || d * d < step * step * speed2) {
            n = decode_normal(field.normal[at]);
            const double rise = b.vx[p] * static_cast<double>(n.x) +
                                b.vy[p] * static_cast<double>(n.y) +
                                b.vz[p] * static_cast<double>(n.z);
            if (rise < 0 && d + step * rise < 0) {
              kick = -2 * rise;
              rest = 1 - std::max(0.0, -d / (step * rise));
            }
          }
        }
        const double kx = kick * static_cast<double>(n.x), ky = kick * static_cast<double>(n.y),
                     kz = kick * static_cast<double>(n.z);
        b.x[p] += step * (b.vx[p] + rest * kx);
        b.y[p] += step * (b.vy[p] + rest * ky);
        b.z[p] += step * (b.vz[p] + rest * kz);
        b.vx[p] += kx, b.vy[p] += ky, b.vz[p] += kz;
      }
  }
}

void measure(const Report& report, const Options& options) {
  report.header();
  const Surface coarse = cut_box(1);
  const Field field = build_exact(coarse, grid_around(bounds(coarse), resolution, 0.45));
  const double cell = field.grid.cell;
  Particles spread = placed(options.particles, HUGE_VAL),
            near = placed(options.particles, 2 * cell);
  Particles end;
  const auto with = [&](const Rules& rules,
                        int steps_a_call = n_steps,
                        const Field* other = nullptr) {
    const Object met{other != nullptr ? other : &field, {}};
    return
        [&options, met, stepper = make_stepper(rules, step), steps_a_call](Particles& particles) {
          for (int i = 0; i < n_steps; i += steps_a_call)
            stepper.run(particles.span(), {&met, 1}, i * step, steps_a_call);
        };
  };
  const auto row = [&](const char* name, const Samples& samples, double reference = 0) {
    report.row(name, samples, "ps/particle/step", reference);
  };

  Samples samples = measured(options, spread, end, with({}));
  require(std::abs(end.x[0] - (spread.x[0] + n_steps * step * spread.vx[0])) < 1e-12,
          "free flight");
  row("dn none", samples, 800);
  samples = measured(options, spread, end, with({}, 1));
  row("dn none; one step a call", samples);

  const auto bounce = [&](const char* name,
                          Particles& from,
                          LookUp look_up,
                          Sweep sweep,
                          int steps_a_call,
                          double reference) {
    samples = measured(options, from, end, with(impact(look_up, sweep), steps_a_call));
    require(count_nonfinite(end.span()) == 0 && std::abs(loss(from, end)) < 1e-12, name);
    require(deepest(end) < (look_up == LookUp::nearest ? 0.9 : 0.1) * cell, name);
    row(name, samples, reference);
  };
  bounce("dn nearest + impact; spread", spread, LookUp::nearest, Sweep::off, n_steps, 3500);
  bounce(
      "dn nearest + impact; spread; one step a call", spread, LookUp::nearest, Sweep::off, 1, 3500);
  bounce("dn nearest + impact; near", near, LookUp::nearest, Sweep::off, n_steps, 3500);
  bounce("dn tangent + swept impact; spread", spread, LookUp::tangent, Sweep::on, n_steps, 0);
  bounce("dn tangent + swept impact; near", near, LookUp::tangent, Sweep::on, n_steps, 0);
  bounce("dn trilinear + impact; spread", spread, LookUp::trilinear, Sweep::off, n_steps, 0);
  bounce("dn trilinear + impact; near", near, LookUp::trilinear, Sweep::off, n_steps, 0);

  for (Particles* from : {&spread, &near}) {
    samples = measured(options, *from, end, with(all_rules(cell)));
    require(count_nonfinite(end.span()) == 0 && deepest(end) < 0.9 * cell, "all rules");
    row(from == &spread ? "dn all rules; spread" : "dn all rules; near", samples, 5500);
  }

  // One rule against the loop written by hand.
  Rules gravity;
  gravity.gravity = Gravity{{0.1, 0.2, -1}};
  Particles by_hand;
  Samples hand = measured(options, spread, by_hand, [](Particles& p) {
    gravity_by_hand(p.span(), {0.1, 0.2, -1});
  });
  samples = measured(options, spread, end, with(gravity));
  for (std::size_t p = 0; p < end.size(); p += 1000)
    require(norm(end.position(p) - by_hand.position(p)) < 1e-12, "gravity");
  row("dn gravity by hand", hand);
  row("dn gravity", samples, hand.median());
  for (Particles* from : {&spread, &near}) {
    hand =
        measured(options, *from, by_hand, [&](Particles& p) { impact_by_hand(p.span(), field); });
    samples = measured(options, *from, end, with(impact(LookUp::nearest)));
    std::size_t different = 0;  // a float's rounding can choose the voxel beside it
    for (std::size_t p = 0; p < end.size(); ++p)
      if (norm(end.position(p) - by_hand.position(p)) > 1e-5) ++different;
    require(different < end.size() / 1000, "impact by hand");
    const bool is_spread = from == &spread;
    row(is_spread ? "dn impact by hand; spread" : "dn impact by hand; near", hand);
    row(is_spread ? "dn impact; spread" : "dn impact; near", samples, hand.median());
  }

  // The number of triangles.
  double few = 0;
  for (const int cuts : {1, 10, 100}) {
    const Surface surface = cut_box(cuts);
    const Field built = build_exact(surface, field.grid);
    samples = measured(options, spread, end, with(impact(LookUp::nearest), n_steps, &built));
    require(std::abs(loss(spread, end)) < 1e-12, "triangles");
    if (few == 0) few = samples.least();
    row(tess::text("dn ", surface.triangles.size(), " triangles").c_str(), samples, few);
  }
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    tess::Setup setup = tess::take_options(argc, argv);
    bench::Options options;
    CLI::App app("The cost of a particle's step in a distance/normal field.");
    app.add_option("--particles", options.particles, "how many")
        ->check(CLI::Range(1000, 100'000'000));
    app.add_option("--repeat", options.repeat, "how often each is measured")
        ->check(CLI::Range(1, 1000));
    if (!apps::parse(app, argc, argv)) return 0;
    const std::string machine = setup.machine->describe();
    const bench::Report report(
        machine.substr(0, std::min(machine.find(';'), machine.find(" on "))));
    return tess::run(setup, [&] { bench::measure(report, options); });
  });
}
