// Prints the time and the result of every strategy on a set of scenes. Fails if an assignment
// breaks the rules or takes more than a second.
#include "apps/bench/balance_scenes.hpp"
#include "runtime/balance/honour.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/command_line.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

using namespace tess::balance;

namespace {

double seconds(const Strategy& strategy, const Snapshot& s, Assignment& result) {
  const auto start = std::chrono::steady_clock::now();
  result = strategy(s);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool row(const std::string& scene, const Snapshot& s, const std::string& name) {
  const Strategy strategy = make_strategy(name, 1);
  std::array<double, 5> times{};
  Assignment result;
  for (double& time : times) time = seconds(strategy, s, result);
  std::ranges::sort(times);
  const Metrics m = measure(s, result);
  fmt::print("{:24} {:14} {:9.2f} {:9.2f} {:8.3f} {:7} {:12}\n", scene, name, 1e3 * times[2],
             1e3 * (times[4] - times[0]), m.max_over_average, m.n_moves, m.external_bytes);
  return honour(s, result) == result && times[2] < 1;
}

int run(const std::string& only) {
  const std::vector<std::pair<std::string, Snapshot>> scenes = {
      {"mod 7, 64 on 4", mod_seven(Start::blocks)},
      {"mod 7, all on PE 0", mod_seven(Start::all_on_first)},
      {"stencil 64², 16 PEs", stencil(64, 16, 1)},
      {"heavy 32768 on 1024", heavy_tailed(32768, 1024, 1)}};
  fmt::print("{:24} {:14} {:>9} {:>9} {:>8} {:>7} {:>12}\n", "scene", "strategy", "median ms",
             "spread ms", "max/avg", "moves", "ext. bytes");
  bool good = true;
  for (const auto& [scene, s] : scenes)
    for (const std::string& name : strategy_names()) {
      if (!only.empty() && name != only) continue;
      if (s.elements.position.empty() && (name == "rcb" || name == "hilbert")) continue;
      good = row(scene, s, name) && good;
    }
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    std::string only;
    tess::CommandLine line("Time and result of each strategy on a set of scenes.");
    line.option("STRATEGY", only, "this one only").one_of(strategy_names());
    return line.parse(argc, argv, {}) ? run(only) : 0;
  });
}
