// Serial collision of the specification's scenes: nanoseconds per object, median of several runs.
// Each count of pairs is checked against another method on another grid before it is printed.
//
//     bench_collide_serial [RUNS]
#include "collide/collide_serial.hpp"

#include "collide/triangle.hpp"
#include "collide/voxel_size.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/core.h>
#include <numbers>
#include <random>

using namespace tess::collide;

namespace {

using Items = std::vector<Item>;

void add(Items& items, const Aabb& box, std::uint32_t model) {
  items.push_back(
      {box, {OwnerId{0}, static_cast<LocalId>(items.size()), static_cast<ModelId>(model)}});
}

/// nx × ny unit quads, two triangles each, z = 4 sin(2πx/32) cos(2πy/32), moved by `shift`.
void add_wave(Items& items, int nx, int ny, const Point& shift, std::uint32_t model) {
  const auto at = [&](int x, int y) {
    constexpr double turn = 2 * std::numbers::pi / 32;
    return Point{shift[0] + x, shift[1] + y,
                 shift[2] + 4 * std::sin(turn * x) * std::cos(turn * y)};
  };
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const Point a = at(x, y), b = at(x + 1, y), c = at(x + 1, y + 1), d = at(x, y + 1);
      add(items, box_of(Triangle{{a, b, d}}), model);
      add(items, box_of(Triangle{{b, c, d}}), model);
    }
}

Items wave() {
  Items items;
  add_wave(items, 512, 1024, {0, 0, 0}, 0);
  return items;
}
Items two_planes() {
  Items items;
  add_wave(items, 512, 512, {0, 0, 0}, 0);
  add_wave(items, 512, 512, {0.3, 0.3, 0.2}, 1);
  return items;
}
/// A million boxes of up to `largest` a side in the unit cube; model: each its own.
Items random_boxes(double largest) {
  Items items;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 1), extent(0, largest);
  for (int i = 0; i < 1'000'000; ++i) {
    Aabb box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = place(random);
      box.hi[k] = box.lo[k] + extent(random);
    }
    add(items, box, 0);
  }
  return items;
}

std::uint64_t count(const Items& items, double size, PairRules rules, SerialMethod method) {
  std::uint64_t n = 0;
  collide_serial(
      items, VoxelGrid(size), rules, [&](const Item&, const Item&) { ++n; }, method);
  return n;
}

bool row(const char* name, const Items& items, PairRules rules, int runs) {
  const double size = suggested_voxel_size(items);
  const std::uint64_t expected = count(items, 1.7 * size, rules, SerialMethod::bisection);
  std::vector<double> ns;
  std::uint64_t n_pairs = 0;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    n_pairs = count(items, size, rules, SerialMethod::automatic);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    ns.push_back(took.count() / static_cast<double>(items.size()));
  }
  std::sort(ns.begin(), ns.end());
  fmt::print(
      "{:<28} {:>9} objects {:>10} pairs {:>8.1f} ns per object (median), {:>8.1f} least{}\n", name,
      items.size(), n_pairs, ns[ns.size() / 2], ns.front(),
      n_pairs == expected ? "" : fmt::format("  WRONG: bisection finds {}", expected));
  return n_pairs == expected;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const PairRules across{}, self{Touching::counts, WithinModel::test};
  const PairRules open{Touching::does_not_count, WithinModel::test};
  bool good = true;
  {
    const Items items = wave();
    good &= row("wave, one model", items, across, runs);
    good &= row("wave, self, closed", items, self, runs);
    good &= row("wave, self, open", items, open, runs);
  }
  good &= row("two planes, near-parallel", two_planes(), across, runs);
  good &= row("random boxes", random_boxes(0.019), self, runs);
  return good ? 0 : 1;
}
