#include "collide/search/voxel_search.hpp"

#include "collide/problem/corners.hpp"
#include "collide/problem/costs.hpp"
#include "collide/problem/instantiate.hpp"

#include <algorithm>

namespace tess::collide::search {
namespace {

constexpr std::size_t most_depth = 32;
constexpr std::uint32_t no_place = ~std::uint32_t{0};
constexpr std::uint64_t several_models = ~std::uint64_t{0};

template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> clipped(const Box<Real, D>& box, const Box<Real, D>& to) {
  Box<Real, D> out;
  for (std::size_t k = 0; k < D; ++k) {
    out.lo[k] = std::max(box.lo[k], to.lo[k]);
    out.hi[k] = std::max(out.lo[k], std::min(box.hi[k], to.hi[k]));
  }
  return out;
}

template <class Real, std::size_t D>
void prefetch(const Box<Real, D>& box) {
  __builtin_prefetch(&box);
  __builtin_prefetch(&box.hi[D - 1]);
}

}  // namespace

template <class Real, std::size_t D>
bool VoxelSearch<Real, D>::solve(const TheProblem& problem, const TheBox& region, bool swapped,
                                 const std::optional<Choice<D>>& choice) {
  swapped_ = swapped;
  if (!solve(problem, region, std::size_t{0}, choice)) return false;
  pairs_.flush();
  statistics_.n_candidates = pairs_.n_total();
  statistics_.bytes = 0;
  for (const Level& level : levels_)
    statistics_.bytes += level.cells.capacity() * sizeof(Counts) + level.codes.bytes() +
                         level.sorted.bytes() + level.voxels.capacity() * sizeof(Voxel) +
                         level.models.capacity() * 8;
  return true;
}

template <class Real, std::size_t D>
bool VoxelSearch<Real, D>::solve(const TheProblem& problem, const TheBox& region, std::size_t depth,
                                 const std::optional<Choice<D>>& choice) {
  if (problem.n_comparisons() == 0) return true;
  const std::size_t n = problem.a.size() + problem.b.size();
  const bool is_chosen = options_.voxel_size > 0;
  if ((n <= costs::few_objects && !is_chosen) || depth == most_depth) {
    compare(problem);
    return true;
  }
  // The region of a cell is rounded: the grid may keep to it, but objects outside may touch in it.
  const TheBox of_a = depth == 0 ? region : bounds_of(problem.boxes_a, problem.a);
  const TheBox bounds = depth == 0 ? region : clipped(of_a, region);
  const RegionGrid<Real, D> grid(bounds, choice ? choice->n_cells : choose(problem, bounds, depth));
  if (grid.size() == 1) {
    compare(problem);
    return true;
  }

  if (levels_.size() == depth) levels_.emplace_back();
  Level& level = levels_[depth];
  if (!sort_into_voxels(problem, of_a, grid, level)) return false;
  if (depth == 0) ++statistics_.grid.n_levels;
  const auto cell_size = static_cast<double>(grid.cell_size());
  if (statistics_.grid.voxel_size == 0 || cell_size < statistics_.grid.voxel_size)
    statistics_.grid.voxel_size = cell_size;
  const bool again = is_chosen ? cell_size > 1.01 * options_.voxel_size
                               : options_.method == PairMethod::automatic ||
                                     options_.method == PairMethod::bisection;
  for (std::size_t v = 0; v < level.voxels.size(); ++v) {
    const Voxel& voxel = level.voxels[v];
    if (v + 1 < level.voxels.size()) {
      const Voxel& next = level.voxels[v + 1];
      const Entry* const entries = level.sorted.data() + next.begin;
      for (std::uint32_t i = 0; i < next.n_a; ++i) prefetch(problem.boxes_a[object_of(entries[i])]);
      for (std::uint32_t i = next.n_a; i < next.n_a + next.n_b; ++i)
        prefetch(problem.boxes_b[object_of(entries[i])]);
    }
    const TheProblem part{problem.boxes_a,
                          problem.boxes_b,
                          {level.sorted.data() + voxel.begin, voxel.n_a},
                          {level.sorted.data() + voxel.begin + voxel.n_a, voxel.n_b},
                          problem.within_a};
    if (again && voxel.n_a + voxel.n_b > costs::few_objects) {
      static_cast<void>(solve(part, clipped(grid.region(voxel.cell), bounds), depth + 1, {}));
    } else {
      compare(part);
    }
  }
  return true;
}

template <class Real, std::size_t D>
CellAt<D> VoxelSearch<Real, D>::choose(const TheProblem& problem, const TheBox& bounds,
                                       std::size_t depth) {
  const double n = static_cast<double>(problem.a.size() + problem.b.size());
  if (options_.voxel_size > 0)
    return cells_of_size(bounds, options_.voxel_size, std::clamp(4 * n, 4096.0, 0x1p26));
  if (options_.method == PairMethod::bisection && depth > 0) {
    CellAt<D> n_cells;
    n_cells.fill(1);
    std::size_t widest = 0;
    for (std::size_t k = 1; k < D; ++k)
      if (bounds.hi[k] - bounds.lo[k] > bounds.hi[widest] - bounds.lo[widest]) widest = k;
    n_cells[widest] = 2;
    return n_cells;
  }
  return chooser_.choose(problem, bounds).n_cells;
}

/// Calls take(cells, entries, n) for the cells that the boxes touch, some hundred at a time, in the
/// order of the boxes. False if take() is. The first time, the codes of all boxes are found. Boxes
/// of b that do not touch `of_a`, the bounds of all of a, are left out.
template <class Real, std::size_t D>
template <bool is_b, bool again, class Take>
bool VoxelSearch<Real, D>::spread(const TheProblem& problem, const TheBox& of_a,
                                  const RegionGrid<Real, D>& grid, Level& level, const Take& take) {
  constexpr std::size_t ahead = 24, most = 512;
  const TheBox* const boxes = is_b ? problem.boxes_b : problem.boxes_a;
  const std::span<const Entry> entries = is_b ? problem.b : problem.a;
  const Corners<D> corners(grid.strides());
  std::array<std::uint32_t, most + Corners<D>::room> cell_of, entry_of;
  std::uint32_t* const codes = level.codes.data() + (is_b ? problem.a.size() : 0);
  constexpr std::uint32_t outside = RegionGrid<Real, D>::large - 1;
  std::size_t n = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Entry entry = entries[i];
    const TheBox& box = boxes[object_of(entry)];
    if constexpr (!again) {
      if (i + ahead < entries.size()) prefetch(boxes[object_of(entries[i + ahead])]);
      codes[i] = is_b && !overlap(box, of_a, Touching::counts) ? outside : grid.code(box);
    }
    const std::uint32_t code = codes[i];
    if (is_b && code == outside) continue;
    if (n >= most && !take(cell_of.data(), entry_of.data(), std::exchange(n, 0))) return false;
    if (code != RegionGrid<Real, D>::large) [[likely]] {
      n += corners.write(code >> D, static_cast<std::uint32_t>(entry), code & ((1U << D) - 1),
                         cell_of.data() + n, entry_of.data() + n);
      continue;
    }
    const Box<std::int32_t, D> cells = grid.cells(box);
    for (CellAt<D> at = cells.lo;;) {
      std::uint32_t below = below_of(entry);
      for (std::size_t k = 0; k < D; ++k) below |= (at[k] != cells.lo[k] ? 1U : 0U) << k;
      cell_of[n] = grid.number(at);
      entry_of[n++] = static_cast<std::uint32_t>(make_entry(object_of(entry), below));
      if (n >= most && !take(cell_of.data(), entry_of.data(), std::exchange(n, 0))) return false;
      std::size_t k = D;
      while (k > 0 && at[k - 1] == cells.hi[k - 1]) --k, at[k] = cells.lo[k];
      if (k == 0) break;
      ++at[k - 1];
    }
  }
  return take(cell_of.data(), entry_of.data(), n);
}

/// A counting sort.
template <class Real, std::size_t D>
bool VoxelSearch<Real, D>::sort_into_voxels(const TheProblem& problem, const TheBox& of_a,
                                            const RegionGrid<Real, D>& grid, Level& level) {
  const std::size_t n_cells = grid.size();
  const std::size_t most = &level == &levels_.front() ? most_entries_ : ~std::size_t{0};
  level.cells.assign(n_cells, Counts{});
  level.codes.resize(problem.a.size() + problem.b.size());
  level.models.assign(by_model_ ? n_cells : 0, 0);
  Counts* const cells = level.cells.data();
  std::size_t n_entries = 0;
  const auto count = [&](std::uint32_t Counts::*set) {
    return [&, set](const std::uint32_t* cell_of, const std::uint32_t* entry_of, std::size_t n) {
      n_entries += n;
      for (std::size_t i = 0; i < n; ++i) ++(cells[cell_of[i]].*set);
      if (by_model_) note_models(level, cell_of, entry_of, n);
      return n_entries <= most;
    };
  };
  if (!spread<false, false>(problem, of_a, grid, level, count(&Counts::a)) ||
      !spread<true, false>(problem, of_a, grid, level, count(&Counts::b)))
    return false;
  statistics_.grid.n_entries += n_entries;

  // Where the objects of each voxel stand: first those of a, then those of b.
  level.voxels.clear();
  std::uint32_t end = 0;
  for (std::uint32_t c = 0; c < n_cells; ++c) {
    const auto [n_a, n_b] = cells[c];
    if (n_a + n_b == 0) continue;
    const bool one_model =
        by_model_ ? level.models[c] != several_models : !problem.within_a && (n_a == 0 || n_b == 0);
    if (one_model || n_a == 0 || n_b + (problem.within_a ? n_a - 1 : 0) == 0) {
      statistics_.grid.n_left_out += n_a + n_b;
      cells[c] = {no_place, no_place};
      continue;
    }
    level.voxels.push_back({c, end, n_a, n_b});
    cells[c] = {end, end + n_a};
    end += n_a + n_b;
  }
  statistics_.grid.n_voxels += level.voxels.size();
  level.sorted.resize(end);
  Entry* const sorted = level.sorted.data();
  const auto place = [&](std::uint32_t Counts::*set) {
    return [=](const std::uint32_t* cell_of, const std::uint32_t* entry_of, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t& to = cells[cell_of[i]].*set;
        if (to != no_place) sorted[to++] = static_cast<Entry>(entry_of[i]);
      }
      return true;
    };
  };
  return spread<false, true>(problem, of_a, grid, level, place(&Counts::a)) &&
         spread<true, true>(problem, of_a, grid, level, place(&Counts::b));
}

template <class Real, std::size_t D>
void VoxelSearch<Real, D>::note_models(Level& level, const std::uint32_t* cell_of,
                                       const std::uint32_t* entry_of, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t object = object_of(static_cast<Entry>(entry_of[i]));
    const std::uint64_t code = std::uint64_t{options_.models[object]} + 1;
    std::uint64_t& state = level.models[cell_of[i]];
    state = state == 0 || state == code ? code : several_models;
  }
}

template <class Real, std::size_t D>
bool VoxelSearch<Real, D>::sweeps(std::size_t n) const noexcept {
  return options_.method == PairMethod::sweep ||
         (n >= costs::sweep_from && options_.method != PairMethod::all_pairs);
}

template <class Real, std::size_t D>
void VoxelSearch<Real, D>::compare(const TheProblem& problem) {
  if (options_.touching == Touching::counts)
    by_model_ ? compare_as<Touching::counts, true>(problem)
              : compare_as<Touching::counts, false>(problem);
  else
    by_model_ ? compare_as<Touching::does_not_count, true>(problem)
              : compare_as<Touching::does_not_count, false>(problem);
}

template <class Real, std::size_t D>
template <Touching touching, bool by_model>
void VoxelSearch<Real, D>::compare_as(const TheProblem& problem) {
  if (problem.within_a) within<touching, by_model>(problem);
  if (!problem.b.empty()) across<touching, by_model>(problem);
}

template <class Real, std::size_t D>
template <bool by_model>
void VoxelSearch<Real, D>::fill(const TheBox* boxes, std::span<const Entry> entries,
                                bool in_slices) {
  if (in_slices) slices_.sort(boxes, entries);
  lanes_.resize(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint32_t object = object_of(entries[i]);
    const std::size_t at = in_slices ? slices_.place(i) : i;
    lanes_.set(at, boxes[object], entries[i]);
    if constexpr (by_model) lanes_.set_model(at, options_.models[object]);
  }
}

/// All pairs of a, or a sweep.
template <class Real, std::size_t D>
template <Touching touching, bool by_model>
void VoxelSearch<Real, D>::within(const TheProblem& problem) {
  const std::size_t n = problem.a.size();
  const bool in_slices = sweeps(n);
  fill<by_model>(problem.boxes_a, problem.a, in_slices);
  // A vector of neighbours has a common end: a loop of equal length for each predicts well.
  for (std::size_t begin = 0; begin < n; begin += lanes_.width) {
    const std::size_t end = in_slices ? slices_.end(lanes_.highest(begin, slices_.axis())) : n;
    for (std::size_t i = begin; i < std::min(begin + lanes_.width, n); ++i) {
      pairs_.prepare(n, swapped_);
      lanes_.template compare<touching, by_model>(lanes_.probe(i), i + 1, end, pairs_);
    }
  }
}

/// Compares each box of the smaller set with the larger set, or with the slices that it reaches.
template <class Real, std::size_t D>
template <Touching touching, bool by_model>
void VoxelSearch<Real, D>::across(const TheProblem& problem) {
  const bool b_is_smaller = problem.b.size() < problem.a.size();
  const std::span<const Entry> few = b_is_smaller ? problem.b : problem.a;
  const std::span<const Entry> many = b_is_smaller ? problem.a : problem.b;
  const TheBox* const boxes = b_is_smaller ? problem.boxes_b : problem.boxes_a;
  const bool in_slices = few.size() > 1 && sweeps(many.size());
  fill<by_model>(b_is_smaller ? problem.boxes_a : problem.boxes_b, many, in_slices);
  if (in_slices) slices_.find_firsts(lanes_.upper_ends(slices_.axis()));
  for (const Entry entry : few) {
    const std::uint32_t object = object_of(entry);
    const TheBox& box = boxes[object];
    pairs_.prepare(many.size(), swapped_ != b_is_smaller);
    lanes_.template compare<touching, by_model>(
        lanes_.probe(box, entry, by_model ? options_.models[object] : 0),
        in_slices ? slices_.first(box.lo) : 0, in_slices ? slices_.end(box.hi) : many.size(),
        pairs_);
  }
}

#define TESS_INSTANTIATE(Real, D) template class VoxelSearch<Real, D>;
TESS_FOR_EACH_KIND_OF_BOX(TESS_INSTANTIATE)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::search
