#include "collide/problem/choose_grid.hpp"

#include "collide/problem/costs.hpp"
#include "collide/problem/instantiate.hpp"
#include "runtime/core/simd.hpp"

#include <algorithm>
#include <cmath>

namespace tess::collide::search {
namespace {

constexpr double most_per_axis = 1 << 20;

/// Bits of a coordinate per axis.
template <std::size_t D>
constexpr int n_bits = D == 2   ? 20
                       : D == 3 ? 16
                                : 12;

/// The bits of a byte, D apart.
template <std::size_t D>
constexpr auto spread_bytes = [] {
  std::array<std::uint64_t, 256> out{};
  for (std::size_t byte = 0; byte < out.size(); ++byte)
    for (std::size_t bit = 0; bit < 8; ++bit)
      out[byte] |= static_cast<std::uint64_t>(byte >> bit & 1U) << D * bit;
  return out;
}();

/// The first axis has the highest bits.
template <std::size_t D>
std::uint64_t interleaved(const std::array<std::uint32_t, D>& cell) {
  std::uint64_t out = 0;
  for (std::size_t k = 0; k < D; ++k)
    for (std::size_t byte = 0; byte * 8 < n_bits<D>; ++byte)
      out |= spread_bytes<D>[cell[k] >> 8 * byte & 255U] << (D * 8 * byte + D - 1 - k);
  return out;
}

template <class Real, std::size_t D>
Real widest_of(const Box<Real, D>& region) {
  Real widest = 0;
  for (std::size_t k = 0; k < D; ++k) widest = std::max(widest, region.hi[k] - region.lo[k]);
  return widest;
}
template <class Real>
bool can_be_cut(Real widest) {
  return widest > 0 && std::isfinite(widest) && std::isfinite(1 / widest);
}

/// How likely two objects share a cell, from runs of equal cells in a sorted sample.
struct Sharing {
  double within_a = 0, with_b = 0;
};

/// Vectors of boxes that a box is compared with if it has so many partners in its voxel. On chares
/// voxels are so large that a sweep counts, which compares with those of a strip: of twice as many
/// partners about 1.6 times as many.
double n_vectors(const Place& place, double partners, double lanes) {
  constexpr double most = static_cast<double>(costs::sweep_from) / 2;
  if (place.on_chares && partners > most)
    partners = most * std::cbrt(partners / most * (partners / most));
  return partners / lanes + 0.5;
}

/// What voxels cost because they are chares, in a search of the given cost.
double cost_of_chares(const Place& place, double cost, double n_cells, const Sharing& sharing) {
  if (!place.on_chares) return 0;
  const double n_used = std::min(n_cells, 1 / std::max(sharing.within_a, 1e-12));
  return costs::per_chare * n_used + cost / n_used * (place.n_pes - 1);
}

}  // namespace

template <class Real, std::size_t D>
CellAt<D> cells_of_size(const Box<Real, D>& region, double size, double most_cells) {
  std::array<double, D> n;
  for (;; size *= 1.25) {
    double product = 1;
    for (std::size_t k = 0; k < D; ++k) {
      const double width = static_cast<double>(region.hi[k]) - static_cast<double>(region.lo[k]);
      n[k] = std::clamp(std::ceil(width / size), 1.0, most_per_axis);
      if (!(n[k] >= 1)) n[k] = 1;
      product *= n[k];
    }
    if (product <= most_cells) break;
  }
  CellAt<D> out;
  for (std::size_t k = 0; k < D; ++k) out[k] = static_cast<std::int32_t>(n[k]);
  return out;
}

template <class Real, std::size_t D>
void GridChooser<Real, D>::take(const Box<Real, D>* boxes, std::span<const Entry> entries,
                                const Box<Real, D>& region, Real widest, bool is_b, double scale) {
  const double wanted = std::clamp(scale * static_cast<double>(entries.size()) / 64, 128.0, 2048.0);
  const std::size_t n = std::min(entries.size(), static_cast<std::size_t>(wanted));
  const Real per_cell = static_cast<Real>(std::uint32_t{1} << n_bits<D>) / widest;
  const Real last = static_cast<Real>((std::uint32_t{1} << n_bits<D>)-1);
  for (std::size_t i = 0; i < n; ++i) {
    const Box<Real, D>& box = boxes[object_of(entries[scattered(i, n, entries.size())])];
    Sample sample;
    std::array<std::uint32_t, D> cell;
    for (std::size_t k = 0; k < D; ++k) {
      const Real lo = std::max(box.lo[k], region.lo[k]), hi = std::min(box.hi[k], region.hi[k]);
      const Real extent = std::max(hi - lo, Real{0});
      const Real at = (lo + extent / 2 - region.lo[k]) * per_cell;
      cell[k] = static_cast<std::uint32_t>(std::clamp(at, Real{0}, last));
      sample.extent[k] = static_cast<float>(extent / widest);
    }
    sample.code = interleaved<D>(cell) << 1 | (is_b ? 1U : 0U);
    samples_.push_back(sample);
  }
}

template <class Real, std::size_t D>
Choice<D> GridChooser<Real, D>::choose(const Problem<Real, D>& problem, const Box<Real, D>& region,
                                       bool as_points, double scale, const Place& place) {
  const Real widest = widest_of(region);
  samples_.clear();
  if (can_be_cut(widest)) {
    take(problem.boxes_a, problem.a, region, widest, false, scale);
    samples_a_ = static_cast<double>(samples_.size());
    take(problem.boxes_b, problem.b, region, widest, true, scale);
    samples_b_ = static_cast<double>(samples_.size()) - samples_a_;
    std::sort(samples_.begin(), samples_.end(),
              [](const Sample& x, const Sample& y) { return x.code < y.code; });
  }
  return choose_again(problem, region, as_points, scale, place);
}

template <class Real, std::size_t D>
Choice<D> GridChooser<Real, D>::choose_again(const Problem<Real, D>& problem,
                                             const Box<Real, D>& region, bool as_points,
                                             double scale, const Place& place) const {
  const Real widest = widest_of(region);
  const auto n_a = scale * static_cast<double>(problem.a.size());
  const auto n_b = scale * static_cast<double>(problem.b.size());
  constexpr double lanes = simd::widest / sizeof(Real);
  const auto cost_of = [&](double in_a, double in_b, const Sharing& sharing) {  // entries of each
    const double partners =
        (problem.within_a ? in_a * sharing.within_a / 2 : 0) + in_b * sharing.with_b;
    return costs::per_entry * (in_a + in_b) +
           in_a * (costs::per_probe + costs::per_vector * n_vectors(place, partners, lanes));
  };
  CellAt<D> one;
  one.fill(1);
  const double whole = cost_of(n_a, n_b, {1, 1});
  Choice<D> best{one, whole + cost_of_chares(place, whole, 1, {1, 1})};
  if (!can_be_cut(widest)) return best;

  const double most_cells = std::min(0x1p26, 2 * (n_a + n_b) + 64);
  Sharing coarser{1, 1};
  double size = 1;  // of a cell, in units of the widest extent
  for (int level = 1; level <= n_bits<D>; ++level) {
    // Runs of equal cells at this level.
    const int shift = 1 + static_cast<int>(D) * (n_bits<D> - level);
    double pairs_a = 0, pairs_b = 0;
    for (std::size_t i = 0; i < samples_.size();) {
      const std::uint64_t cell = samples_[i].code >> shift;
      double run_a = 0, run_b = 0;
      for (; i < samples_.size() && samples_[i].code >> shift == cell; ++i)
        ((samples_[i].code & 1U) != 0 ? run_b : run_a) += 1;
      pairs_a += run_a * (run_a - 1);
      pairs_b += run_a * run_b;
    }
    Sharing sharing;
    sharing.within_a = pairs_a / std::max(samples_a_ * (samples_a_ - 1), 1.0);
    sharing.with_b = pairs_b / std::max(samples_a_ * samples_b_, 1.0);
    // Too few pairs say nothing; then a surface is assumed.
    if (pairs_a < 16) sharing.within_a = coarser.within_a / 4;
    if (pairs_b < 16) sharing.with_b = coarser.with_b / 4;
    // The size of this level, and one between it and the level before.
    for (const double part : {std::sqrt(0.5), 0.5}) {
      const double edge = size * part;
      const Sharing here = part == 0.5 ? sharing
                                       : Sharing{std::sqrt(sharing.within_a * coarser.within_a),
                                                 std::sqrt(sharing.with_b * coarser.with_b)};
      double product = 1;
      for (std::size_t k = 0; k < D; ++k)
        product *= std::max(1.0, std::ceil(static_cast<double>(region.hi[k] - region.lo[k]) /
                                           static_cast<double>(widest) / edge));
      if (product > most_cells) return best;
      const double per_edge = 1 / edge;
      double copies_a = samples_a_, copies_b = samples_b_;
      if (!as_points) {
        copies_a = copies_b = 0;
        for (const Sample& sample : samples_) {
          double copies = 1;
          for (const float extent : sample.extent)
            copies *= 1 + static_cast<double>(extent) * per_edge;
          ((sample.code & 1U) != 0 ? copies_b : copies_a) += copies;
        }
      }
      const double in_a = n_a * copies_a / std::max(samples_a_, 1.0);
      const double in_b = n_b * copies_b / std::max(samples_b_, 1.0);
      double cost = cost_of(in_a, in_b, here) + costs::per_cell * product + costs::per_grid;
      cost += cost_of_chares(place, cost, product, here);
      if (cost < best.cost)
        best = {cells_of_size(region, edge * static_cast<double>(widest), most_cells), cost};
    }
    coarser = sharing;
    size /= 2;
  }
  return best;
}

#define TESS_INSTANTIATE(Real, D)      \
  template class GridChooser<Real, D>; \
  template CellAt<D> cells_of_size(const Box<Real, D>&, double, double);
TESS_FOR_EACH_KIND_OF_BOX(TESS_INSTANTIATE)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::search
