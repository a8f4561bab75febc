#include "apps/lb_lab/workload/workload.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace lb_lab {
namespace {

double uniform(const Problem&, Cell, std::int32_t) {
  return 1;
}

double linear(const Problem& p, Cell cell, std::int32_t) {
  return 2.0 * (cell.x + 1) / (p.domain.width + 1);
}

/// One cell has half a PE's work on top: no cut makes it smaller, only other cells can move away.
double one_hot(const Problem& p, Cell cell, std::int32_t) {
  const double extra = 0.5 * static_cast<double>(p.domain.n_cells()) / p.n_pes;
  return cell.x == p.domain.width / 8 ? 1 + extra : 1;
}

/// A quarter of the line is three times as expensive, and travels round it once a run.
double moving_hot_spot(const Problem& p, Cell cell, std::int32_t t) {
  const double width = p.domain.width, hot = width / 4;
  const double begin = width * t / p.n_iterations;
  double covered = 0;  // of this cell
  for (const double shift : {0.0, width}) {
    const double from = std::max<double>(cell.x, begin - shift);
    const double to = std::min<double>(cell.x + 1, begin + hot - shift);
    covered += std::max(0.0, to - from);
  }
  return (1 + 2 * covered) / 1.5;
}

/// Pareto with exponent 1.5, cut at 64; depends on the cell only.
double heavy_tailed(const Problem& p, Cell cell, std::int32_t) {
  const double tail = 1 - std::pow(64.0, -1.5);
  const double u = drawn(p.seed ^ tess::mix(p.domain.number(cell)));
  return std::pow(1 - u * tail, -1 / 1.5) / 2.63;
}

/// A Brownian path at time t of 2^12 iterations, by Lévy's construction: from the ends inwards each
/// midpoint is the mean of its neighbours and a draw from a hash. So any t costs twelve draws.
double brownian(std::uint64_t path, std::int32_t t) {
  constexpr std::int32_t span = 1 << 12;
  const auto normal = [path](std::int32_t at) {  // about: the sum of four uniform draws
    double sum = 0;
    for (std::uint64_t k = 0; k < 4; ++k)
      sum += drawn(tess::mix(path + k) ^ static_cast<std::uint64_t>(at));
    return (sum - 2) * std::numbers::sqrt3;
  };
  std::int32_t low = 0, high = span;
  double at_low = 0, at_high = 64 * normal(span);
  t %= span;
  while (high - low > 1) {
    const std::int32_t mid = (low + high) / 2;
    const double at_mid = (at_low + at_high) / 2 + 0.5 * std::sqrt(high - low) * normal(mid);
    if (t < mid) {
      high = mid;
      at_high = at_mid;
    } else {
      low = mid;
      at_low = at_mid;
    }
  }
  return at_low;
}

double random_walk(const Problem& p, Cell cell, std::int32_t t) {
  const std::uint64_t path = tess::mix(p.seed ^ tess::mix(p.domain.number(cell)));
  return std::exp(0.1 * std::clamp(brownian(path, t), -30.0, 15.0));
}

/// A disc of a tenth of the plane is refined: four sub-steps instead of one. It circles once a run.
bool refined(const Problem& p, Cell cell, std::int32_t t) {
  const double phase = 2 * std::numbers::pi * t / p.n_iterations;
  const double x = (cell.x + 0.5) / p.domain.width - (0.5 + 0.3 * std::cos(phase));
  const double y = (cell.y + 0.5) / p.domain.height - (0.5 + 0.3 * std::sin(phase));
  return x * x + y * y < 0.1 / std::numbers::pi;
}

double refined_work(const Problem& p, Cell cell, std::int32_t t) {
  return refined(p, cell, t) ? 4 : 1;
}

std::uint64_t seeded(const Problem& p, Cell cell) {
  return tess::mix(p.seed + tess::mix(p.domain.number(cell)));
}

std::uint64_t stir(const Problem&, Cell, std::int32_t t, const Stencil& at) {
  return tess::mix(at.self + static_cast<std::uint64_t>(t));
}

/// Any value that comes too early, too late or from the wrong side changes all that follow.
std::uint64_t stir_all(const Problem&, Cell, std::int32_t t, const Stencil& at) {
  const std::uint64_t sides = tess::mix(at.west + 1) + 3 * tess::mix(at.east + 2);
  return tess::mix(at.self + sides + static_cast<std::uint64_t>(t));
}

std::uint64_t warm(const Problem& p, Cell cell) {
  return std::bit_cast<std::uint64_t>(drawn(seeded(p, cell)));
}

/// Diffusion: a step of one, or four of a quarter each with the neighbours frozen.
std::uint64_t diffuse(const Problem& p, Cell cell, std::int32_t t, const Stencil& at) {
  const auto value = [](std::uint64_t bits) { return std::bit_cast<double>(bits); };
  const double around = (value(at.west) + value(at.east)) + (value(at.south) + value(at.north));
  double u = value(at.self);
  const int n_steps = refined(p, cell, t) ? 4 : 1;
  for (int step = 0; step < n_steps; ++step) u += 0.2 / n_steps * (around - 4 * u);
  return std::bit_cast<std::uint64_t>(u);
}

}  // namespace

const std::vector<Workload>& workloads() {
  static const std::vector<Workload> all = [] {
    const std::vector<Workload> silent = {
        {"uniform", "every cell costs the same", uniform, seeded, stir},
        {"linear", "a cell's work is proportional to its number", linear, seeded, stir},
        {"one_hot", "one cell has half a PE's work on top", one_hot, seeded, stir},
        {"random_walk", "the logarithm of a cell's work is a random walk", random_walk, seeded,
         stir},
        {"moving_hot_spot", "a quarter costs threefold, and travels round once a run",
         moving_hot_spot, seeded, stir},
        {"heavy_tailed", "Pareto with exponent 1.5, cut at 64 times the least", heavy_tailed,
         seeded, stir},
    };
    std::vector<Workload> result = silent;
    for (Workload loud : silent) {
      loud.name += "_comm";
      loud.traffic = Traffic::neighbours;
      loud.next = stir_all;
      result.push_back(loud);
    }
    result.push_back({"stencil",
                      "diffusion on a plane; a disc with four sub-steps circles once a run",
                      refined_work, warm, diffuse, Shape::plane, Traffic::neighbours});
    result.push_back({.name = "collision",
                      .what = "boxes in clusters that drift: their voxels are balanced",
                      .shape = Shape::plane,
                      .kind = &collision_kind});
    result.push_back({.name = "particles",
                      .what = "particles that bunch up round a moving attractor, in blocks",
                      .shape = Shape::plane,
                      .kind = &particles_kind});
    return result;
  }();
  return all;
}

std::uint32_t find_workload(std::string_view name) {
  std::string names;
  for (std::uint32_t i = 0; i < workloads().size(); ++i) {
    if (workloads()[i].name == name) return i;
    names += (i > 0 ? ", " : "") + workloads()[i].name;
  }
  tess::fail(tess::ErrorCode::bad_argument, "--workload: there is no ", name, "; choose of all, ",
             names, tess::did_you_mean(name, names));
}

double block_seconds(const Problem& p, const Block& block, std::int32_t t) {
  const auto work = workload_of(p).work;
  double sum = 0;
  for (std::int32_t y = 0; y < block.height; ++y)
    for (std::int32_t x = 0; x < block.width; ++x)
      sum += work(p, {block.first.x + x, block.first.y + y}, t);
  return sum * p.cell_seconds;
}

std::vector<std::uint64_t> cargo_of(const Problem& p, Cell cell) {
  std::vector<std::uint64_t> words(p.cell_bytes / 8);
  tess::Random next(p.domain.number(cell));
  for (std::uint64_t& word : words) word = next();
  return words;
}

std::uint64_t answer_of(const Problem& p, Cell cell, std::uint64_t state, std::uint64_t carried) {
  return tess::mix(tess::mix(p.domain.number(cell) + carried) ^ state);
}

}  // namespace lb_lab
