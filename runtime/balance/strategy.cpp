#include "runtime/balance/strategy.hpp"

#include "runtime/balance/loads.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace tess::balance {
namespace {

std::size_t at(PeId pe) {
  return static_cast<std::size_t>(pe.value);
}
PeId id(std::size_t pe) {
  return PeId{static_cast<std::int32_t>(pe)};
}

Loads present(const Snapshot& s) {
  Loads loads(s);
  for (std::size_t i = 0; i < s.elements.size(); ++i) loads.add(i, at(s.elements.pe[i]));
  return loads;
}

template <class Target>
Assignment each_to(const Snapshot& s, Target target) {
  Assignment result = s.elements.pe;
  Loads loads = present(s);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const std::size_t to = target(at(result[i]));
    if (!s.elements.migratable[i] || to == at(result[i]) || !loads.fits(i, to)) continue;
    loads.remove(i, at(result[i]));
    loads.add(i, to);
    result[i] = id(to);
  }
  return result;
}

}  // namespace

Assignment rotate(const Snapshot& s) {
  return each_to(s, [&](std::size_t pe) { return (pe + 1) % s.pes.size(); });
}

Assignment random(const Snapshot& s, std::uint64_t seed) {
  std::mt19937_64 next(seed);
  return each_to(s, [&](std::size_t) { return next() % s.pes.size(); });
}

Assignment greedy(const Snapshot& s) {
  Assignment result = s.elements.pe;
  Loads loads(s);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (s.elements.migratable[i])
      order.push_back(i);
    else
      loads.add(i, at(result[i]));
  }
  const auto& load = s.elements.load;
  std::ranges::stable_sort(order, [&](auto a, auto b) { return load[a] > load[b]; });
  for (const std::size_t i : order) {
    std::size_t best = s.pes.size();
    for (std::size_t p = 0; p < s.pes.size(); ++p)
      if (loads.fits(i, p) &&
          (best == s.pes.size() || loads.time(p, load[i]) < loads.time(best, load[i])))
        best = p;
    if (best == s.pes.size()) return s.elements.pe;
    loads.add(i, best);
    result[i] = id(best);
  }
  return result;
}

Assignment refine(const Snapshot& s, double tolerance) {
  Assignment result = s.elements.pe;
  Loads loads = present(s);
  const double average = average_time(s);
  std::vector<std::vector<std::size_t>> on(s.pes.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    if (s.elements.migratable[i] && s.elements.load[i] > 0) on[at(result[i])].push_back(i);
  for (std::size_t moves = 0; moves < result.size(); ++moves) {
    std::size_t from = 0, to = 0;
    for (std::size_t p = 1; p < s.pes.size(); ++p) {
      if (loads.time(p) > loads.time(from)) from = p;
      if (loads.time(p) < loads.time(to)) to = p;
    }
    double best = loads.time(from);
    if (best <= tolerance * average) break;
    auto chosen = on[from].end();
    for (auto i = on[from].begin(); i != on[from].end(); ++i) {
      const double load = s.elements.load[*i];
      const double after = std::max(loads.time(from, -load), loads.time(to, load));
      if (after < best && loads.fits(*i, to)) best = after, chosen = i;
    }
    if (chosen == on[from].end()) break;
    loads.remove(*chosen, from);
    loads.add(*chosen, to);
    result[*chosen] = id(to);
    on[to].push_back(*chosen);
    on[from].erase(chosen);
  }
  return result;
}

Strategy make_strategy(std::string_view name, std::uint64_t seed) {
  if (name == "none") return [](const Snapshot& s) { return s.elements.pe; };
  if (name == "rotate") return rotate;
  if (name == "random") return [seed](const Snapshot& s) { return random(s, seed); };
  if (name == "greedy") return greedy;
  if (name == "refine") return [](const Snapshot& s) { return refine(s); };
  fail(ErrorCode::bad_argument,
       "no balance strategy '",
       name,
       "'; choose one of none, rotate, random, greedy, refine");
}

}  // namespace tess::balance
