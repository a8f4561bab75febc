#include "apps/bench/balance_scenes.hpp"

#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cmath>

namespace tess::balance {

Snapshot idle_pes(std::size_t n_pes) {
  Snapshot s;
  s.pes.background.assign(n_pes, 0.0);
  s.pes.speed.assign(n_pes, 1.0);
  s.pes.memory_limit_bytes.assign(n_pes, 0);
  return s;
}

std::size_t add_element(Snapshot& s, std::size_t pe, double load) {
  auto& e = s.elements;
  const std::size_t n = e.size();
  e.key.push_back({CollectionId{0}, n});
  e.pe.push_back(pe_at(pe));
  e.load.push_back(load);
  e.migratable.push_back(1);
  e.size_bytes.push_back(0);
  e.memory_bytes.push_back(0);
  return n;
}

Snapshot mod_seven(Start start) {
  Snapshot s = idle_pes(4);
  for (std::size_t i = 0; i < 64; ++i)
    add_element(s, start == Start::blocks ? i / 16 : 0, static_cast<double>(i % 7 + 1));
  return s;
}

Snapshot stencil(std::size_t n, std::size_t n_pes, std::uint64_t seed) {
  Random next(seed);
  Snapshot s = idle_pes(n_pes);
  const auto unit = [n](std::size_t i) {
    return (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  };
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t i = add_element(s, (y * n + x) * n_pes / (n * n), 1 + next.unit());
      s.elements.position.push_back({unit(x), unit(y), 0});
      if (x + 1 < n) s.edges.push_back({i, i + 1, 1000, 1}), s.edges.push_back({i + 1, i, 1000, 1});
      if (y + 1 < n) s.edges.push_back({i, i + n, 1000, 1}), s.edges.push_back({i + n, i, 1000, 1});
    }
  return s;
}

Snapshot heavy_tailed(std::size_t n_elements, std::size_t n_pes, std::uint64_t seed) {
  Random next(seed);
  std::vector<double> loads;
  const double tail = 1 - std::pow(64.0, -1.5);
  for (std::size_t i = 0; i < n_elements; ++i)
    loads.push_back(std::pow(1 - next.unit() * tail, -1 / 1.5));
  std::sort(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(n_elements / 4));
  Snapshot s = idle_pes(n_pes);
  for (std::size_t i = 0; i < n_elements; ++i) {
    add_element(s, i * n_pes / n_elements, loads[i]);
    s.elements.position.push_back({static_cast<double>(i), 0, 0});
    s.edges.push_back({i, (i + 1) % n_elements, 100, 1});
  }
  return s;
}

Snapshot anything(std::uint64_t seed) {
  Random next(seed);
  Snapshot s = idle_pes(1 + next.below(9));
  const std::size_t n = next.below(60);
  const bool no_loads = seed % 5 == 0;
  std::vector<std::uint64_t> used(s.pes.size(), 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t pe = next.below(s.pes.size());
    add_element(s, pe, no_loads ? 0.0 : static_cast<double>(next.below(50)));
    s.elements.migratable[i] = next.below(4) != 0;
    s.elements.size_bytes[i] = next.below(1000);
    s.elements.memory_bytes[i] = next.below(100);
    s.elements.position.push_back({next.unit(), next.unit(), seed % 2 == 0 ? 0.0 : next.unit()});
    used[pe] += s.elements.memory_bytes[i];
  }
  for (std::size_t k = next.below(2 * n + 1); k > 0 && n > 0; --k)
    s.edges.push_back({next.below(n), next.below(n), next.below(5000), 1 + next.below(9)});
  for (std::size_t p = 0; p < s.pes.size(); ++p) {
    s.pes.speed[p] = 0.5 + static_cast<double>(next.below(4));
    s.pes.background[p] = static_cast<double>(next.below(10));
    if (next.below(2) == 0) s.pes.memory_limit_bytes[p] = used[p] / 2 + 1 + next.below(300);
  }
  return s;
}

}  // namespace tess::balance
