// A search for pairs: it chooses which sets are compared, on one level or on several.
#include "collide/pairs.hpp"

#include "collide/problem/instantiate.hpp"
#include "collide/problem/octaves.hpp"
#include "collide/problem/size_levels.hpp"
#include "collide/problem/survey.hpp"
#include "collide/search/thin_pairs.hpp"
#include "collide/search/voxel_search.hpp"
#include "runtime/core/error.hpp"

#include <optional>

namespace tess::collide::detail {
namespace {

using namespace search;

template <class Real, std::size_t D>
class Searcher {
  using TheBox = Box<Real, D>;
  using Boxes = std::span<const TheBox>;
  using Entries = std::vector<Entry>;

 public:
  Searcher(const PairOptions& options, bool by_model, PairSink sink)
      : options_(options), search_(options, by_model, sink) {}

  /// Pairs of `a` with `b`, or within `a` if `b` has no boxes.
  void run(Boxes boxes_a, const Entries& a, Boxes boxes_b, const Entries& b, bool within,
           const TheBox& bounds) {
    SubProblem whole{{boxes_a.data(), boxes_b.data(), a, b, within}, bounds};
    if (options_.voxel_size > 0) {
      check_memory(whole, bounds);
      solve(whole);
    } else if (!solved_on_one_level(whole)) {
      Levels levels(*this, whole, 1);
      if (levels.parts.size() > 1 && levels.cost < cost_of(whole)) {
        for (SubProblem& part : levels.parts) solve(part);
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
  struct SubProblem {
    Problem<Real, D> problem;
    TheBox bounds;                         // of the objects of a
    bool swapped = false;                  // a is the second set
    std::optional<Choice<D>> choice = {};  // once it is known
  };
  /// A problem divided by the sizes of its objects (size_levels.hpp): each level with itself and
  /// with all levels below.
  struct Levels {
    /// As if there were `scale` objects for each.
    Levels(Searcher& searcher, const SubProblem& whole, double scale)
        : Levels(searcher, whole, scale,
                 levels_of(whole, searcher.search_.chooser()
                                      .choose(whole.problem, whole.bounds, true, scale)
                                      .n_cells)) {}
    Levels(Searcher& searcher, const SubProblem& whole, double scale, const SizeLevels& levels)
        : by_level_a(whole.problem.boxes_a, whole.problem.a, levels),
          by_level_b(whole.problem.boxes_b, whole.problem.b, levels) {
      const Problem<Real, D>& all = whole.problem;
      const auto add = [&](const Problem<Real, D>& problem, bool swapped) {
        if (problem.n_comparisons() == 0) return;
        parts.push_back({problem, bounds_of(problem.boxes_a, problem.a), swapped});
        cost += searcher.cost_of(parts.back(), scale);
      };
      for (std::size_t l = 0; l < static_cast<std::size_t>(levels.n()); ++l) {
        const auto a = by_level_a.of(l), b = by_level_b.of(l);
        if (all.within_a) {
          add({all.boxes_a, all.boxes_a, a, by_level_a.below(l), true}, false);
        } else {
          add({all.boxes_a, all.boxes_b, a, by_level_b.below(l + 1), false}, false);
          add({all.boxes_b, all.boxes_a, b, by_level_a.below(l), false}, true);
        }
      }
    }

    ByLevel by_level_a, by_level_b;
    std::vector<SubProblem> parts;
    double cost = 0;
  };

  double cost_of(SubProblem& part, double scale = 1) {
    if (!part.choice)
      part.choice = search_.chooser().choose(part.problem, part.bounds, false, scale);
    return part.choice->cost;
  }
  void solve(const SubProblem& part) {
    static_cast<void>(search_.solve(part.problem, part.bounds, part.swapped, part.choice));
  }
  /// False, without a pair, if large objects touch so many voxels that levels may cost less.
  bool solved_on_one_level(SubProblem& whole) {
    const std::size_t n = whole.problem.a.size() + whole.problem.b.size();
    constexpr std::size_t many = 4096;
    if (n > many) {
      const double cost = cost_of(whole);  // the chooser has its sample now
      const Choice<D> points = search_.chooser().choose_again(whole.problem, whole.bounds, true);
      if (cost > 2 * points.cost && levels_seem_cheaper(whole)) return false;
    }
    search_.set_most_entries(4 * n + many);
    const bool solved = search_.solve(whole.problem, whole.bounds, false, whole.choice);
    search_.set_most_entries(~std::size_t{0});
    return solved;
  }
  /// From a sample: 4 096 of the objects, but at most an eighth, which costs little beside the
  /// search.
  bool levels_seem_cheaper(SubProblem& whole) {
    const double n = static_cast<double>(whole.problem.a.size() + whole.problem.b.size());
    const double scale = std::max(8.0, n / 4096);
    Entries a, b;
    const auto take = [&](std::span<const Entry> from, Entries& sample) {
      const auto n_sample =
          static_cast<std::size_t>(std::ceil(static_cast<double>(from.size()) / scale));
      for (std::size_t i = 0; i < n_sample; ++i)
        sample.push_back(from[scattered(i, n_sample, from.size())]);
    };
    take(whole.problem.a, a);
    take(whole.problem.b, b);
    SubProblem sample = whole;
    sample.problem.a = a;
    sample.problem.b = b;
    // Objects of one level are one part, whose cost is another estimate of the same search.
    const Levels levels(*this, sample, scale);
    return levels.parts.size() > 1 && levels.cost < cost_of(whole);
  }
  /// Level 0 has the octaves up to that of the voxel that would be chosen if all objects were
  /// points, or of the smallest object.
  static SizeLevels levels_of(const SubProblem& whole, const CellAt<D>& cells_of_points) {
    Real smallest = std::numeric_limits<Real>::infinity(), voxel = smallest;
    for (const Entry entry : whole.problem.a)
      smallest = std::min(smallest, longest_extent(whole.problem.boxes_a[object_of(entry)]));
    for (const Entry entry : whole.problem.b)
      smallest = std::min(smallest, longest_extent(whole.problem.boxes_b[object_of(entry)]));
    for (std::size_t k = 0; k < D; ++k)
      if (cells_of_points[k] > 1)
        voxel = std::min(voxel, (whole.bounds.hi[k] - whole.bounds.lo[k]) /
                                    static_cast<Real>(cells_of_points[k]));
    const Real most = std::max(std::isfinite(voxel) ? voxel : Real{0}, smallest);
    const double next_octave{size_of_octave<Real>(octave_of(most) + 1)};
    return SizeLevels(std::nextafter(next_octave, 0.0));
  }

  void check_memory(const SubProblem& whole, const TheBox& bounds) const {
    const double size = options_.voxel_size;
    double n_entries = 0;
    std::array<double, D> most;  // voxels per axis
    for (std::size_t k = 0; k < D; ++k)
      most[k] = 1 + (static_cast<double>(bounds.hi[k]) - static_cast<double>(bounds.lo[k])) / size;
    const auto add = [&](const TheBox* boxes, std::span<const Entry> entries) {
      for (const Entry entry : entries) {
        const TheBox& box = boxes[object_of(entry)];
        double n = 1;
        for (std::size_t k = 0; k < D; ++k)
          n *= std::min(
              most[k],
              1 + (static_cast<double>(box.hi[k]) - static_cast<double>(box.lo[k])) / size);
        n_entries += n;
      }
    };
    add(whole.problem.boxes_a, whole.problem.a);
    add(whole.problem.boxes_b, whole.problem.b);
    const auto n = static_cast<double>(whole.problem.a.size() + whole.problem.b.size());
    if (n_entries > 64 * n + 0x1p20)
      fail(ErrorCode::bad_value, "pairs: voxel size ", size, " puts ", n, " objects into about ",
           n_entries, " voxels, which takes ", 12e-9 * n_entries,
           " GB; give a larger one, or 0 to have it chosen");
  }

  const PairOptions options_;
  VoxelSearch<Real, D> search_;
};

/// Throws Error for what is no search, whatever the boxes are.
template <class TheBox>
void check(std::span<const ObjectSet<TheBox>> sets, const PairOptions& options) {
  const bool is_one_set = sets.size() == 1, by_model = divides(options);
  const std::size_t n_models = options.models.size(), n = sets.front().boxes.size();
  if (by_model && !is_one_set)
    fail(ErrorCode::bad_value, "pairs: ", n_models,
         " models for a search across two sets; models divide one set, pass the objects as one");
  if (!std::isfinite(options.voxel_size) || options.voxel_size < 0)
    fail(ErrorCode::bad_value, "pairs: voxel size ", options.voxel_size,
         " is no size; give a positive and finite one, or 0 to have it chosen");
  for (const ObjectSet<TheBox>& set : sets)
    if (set.boxes.size() > most_objects)
      fail(ErrorCode::bad_value, "pairs: ", set.boxes.size(), " objects; the limit of a search is ",
           most_objects, ": divide the set, or use a collider on several processes");
  if (!by_model && options.within_model == WithinModel::skip && is_one_set && n != 0)
    fail(ErrorCode::bad_value, "pairs: WithinModel::skip without models; give one per object");
  if (by_model && n_models != n)
    fail(ErrorCode::bad_value, "pairs: ", n_models, " models for ", n,
         " objects; give one per object");
}

/// The objects of a set that take part, and their bounds.
template <class Real, std::size_t D>
struct Searched {
  std::vector<Entry> entries;
  Box<Real, D> bounds = no_box<Real, D>();

  Searched() = default;
  Searched(std::span<const Box<Real, D>> boxes, const PairOptions& options, const char* set) {
    const bool all = options.invalid_boxes == InvalidBoxes::refuse;
    if (all) bounds = checked_bounds(boxes, set);
    entries.resize(boxes.size());
    std::size_t n = 0;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      entries[n] = make_entry(i, 0);
      n += all || is_valid(boxes[i]) ? 1U : 0U;
    }
    entries.resize(n);
    if (!all) bounds = bounds_of(boxes.data(), std::span<const Entry>(entries));
  }
};

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

template <class Real, std::size_t D>
void search_boxes(std::span<const ObjectSet<Box<Real, D>>> sets, const PairOptions& options,
                  PairSink sink) {
  check(sets, options);
  const bool is_one_set = sets.size() == 1;
  const Models models = divides(options) ? count(options.models) : Models{};
  Searcher<Real, D> searcher(options, models.n > 2, sink);
  const auto boxes_a = sets.front().boxes, boxes_b = sets.back().boxes;
  Searched<Real, D> a(boxes_a, options, is_one_set ? "" : " of the first set"), b;
  if (!is_one_set) b = Searched<Real, D>(boxes_b, options, " of the second set");
  std::size_t n_invalid = boxes_a.size() - a.entries.size();
  if (!is_one_set) n_invalid += boxes_b.size() - b.entries.size();
  PairStatistics unused, &statistics = options.statistics != nullptr ? *options.statistics : unused;
  statistics = {};
  if (models.n == 2) {  // which are two sets
    std::vector<Entry> of_first;
    of_first.reserve(a.entries.size());
    b.entries.reserve(a.entries.size());
    for (const Entry entry : a.entries)
      (options.models[object_of(entry)] == models.second ? b.entries : of_first).push_back(entry);
    a.entries.swap(of_first);
  }
  if (models.n == 1)
    statistics.grid.n_entries = statistics.grid.n_left_out = a.entries.size();
  else if (is_one_set && models.n != 2)
    searcher.run(boxes_a, a.entries, {}, {}, true, a.bounds);
  else if (!a.entries.empty() && !b.entries.empty())
    searcher.run(boxes_a, a.entries, boxes_b, b.entries, false, merged(a.bounds, b.bounds));
  statistics.n_invalid = n_invalid;
}

}  // namespace

template <class TheBox>
void search_pairs(std::span<const ObjectSet<TheBox>> sets, const PairOptions& options,
                  PairSink sink) {
  if constexpr (std::tuple_size_v<decltype(TheBox::lo)> == 3) {
    const bool have_capsules =
        sets.front().capsules.of != nullptr && sets.back().capsules.of != nullptr;
    if (have_capsules && options.invalid_boxes == InvalidBoxes::refuse)
      if (const std::optional<double> longest = choose_pieces(sets, options))
        return search_thin(sets, *longest, options, sink);
  }
  search_boxes(sets, options, sink);
}

#define TESS_INSTANTIATE(Real, D)                                                          \
  template void search_pairs(std::span<const ObjectSet<Box<Real, D>>>, const PairOptions&, \
                             PairSink);
TESS_FOR_EACH_KIND_OF_BOX(TESS_INSTANTIATE)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::detail
