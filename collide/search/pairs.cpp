// The plan of a search: which sets are compared, on one level or on several.
#include "collide/pairs.hpp"

#include "collide/search/instantiate.hpp"
#include "collide/search/size_classes.hpp"
#include "collide/search/survey.hpp"
#include "collide/search/voxel_search.hpp"
#include "runtime/core/error.hpp"

namespace tess::collide::detail {
namespace {

using namespace search;

template <class Real, std::size_t D>
class Plan {
  using TheBox = Box<Real, D>;
  using Boxes = std::span<const TheBox>;
  using Entries = std::vector<Entry>;

 public:
  Plan(const PairOptions& options, bool by_model, PairSink sink)
      : options_(options), search_(options, by_model, sink) {}

  /// Pairs of `a` with `b`, or within `a` if `b` has no boxes.
  void run(Boxes boxes_a, const Entries& a, Boxes boxes_b, const Entries& b, bool within,
           const TheBox& bounds) {
    const Part whole{{boxes_a.data(), boxes_b.data(), a, b, within}, bounds, false};
    if (options_.voxel_size > 0) {
      check_memory(boxes_a, boxes_b, bounds);
      solve(whole);
    } else if (!solved_on_one_level(whole)) {
      OctaveCounts<Real> sizes{};
      count_octaves(boxes_a, sizes);
      count_octaves(boxes_b, sizes);
      const SizeClasses<Real> classes(base_of_classes(sizes, whole));
      const ByClass by_class_a(boxes_a, a, classes), by_class_b(boxes_b, b, classes);
      const std::vector<Part> parts =
          parts_by_class(whole.problem, by_class_a, by_class_b, classes.size());
      double cost = 0;
      for (const Part& part : parts) cost += cost_of(part);
      if (parts.size() > 1 && cost < cost_of(whole)) {
        for (const Part& part : parts) solve(part);
      } else {
        solve(whole);
      }
    }
    if (options_.statistics == nullptr) return;
    *options_.statistics = search_.statistics();
    options_.statistics->bytes += (a.capacity() + b.capacity()) * sizeof(Entry);
  }

 private:
  /// A problem that is solved with one grid.
  struct Part {
    Problem<Real, D> problem;
    TheBox bounds;  // of the objects of a
    bool swapped;   // a is the second set
  };

  double cost_of(const Part& part) {
    return search_.chooser().choose(part.problem, part.bounds).cost;
  }
  void solve(const Part& part) {
    static_cast<void>(search_.solve(part.problem, part.bounds, part.swapped));
    ++search_.statistics().n_levels;
  }
  /// False, without a pair, if large objects touch so many voxels that levels may cost less.
  bool solved_on_one_level(const Part& whole) {
    const std::size_t n = whole.problem.a.size() + whole.problem.b.size();
    constexpr std::size_t many = 4096;
    if (n > many &&
        cost_of(whole) > 2 * search_.chooser().choose(whole.problem, whole.bounds, true).cost)
      return false;
    search_.set_most_entries(4 * n + many);
    const bool solved = search_.solve(whole.problem, whole.bounds, false);
    search_.set_most_entries(~std::size_t{0});
    if (solved) ++search_.statistics().n_levels;
    return solved;
  }
  /// The largest size of class 0: the voxel that would be chosen if all objects were points, or the
  /// smallest object.
  Real base_of_classes(const OctaveCounts<Real>& sizes, const Part& whole) {
    std::uint32_t least = 0;
    while (sizes[least] == 0) ++least;
    const CellAt<D> cells = search_.chooser().choose(whole.problem, whole.bounds, true).n_cells;
    Real voxel = std::numeric_limits<Real>::infinity();
    for (std::size_t k = 0; k < D; ++k)
      if (cells[k] > 1)
        voxel = std::min(voxel,
                         (whole.bounds.hi[k] - whole.bounds.lo[k]) / static_cast<Real>(cells[k]));
    return std::max(std::isfinite(voxel) ? voxel : Real{0}, size_of_octave<Real>(least));
  }
  /// The levels of size_classes.hpp: each class with itself and with all smaller ones.
  static std::vector<Part> parts_by_class(const Problem<Real, D>& whole, const ByClass& a,
                                          const ByClass& b, std::size_t n_classes) {
    std::vector<Part> parts;
    const auto add = [&](const Problem<Real, D>& problem, bool swapped) {
      if (problem.n_comparisons() == 0) return;
      parts.push_back({problem, bounds_of(problem.boxes_a, problem.a), swapped});
    };
    for (std::size_t c = 0; c < n_classes; ++c) {
      if (whole.within_a) {
        add({whole.boxes_a, whole.boxes_a, a.of(c), a.below(c), true}, false);
      } else {
        add({whole.boxes_a, whole.boxes_b, a.of(c), b.below(c + 1), false}, false);
        add({whole.boxes_b, whole.boxes_a, b.of(c), a.below(c), false}, true);
      }
    }
    return parts;
  }

  void check_memory(Boxes boxes_a, Boxes boxes_b, const TheBox& bounds) const {
    const double size = options_.voxel_size;
    if (!std::isfinite(size))
      fail(ErrorCode::bad_value, "pairs: voxel size ", size,
           " is not finite; give 0 to have it chosen");
    double n_entries = 0;
    std::array<double, D> most;  // voxels per axis
    for (std::size_t k = 0; k < D; ++k)
      most[k] = 1 + (static_cast<double>(bounds.hi[k]) - static_cast<double>(bounds.lo[k])) / size;
    for (const Boxes boxes : {boxes_a, boxes_b})
      for (const TheBox& box : boxes) {
        double n = 1;
        for (std::size_t k = 0; k < D; ++k)
          n *= std::min(
              most[k],
              1 + (static_cast<double>(box.hi[k]) - static_cast<double>(box.lo[k])) / size);
        n_entries += n;
      }
    const auto n = static_cast<double>(boxes_a.size() + boxes_b.size());
    if (n_entries > 64 * n + 0x1p20)
      fail(ErrorCode::bad_value, "pairs: voxel size ", size, " puts ", n, " objects into about ",
           n_entries, " voxels, which takes ", 12e-9 * n_entries,
           " GB; give a larger one, or 0 to have it chosen");
  }

  const PairOptions options_;
  VoxelSearch<Real, D> search_;
};

template <class Real, std::size_t D>
void check_count(std::size_t n) {
  if (n > most_objects)
    fail(ErrorCode::bad_value, "pairs: ", n, " objects; the limit of a search is ", most_objects,
         ": divide the set, or use a collider on several processes");
}

std::vector<Entry> all_entries(std::size_t n) {
  std::vector<Entry> out(n);
  for (std::uint32_t i = 0; i < n; ++i) out[i] = make_entry(i, 0);
  return out;
}

/// The number of models, up to 3, and an object of the second.
struct Models {
  int n = 0;
  std::uint32_t second = 0;
};
Models count(std::span<const std::uint32_t> models) {
  Models out{models.empty() ? 0 : 1, 0};
  for (const std::uint32_t model : models) {
    if (model == models[0]) continue;
    if (out.n == 1) out = {2, model};
    if (model != out.second) return {3, 0};
  }
  return out;
}

}  // namespace

template <class Real, std::size_t D>
void search_pairs(std::span<const Box<Real, D>> boxes, const PairOptions& options, PairSink sink) {
  check_count<Real, D>(boxes.size());
  const bool by_model = !options.models.empty() && !options.within_model;
  if (by_model && options.models.size() != boxes.size())
    fail(ErrorCode::bad_value, "pairs: ", options.models.size(), " models for ", boxes.size(),
         " objects; give one per object");
  const Models models = by_model ? count(options.models) : Models{};
  Plan<Real, D> plan(options, models.n > 2, sink);
  const Box<Real, D> bounds = checked_bounds(boxes, "");
  if (models.n == 1) {
    if (options.statistics != nullptr) {
      *options.statistics = {};
      options.statistics->n_left_out = boxes.size();
    }
    return;
  }
  if (models.n != 2) return plan.run(boxes, all_entries(boxes.size()), {}, {}, true, bounds);
  // Two models are two sets.
  std::vector<Entry> of_first, of_second;
  of_first.reserve(boxes.size());
  of_second.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    (options.models[i] == models.second ? of_second : of_first).push_back(make_entry(i, 0));
  plan.run(boxes, of_first, boxes, of_second, false, bounds);
}

template <class Real, std::size_t D>
void search_pairs(std::span<const Box<Real, D>> a, std::span<const Box<Real, D>> b,
                  const PairOptions& options, PairSink sink) {
  check_count<Real, D>(a.size());
  check_count<Real, D>(b.size());
  Plan<Real, D> plan(options, false, sink);
  const Box<Real, D> bounds_a = checked_bounds(a, " of the first set");
  const Box<Real, D> bounds_b = checked_bounds(b, " of the second set");
  if (a.empty() || b.empty()) return;
  plan.run(a, all_entries(a.size()), b, all_entries(b.size()), false, merged(bounds_a, bounds_b));
}

#define TESS_INSTANTIATE(Real, D)                                                          \
  template void search_pairs(std::span<const Box<Real, D>>, const PairOptions&, PairSink); \
  template void search_pairs(std::span<const Box<Real, D>>, std::span<const Box<Real, D>>, \
                             const PairOptions&, PairSink);
TESS_FOR_EACH_KIND_OF_BOX(TESS_INSTANTIATE)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::detail
