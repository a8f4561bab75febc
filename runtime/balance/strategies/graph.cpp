#include "runtime/balance/strategies/graph.hpp"

#include "runtime/balance/capacity.hpp"
#include "runtime/balance/honour.hpp"
#include "runtime/balance/relabel.hpp"
#include "runtime/balance/strategies/greedy_refine.hpp"
#include "runtime/balance/strategies/refine.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <scotch.h>

namespace tess::balance {
namespace {

void check(int code, const char* call) {
  if (code != 0) fail(ErrorCode::environment, "Scotch: ", call, " gives ", code);
}

/// A Scotch object, released at the end of its scope.
template <class T, void (*Exit)(T*)>
class Scoped {
 public:
  Scoped(int (*init)(T*), const char* call) { check(init(&object_), call); }
  ~Scoped() { Exit(&object_); }
  Scoped(const Scoped&) = delete;
  Scoped& operator=(const Scoped&) = delete;
  [[nodiscard]] T* get() { return &object_; }

 private:
  T object_;
};
using Context = Scoped<SCOTCH_Context, SCOTCH_contextExit>;
using Graph = Scoped<SCOTCH_Graph, SCOTCH_graphExit>;
using Arch = Scoped<SCOTCH_Arch, SCOTCH_archExit>;
using Strat = Scoped<SCOTCH_Strat, SCOTCH_stratExit>;

/// Positive integers in these proportions, whose sum is at most `sum` plus one each, since Scotch
/// uses ints.
std::vector<SCOTCH_Num> in_proportion(const std::vector<double>& values, double sum) {
  const double total = std::accumulate(values.begin(), values.end(), 0.0);
  const double scale = total > 0 ? sum / total : 0;
  std::vector<SCOTCH_Num> result;
  for (const double value : values)
    result.push_back(std::max(1, static_cast<SCOTCH_Num>(std::lround(value * scale))));
  return result;
}

/// Both directions of every communicating pair, in compressed rows.
struct Adjacency {
  std::vector<SCOTCH_Num> begin, to, weight;

  explicit Adjacency(const Snapshot& s) {
    std::vector<Edge> edges;
    for (const Edge& e : s.edges) {
      if (e.from == e.to) continue;
      edges.push_back({e.from, e.to, e.bytes, 0});
      edges.push_back({e.to, e.from, e.bytes, 0});
    }
    std::ranges::sort(edges, {}, [](const Edge& e) { return std::pair(e.from, e.to); });
    begin.assign(s.elements.size() + 1, 0);
    std::vector<double> bytes;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Edge& e = edges[k];
      if (k > 0 && edges[k - 1].from == e.from && edges[k - 1].to == e.to) {
        bytes.back() += static_cast<double>(e.bytes);
        continue;
      }
      ++begin[e.from + 1];
      to.push_back(static_cast<SCOTCH_Num>(e.to));
      bytes.push_back(static_cast<double>(e.bytes));
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    weight = in_proportion(bytes, 5e8);
  }
};

/// The capacity of each PE, including its pinned elements.
std::vector<double> widths(const Snapshot& s, const std::vector<double>& weight) {
  std::vector<double> result = capacities(s);
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (!s.elements.migratable[i]) result[slot(s.elements.pe[i])] += weight[i];
  return result;
}

Assignment map(const Snapshot& s, std::uint64_t seed, double tolerance) {
  const auto n_pes = static_cast<SCOTCH_Num>(s.pes.size());
  const auto n_elements = static_cast<SCOTCH_Num>(s.elements.size());
  const std::vector<double> weight = weights(s);
  const std::vector<SCOTCH_Num> vertex = in_proportion(weight, 1e8);
  const std::vector<SCOTCH_Num> width = in_proportion(widths(s, weight), 1e8);
  const Adjacency edges(s);

  Context context(SCOTCH_contextInit, "SCOTCH_contextInit");
  check(SCOTCH_contextOptionSetNum(context.get(), SCOTCH_OPTIONNUMDETERMINISTIC, 1), "option");
  SCOTCH_contextRandomSeed(context.get(), static_cast<SCOTCH_Num>(seed % 1000003));
  SCOTCH_contextRandomReset(context.get());
  check(SCOTCH_contextThreadSpawn(context.get(), 1, nullptr), "SCOTCH_contextThreadSpawn");
  Graph graph(SCOTCH_graphInit, "SCOTCH_graphInit");
  check(SCOTCH_graphBuild(graph.get(), 0, n_elements, edges.begin.data(), nullptr, vertex.data(),
                          nullptr, edges.begin.back(), edges.to.data(), edges.weight.data()),
        "SCOTCH_graphBuild");
  Graph bound(SCOTCH_graphInit, "SCOTCH_graphInit");
  check(SCOTCH_contextBindGraph(context.get(), graph.get(), bound.get()),
        "SCOTCH_contextBindGraph");
  Arch arch(SCOTCH_archInit, "SCOTCH_archInit");
  check(SCOTCH_archCmpltw(arch.get(), n_pes, width.data()), "SCOTCH_archCmpltw");
  Strat strategy(SCOTCH_stratInit, "SCOTCH_stratInit");
  // Not SCOTCH_STRATBALANCE: cuts 5 % better, but Scotch 7.0.3 leaks with it.
  check(SCOTCH_stratGraphMapBuild(strategy.get(), SCOTCH_STRATDEFAULT, n_pes, (tolerance - 1) / 2),
        "SCOTCH_stratGraphMapBuild");

  std::vector<SCOTCH_Num> part(s.elements.size(), -1);
  bool pinned = false;
  for (std::size_t i = 0; i < part.size(); ++i)
    if (!s.elements.migratable[i]) part[i] = s.elements.pe[i].value, pinned = true;
  check((pinned ? SCOTCH_graphMapFixed : SCOTCH_graphMap)(bound.get(), arch.get(), strategy.get(),
                                                          part.data()),
        "SCOTCH_graphMap");
  Assignment result;
  for (const SCOTCH_Num pe : part) result.push_back(PeId{pe});
  return result;
}

}  // namespace

bool graph_is_built() {
  return true;
}

Assignment graph(const Snapshot& s, std::uint64_t seed, double tolerance) {
  if (s.pes.size() == 1 || s.elements.size() == 0) return s.elements.pe;
  if (s.elements.size() + 2 * s.edges.size() > INT32_MAX / 2)
    fail(ErrorCode::bad_value, "strategy graph: ", s.edges.size(),
         " edges; Scotch takes 500000000; choose hierarchical");
  if (std::ranges::all_of(s.edges, [](const Edge& e) { return e.from == e.to; }))
    return greedy_refine(s);
  return refine_from(s, honour(s, relabel(s, map(s, seed, tolerance))), tolerance);
}

}  // namespace tess::balance
