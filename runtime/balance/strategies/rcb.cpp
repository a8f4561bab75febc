// Recursive coordinate bisection (Berger and Bokhari 1987): parts are boxes, so that neighbours in
// space share a PE.
#include "runtime/balance/capacity.hpp"
#include "runtime/balance/honour.hpp"
#include "runtime/balance/relabel.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace tess::balance {
namespace {

class Bisection {
 public:
  explicit Bisection(const Snapshot& s)
      : position_(s.elements.position),
        weights_(weights(s)),
        capacities_(capacities(s)),
        result_(s.elements.pe) {}

  Assignment run(std::vector<std::size_t> elements) {
    divide(elements, 0, capacities_.size());
    return std::move(result_);
  }

 private:
  void divide(std::span<std::size_t> elements, std::size_t begin, std::size_t end) {
    if (end - begin == 1) {
      for (const std::size_t i : elements) result_[i] = pe_at(begin);
      return;
    }
    if (elements.empty()) return;
    const std::size_t axis = longest_axis(elements);
    std::ranges::sort(elements, [&](auto a, auto b) {
      return std::pair(position_[a][axis], a) < std::pair(position_[b][axis], b);
    });
    const std::size_t middle = begin + (end - begin) / 2;
    const std::size_t cut = cut_at(elements, share(begin, middle, end));
    divide(elements.first(cut), begin, middle);
    divide(elements.subspan(cut), middle, end);
  }

  [[nodiscard]] std::size_t longest_axis(std::span<const std::size_t> elements) const {
    std::size_t longest = 0;
    double extent = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
      for (const std::size_t i : elements) {
        low = std::min(low, position_[i][axis]);
        high = std::max(high, position_[i][axis]);
      }
      if (high - low > extent) extent = high - low, longest = axis;
    }
    return longest;
  }

  /// The share of [begin, middle) in the capacity of [begin, end).
  [[nodiscard]] double share(std::size_t begin, std::size_t middle, std::size_t end) const {
    const auto at = [&](std::size_t p) {
      return capacities_.begin() + static_cast<std::ptrdiff_t>(p);
    };
    const double left = std::accumulate(at(begin), at(middle), 0.0);
    const double right = std::accumulate(at(middle), at(end), 0.0);
    return left + right > 0 ? left / (left + right) : 0.5;
  }

  /// The number of elements that make up the share, as closely as whole elements can.
  [[nodiscard]] std::size_t cut_at(std::span<const std::size_t> elements, double share) const {
    double rest = 0;
    for (const std::size_t i : elements) rest += weights_[i];
    rest *= share;
    std::size_t n = 0;
    while (n < elements.size() && weights_[elements[n]] / 2 < rest) rest -= weights_[elements[n++]];
    return n;
  }

  const std::vector<std::array<double, 3>>& position_;
  std::vector<double> weights_;
  std::vector<double> capacities_;
  Assignment result_;
};

}  // namespace

/// Divides the PEs into two halves, and the elements along their longest extent in proportion to
/// the capacities of the halves, and so on recursively. Throws Error if the snapshot has no
/// positions. O(n log n log n_pes).
Assignment rcb(const Snapshot& s) {
  if (s.elements.position.empty() && s.elements.size() > 0)
    fail(ErrorCode::bad_argument,
         "strategy rcb: the snapshot has no positions; define balance_position() in the chare");
  std::vector<std::size_t> elements;
  for (std::size_t i = 0; i < s.elements.size(); ++i)
    if (s.elements.migratable[i]) elements.push_back(i);
  return honour(s, relabel(s, Bisection(s).run(std::move(elements))));
}

}  // namespace tess::balance
