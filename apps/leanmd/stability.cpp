#include "apps/leanmd/stability.hpp"

#include "apps/leanmd/simulation.hpp"

#include <string>
#include <vector>

namespace leanmd {
namespace {

struct Case {
  std::string name;
  Options options;
  std::vector<Atom> atoms;
  double most_drift = 0;
  std::string expected{};
};

Options base(double edge, std::array<std::int32_t, 3> cells, double dt = 0.002) {
  Options options;
  options.problem.box = {edge, cells};
  options.problem.dt = dt;
  options.n_steps = 60;
  options.check = options.reverse = true;
  return options;
}

std::vector<Atom> random_atoms(const Options& options, std::int32_t n) {
  const Problem& p = options.problem;
  return initial_atoms({.n_atoms = n, .edge = p.box.edge}, Motion(p.box.edge, p.dt));
}

/// side³ atoms at rest, `spacing` apart, from the corner of the box on.
std::vector<Atom> cube(const Options& options, int side, double spacing) {
  const auto place = [&](int i) {
    return static_cast<std::uint64_t>((i + 0.5) * spacing / options.problem.box.edge * 0x1p64);
  };
  std::vector<Atom> atoms;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z)
        atoms.push_back(
            {static_cast<std::int64_t>(atoms.size()), {place(x), place(y), place(z)}, {}});
  return atoms;
}

/// Two atoms that meet head-on across the border of the box.
std::vector<Atom> collision(const Options& options, double speed) {
  std::vector<Atom> atoms = cube(options, 2, 1);
  atoms.resize(2);
  const Motion motion(options.problem.box.edge, options.problem.dt);
  const std::int64_t v = motion.velocity(speed);
  atoms[0] = {0, {0x08ULL << 56U, 1ULL << 63U, 1ULL << 63U}, {-v, 0, 0}};
  atoms[1] = {1, {0xf8ULL << 56U, 1ULL << 63U, 1ULL << 63U}, {v, 0, 0}};
  return atoms;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](std::string name, const Options& options, std::vector<Atom> atoms,
                       double most_drift, std::string expected = {}) {
    all.push_back({std::move(name), options, std::move(atoms), most_drift, std::move(expected)});
  };
  const Options cells3 = base(9, {3, 3, 3});
  add("a liquid", cells3, random_atoms(cells3, 400), 2e-3);
  Options now = base(9, {1, 1, 1});
  add("one cell", now, random_atoms(now, 400), 2e-3);
  now = base(9, {2, 1, 5});
  add("cells of different edges, fewer than three", now, random_atoms(now, 400), 2e-3);
  now = base(9, {5, 5, 5});
  now.n_steps = 20;
  add("cutoff larger than a cell", now, random_atoms(now, 400), 2e-3);
  now.problem.cutoff = 4.5;
  now.problem.skin = 0.2;
  add("cutoff of half the box", now, random_atoms(now, 400), 2e-3);
  now = base(10, {5, 5, 5});
  add("empty cells", now, random_atoms(now, 60), 2e-3);
  now = base(40, {4, 4, 4});
  add("all atoms in one cell", now, cube(now, 4, 1.1), 2e-3);
  add("one atom", cells3, random_atoms(cells3, 1), 0);
  add("no force: atoms out of reach", now, cube(now, 2, 20), 0);
  now = base(16, {2, 2, 2}, 1e-4);
  now.n_steps = 1500;
  now.problem.exchange_every = 20;
  add("head-on across the border, speed 20", now, collision(now, 20), 1);
  now = base(9, {3, 3, 3}, 5e-5);
  add("overlap 0.8: force 873", now, cube(now, 6, 0.8), 1e-2);
  now = base(9, {3, 3, 3}, 1e-5);
  add("overlap 0.6: force 36 700", now, cube(now, 6, 0.6), 1);
  add("least time step", base(9, {3, 3, 3}, least_dt),
      random_atoms(base(9, {3, 3, 3}, least_dt), 400), 1e-6);

  now = base(9, {3, 3, 3});
  add("overlap 0.6, dt too large", now, cube(now, 6, 0.6), 0, "half of --skin");
  add("overlap 0.4", now, cube(now, 6, 0.4), 0, "closer than");
  add("all atoms in one place", now, cube(now, 4, 0), 0, "closer than 0.4637");
  now.problem.dt = 0.1;
  add("time step 0.1", now, random_atoms(now, 400), 0, "half of --skin");
  now.problem.exchange_every = 1;
  add("time step 0.1, an exchange per step", now, random_atoms(now, 400), 0, "--dt 0.1");
  now.problem.dt = 0.03;
  add("time step 0.03, an exchange per step", now, random_atoms(now, 400), 0, "unstable until");
  now.problem.dt = 1e-3;
  add("head-on, speed 3500: a cell per step", now, collision(now, 3500), 0, "too fast");
  now = base(9, {3, 3, 3});
  now.problem.skin = 0;
  add("no skin", now, random_atoms(now, 400), 0, "half of --skin 0");
  now.problem.exchange_every = 1;
  add("no skin, an exchange per step", now, random_atoms(now, 400), 2e-3);
  return all;
}

}  // namespace

tess::Task stability_report(kit::Cases<>& report) {
  for (Case& one : cases()) {
    kit::Case row{
        .name = one.name, .parameter = "atoms", .value = static_cast<double>(one.atoms.size())};
    Outcome outcome;
    co_await simulate(one.options, std::move(one.atoms), outcome);
    row.note = outcome.error;
    if (one.expected.empty()) {
      row.met = outcome.drift();
      row.tolerance = one.most_drift;
      row.ok = row.note.empty() && outcome.drift() <= one.most_drift;
    } else {
      row.ok = row.note.find(one.expected) != std::string::npos;
    }
    report.add(std::move(row));
  }
}

}  // namespace leanmd
