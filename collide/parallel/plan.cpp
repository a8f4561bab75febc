#include "collide/parallel/plan.hpp"

#include "collide/problem/choose_grid.hpp"
#include "collide/problem/octaves.hpp"
#include "collide/problem/survey.hpp"
#include "collide/search/choose_pieces.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace tess::collide {

namespace {

/// Boxes from which the voxels are chosen. All PEs wait for the one that chooses, so with many of
/// them these are fewer.
std::size_t most_sampled(std::int32_t n_pes) {
  return n_pes <= 64 ? 4096 : 2048;
}

constexpr std::size_t few_sampled = 16;

/// The values of the PEs, in the order of the PEs.
template <class Value>
std::vector<Value> by_pe(const std::vector<Summary::Sampled>& sampled,
                         const std::vector<Value>& values) {
  struct Run {
    std::int32_t pe;
    std::uint32_t begin, end;
  };
  std::vector<Run> runs;
  std::uint32_t at = 0;
  for (const Summary::Sampled& of_pe : sampled) {
    runs.push_back({of_pe.pe, at, at + of_pe.n});
    at += of_pe.n;
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.pe < b.pe; });
  std::vector<Value> ordered;
  ordered.reserve(values.size());
  for (const Run& run : runs)
    ordered.insert(ordered.end(), values.begin() + run.begin, values.begin() + run.end);
  return ordered;
}

}  // namespace

Summary::Summary(const ObjectList& objects, std::int32_t pe, std::size_t n_sampled)
    : n(objects.size()), bounds(objects.bounds()), has_capsules(objects.has_capsules()) {
  for (std::uint32_t octave = 0; octave < search::Octaves::n; ++octave)
    if (objects.has_octave(octave)) octaves.add(octave);
  for (const ObjectList::Source& source : objects.sources()) add(source.model);
  if (n != 0 && !has_capsules) largest_radius = unknown_capsule.radius;
  for (std::uint32_t i = 0; has_capsules && i < objects.size(); ++i)
    add(objects.boxes()[i], objects.capsule(i));
  const std::size_t n_taken = std::min<std::size_t>(n, n_sampled);
  // The few of many PEs have other places on each: clients often submit in the same order
  // everywhere, such as one model first.
  const std::size_t seed = n_taken <= few_sampled ? static_cast<std::size_t>(pe) : 0;
  for (std::size_t i = 0; i < n_taken; ++i) {
    const std::size_t at = search::scattered(i, n_taken, n, seed);
    const auto object = static_cast<std::uint32_t>(at);
    sample.push_back(objects.boxes()[at]);
    sample_models.push_back(static_cast<std::uint32_t>(objects.model(object)));
    if (has_capsules) capsules.push_back(objects.capsule(object));
  }
  if (n_taken != 0) sampled.push_back({pe, static_cast<std::uint32_t>(n_taken)});
}

void Summary::add(ModelId model) {
  if (models.size() < 3 && std::find(models.begin(), models.end(), model) == models.end())
    models.push_back(model);
}

void Summary::add(const Aabb& box, const Capsule& capsule) {
  const double length = search::longest_extent(capsule);
  // A box that is not divided remains as it is. False for a NaN.
  const bool is_close = search::longest_extent(box) <= 2 * (length + 2 * capsule.radius);
  longest_capsule = std::max(longest_capsule, length);
  largest_radius = std::max(largest_radius, is_close ? capsule.radius : unknown_capsule.radius);
}

Summary JoinSummaries::combine(Summary a, const Summary& b) const {
  a.n += b.n;
  a.bounds = merged(a.bounds, b.bounds);
  a.has_capsules = a.has_capsules || b.has_capsules;
  a.longest_capsule = std::max(a.longest_capsule, b.longest_capsule);
  a.largest_radius = std::max(a.largest_radius, b.largest_radius);
  if (a.has_capsules) {
    a.capsules.resize(a.sample.size(), unknown_capsule);
    a.capsules.insert(a.capsules.end(), b.capsules.begin(), b.capsules.end());
    a.capsules.resize(a.sample.size() + b.sample.size(), unknown_capsule);
  }
  a.sample.insert(a.sample.end(), b.sample.begin(), b.sample.end());
  a.sample_models.insert(a.sample_models.end(), b.sample_models.begin(), b.sample_models.end());
  a.sampled.insert(a.sampled.end(), b.sampled.begin(), b.sampled.end());
  a.octaves.add(b.octaves);
  for (const ModelId model : b.models) a.add(model);
  return a;
}

Summary JoinSummaries::finish(Summary all) const {
  all.sample = by_pe(all.sampled, all.sample);
  all.sample_models = by_pe(all.sampled, all.sample_models);
  if (all.has_capsules) all.capsules = by_pe(all.sampled, all.capsules);
  return all;
}

VoxelGrid Plan::grid(Level level) const {
  Point scaled = size;
  // The largest extents have voxels of the largest size.
  for (double& edge : scaled)
    edge = std::min(std::ldexp(edge, 3 * level), std::numeric_limits<double>::max());
  return {origin, scaled};
}

Level Plan::level_of(double longest_extent) const noexcept {
  const search::SizeLevels by_size(2 * std::ranges::min(size));
  return std::min(by_size.of(longest_extent), most_levels - 1);
}

namespace {

double chosen_size(const Summary& summary, std::int32_t n_pes) {
  const std::size_t n_sampled = summary.sample.size();
  std::vector<search::Entry> all(std::min(n_sampled, most_sampled(n_pes)));
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = search::make_entry(static_cast<std::uint32_t>(i * n_sampled / all.size()), 0);
  const search::Problem<double, 3> problem{
      summary.sample.data(), summary.sample.data(), all, {}, true};
  search::GridChooser<double, 3> chooser;
  const double scale =
      static_cast<double>(summary.n) / std::max<double>(1, static_cast<double>(all.size()));
  const auto edge_of = [&](const search::Choice<3>& choice) {
    double edge = 0;
    for (std::size_t k = 0; k < 3; ++k)
      edge = std::max(edge, (summary.bounds.hi[k] - summary.bounds.lo[k]) / choice.n_cells[k]);
    return edge;
  };
  const search::Place chares{true, static_cast<double>(n_pes)};
  const search::Choice<3> whole = chooser.choose(problem, summary.bounds, false, scale, chares);
  const search::Choice<3> points =
      chooser.choose_again(problem, summary.bounds, true, scale, chares);
  double size = edge_of(whole);
  if (whole.cost > 4 * points.cost) {
    // Large objects ask for large voxels, in which too many small ones meet: the smallest objects
    // decide, and the others stand on higher levels.
    const double least = search::size_of_octave<double>(summary.octaves.least());
    size = std::min(size, std::max(edge_of(points), least));
  }
  // Objects that are a little too large for the voxels would stand on a level of few voxels, each
  // of which has to meet all small objects in it.
  const double fitting = search::size_of_octave<double>(summary.octaves.greatest());
  return size < fitting && fitting <= 2 * size ? fitting : size;
}

PlanOfPieces choose_pieces(const Summary& summary, const ColliderOptions& options) {
  if (!summary.has_capsules) return {};
  const search::Frame frame = search::frame_of(summary.bounds);
  if (options.piece_length != 0) return {true, options.piece_length, frame};
  if (options.voxel_size != Point{0, 0, 0})
    return {true, search::ThinObjects<double>::whole, frame};
  const detail::Capsules capsules{summary.capsules.data(), [](const void* of, std::size_t i) {
                                    return static_cast<const Capsule*>(of)[i];
                                  }};
  const search::ThinSet<double> sample{summary.sample, capsules};
  const std::optional<double> longest = search::choose_pieces(
      search::ThinSets<double>(&sample, 1), {.touching = options.rules.touching},
      static_cast<double>(summary.n) / static_cast<double>(summary.sample.size()));
  return {longest.has_value(), longest.value_or(0), frame};
}

/// As if the pieces had been submitted. They may be of any size up to the largest, which this
/// estimates.
Summary divided(const Summary& summary, double longest) {
  Summary out = summary;
  out.sample.clear();
  search::BoxesOfPieces<double> pieces;
  for (std::size_t i = 0; i < summary.sample.size(); ++i) {
    const Capsule& capsule = summary.capsules[i];
    const Aabb* const end =
        search::cut(summary.sample[i], capsule, search::n_pieces(capsule, longest), pieces.data());
    out.sample.insert(out.sample.end(), static_cast<const Aabb*>(pieces.data()), end);
  }
  if (!summary.sample.empty()) out.n = summary.n * out.sample.size() / summary.sample.size();
  const double largest =
      std::max(longest, summary.longest_capsule / search::most_pieces) + 2 * summary.largest_radius;
  const std::uint32_t greatest = summary.octaves.greatest();
  const bool is_known = largest < std::numeric_limits<double>::infinity();
  out.octaves =
      search::Octaves::up_to(is_known ? std::min(greatest, search::octave_of(largest)) : greatest);
  return out;
}

}  // namespace

std::size_t n_sampled_per_pe(const Point& size, std::int32_t n_pes) noexcept {
  if (size != Point{0, 0, 0}) return 0;
  return std::max<std::size_t>(2, most_sampled(n_pes) / static_cast<std::size_t>(n_pes));
}

Plan make_plan(const Summary& summary, std::int32_t n_pes, const ColliderOptions& options,
               std::uint64_t step) {
  Plan plan{step, options.origin,         options.voxel_size, 0, true, options.rules,
            {},   options.simulated_costs};
  if (summary.n < 2 ||
      (options.rules.within_model == WithinModel::skip && summary.models.size() == 1))
    return plan;
  plan.nothing = false;
  plan.pieces = choose_pieces(summary, options);
  std::optional<Summary> of_pieces;
  if (plan.pieces.used && std::isfinite(plan.pieces.longest))
    of_pieces = divided(summary, plan.pieces.longest);
  const Summary& boxes = of_pieces ? *of_pieces : summary;
  const bool is_chosen = options.voxel_size == Point{0, 0, 0};
  double widest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double lo = boxes.bounds.lo[k], hi = boxes.bounds.hi[k];
    widest = std::max(widest, hi - lo);
    if (is_chosen && !std::isfinite(widest))
      fail(ErrorCode::out_of_range, "collider: the objects reach from ", lo, " to ", hi,
           " on axis ", k, ", further than numbers do; scale them down");
  }
  if (is_chosen) {
    plan.origin = boxes.bounds.lo;
    double edge = chosen_size(boxes, n_pes);
    // Indices have 32 bits, with a margin for what rounding does.
    edge = std::clamp(std::max(edge, std::ldexp(widest, -30)), 1e-300, 1e300);
    plan.size = {edge, edge, edge};
  }
  for (std::uint32_t octave = 0; octave < search::Octaves::n; ++octave) {
    if (!boxes.octaves.has(octave)) continue;
    // From its least to its greatest size.
    const double least = octave == 0 ? 0 : search::size_of_octave<double>(octave);
    const double most = search::size_of_octave<double>(octave + 1);
    for (Level l = plan.level_of(least); l <= plan.level_of(most); ++l) plan.levels |= 1U << l;
  }
  static_cast<void>(plan.grid(0).cells_of(boxes.bounds));  // throws
  return plan;
}

}  // namespace tess::collide
