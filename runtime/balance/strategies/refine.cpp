#include "runtime/balance/strategies/refine.hpp"

#include "runtime/balance/loads.hpp"
#include "runtime/balance/metrics.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace tess::balance {
namespace {

using Key = std::pair<double, std::size_t>;  // time and PE, or load and element

class Refinement {
 public:
  Refinement(const Snapshot& s, Assignment start)
      : s_(s), result_(std::move(start)), loads_(s), on_(s.pes.size()) {
    for (std::size_t i = 0; i < result_.size(); ++i) {
      const std::size_t pe = slot(result_[i]);
      loads_.put(i, pe);
      loads_.move_memory(i, slot(s.elements.pe[i]), pe);
      if (const double load = s.elements.load[i].seconds(); s.elements.migratable[i] && load > 0)
        on_[pe].emplace(load, i);
    }
    for (std::size_t p = 0; p < s.pes.size(); ++p) by_time_.emplace(loads_.time(p), p);
  }

  Assignment run(double limit) {
    for (std::size_t moves = 0; moves < 2 * result_.size(); ++moves) {
      const auto [time, from] = *by_time_.rbegin();
      if (time <= limit || !relieve(from)) break;
    }
    return std::move(result_);
  }

 private:
  /// Makes one move from the slowest PE to the first of the other PEs, fastest first, that helps.
  bool relieve(std::size_t from) {
    for (const auto& [time, to] : by_time_) {
      if (to == from) continue;
      if (const auto element = best_element(from, to)) {
        move(*element, from, to);
        return true;
      }
    }
    return false;
  }

  /// The later time of the two PEs falls with the load until both are equal, then rises: the best
  /// element is next to that point.
  [[nodiscard]] std::optional<std::size_t> best_element(std::size_t from, std::size_t to) const {
    const double now = loads_.time(from);
    const double even = (now - loads_.time(to)) / (1 / s_.pes.speed[from] + 1 / s_.pes.speed[to]);
    const auto later = [&](double load) {
      return std::max(loads_.time(from, -load), loads_.time(to, load));
    };
    std::optional<std::size_t> best;
    double best_time = now;
    const auto consider = [&](const Key& key) {  // true: the search may stop
      if (later(key.first) >= best_time) return true;
      if (!loads_.fits(key.second, from, to)) return false;
      best = key.second;
      best_time = later(key.first);
      return true;
    };
    const auto middle = on_[from].lower_bound({even, 0});
    for (auto i = middle; i != on_[from].end() && !consider(*i);) ++i;
    for (auto i = middle; i != on_[from].begin() && !consider(*--i);) {
    }
    return best;
  }

  void move(std::size_t element, std::size_t from, std::size_t to) {
    by_time_.erase({loads_.time(from), from});
    by_time_.erase({loads_.time(to), to});
    loads_.move(element, from, to);
    by_time_.emplace(loads_.time(from), from);
    by_time_.emplace(loads_.time(to), to);
    on_[to].insert(on_[from].extract({s_.elements.load[element].seconds(), element}));
    result_[element] = pe_at(to);
  }

  const Snapshot& s_;
  Assignment result_;
  Loads loads_;
  std::vector<std::set<Key>> on_;  // elements that may go, by load
  std::set<Key> by_time_;
};

}  // namespace

Assignment refine_from(const Snapshot& s, Assignment start, double tolerance) {
  return Refinement(s, std::move(start)).run(tolerance * average_time(s));
}

Assignment refine(const Snapshot& s, double tolerance) {
  Assignment better = refine_from(s, s.elements.pe, tolerance);
  const double now = measure(s, s.elements.pe).max_over_average;
  return measure(s, better).max_over_average <= (1 - least_gain) * now ? better : s.elements.pe;
}

}  // namespace tess::balance
