#include "collide/parallel/plan.hpp"

#include "collide/search/choose_grid.hpp"
#include "collide/search/survey.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tess::collide {

namespace {

/// Boxes from which the voxels are chosen. All PEs wait for the one that chooses, so with many of
/// them these are fewer.
std::size_t most_sampled(std::int32_t n_pes) {
  return n_pes <= 64 ? 4096 : 2048;
}

}  // namespace

Summary::Summary(const ObjectList& objects, std::int32_t pe, std::size_t n_sampled)
    : n(objects.size()), bounds(objects.bounds()) {
  for (std::size_t octave = 0; octave < search::n_octaves<double>; ++octave)
    if (objects.has_octave(octave)) octaves[octave / 64] |= std::uint64_t{1} << octave % 64;
  for (const ObjectList::Source& source : objects.sources()) add(source.model);
  const std::size_t n_taken = std::min<std::size_t>(n, n_sampled);
  for (std::size_t i = 0; i < n_taken; ++i)
    sample.push_back(objects.boxes()[search::scattered(i, n_taken, n)]);
  if (n_taken != 0) sampled.push_back({pe, static_cast<std::uint32_t>(n_taken)});
}

void Summary::add(ModelId model) {
  if (models.size() < 3 && std::find(models.begin(), models.end(), model) == models.end())
    models.push_back(model);
}

Summary JoinSummaries::combine(Summary a, const Summary& b) const {
  a.n += b.n;
  a.bounds = merged(a.bounds, b.bounds);
  a.sample.insert(a.sample.end(), b.sample.begin(), b.sample.end());
  a.sampled.insert(a.sampled.end(), b.sampled.begin(), b.sampled.end());
  for (std::size_t i = 0; i < a.octaves.size(); ++i) a.octaves[i] |= b.octaves[i];
  for (const ModelId model : b.models) a.add(model);
  return a;
}

Summary JoinSummaries::finish(Summary all) const {
  struct Run {
    std::int32_t pe;
    std::uint32_t begin, end;
  };
  std::vector<Run> runs;
  std::uint32_t at = 0;
  for (const Summary::Sampled& sampled : all.sampled) {
    runs.push_back({sampled.pe, at, at + sampled.n});
    at += sampled.n;
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.pe < b.pe; });
  std::vector<Aabb> ordered;
  ordered.reserve(all.sample.size());
  for (const Run& run : runs)
    ordered.insert(ordered.end(), all.sample.begin() + run.begin, all.sample.begin() + run.end);
  all.sample = std::move(ordered);
  return all;
}

VoxelGrid Plan::grid(Level level) const {
  Point scaled = size;
  for (double& edge : scaled) edge = std::ldexp(edge, 3 * level);
  return {origin, scaled};
}

Level Plan::level_of(double longest_extent) const noexcept {
  Level level = 0;
  double most = 2 * std::min({size[0], size[1], size[2]});
  for (; longest_extent > most && level + 1 < most_levels; most *= 8) ++level;
  return level;
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
    std::uint32_t least = 0;
    while ((summary.octaves[least / 64] >> least % 64 & 1U) == 0) ++least;
    size = std::min(size, std::max(edge_of(points), search::size_of_octave<double>(least)));
  }
  return size;
}

}  // namespace

std::size_t n_sampled_per_pe(const Point& size, std::int32_t n_pes) noexcept {
  if (size != Point{0, 0, 0}) return 0;
  return std::max<std::size_t>(2, most_sampled(n_pes) / static_cast<std::size_t>(n_pes));
}

Plan make_plan(const Summary& summary, std::int32_t n_pes, const Point& origin, const Point& size,
               PairRules rules, std::uint64_t step) {
  Plan plan{step, origin, size, 0, true, rules};
  if (summary.n < 2 || (rules.within_model == WithinModel::skip && summary.models.size() == 1))
    return plan;
  plan.nothing = false;
  const bool is_chosen = size == Point{0, 0, 0};
  double widest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    widest = std::max(widest, summary.bounds.hi[k] - summary.bounds.lo[k]);
  if (is_chosen) {
    plan.origin = summary.bounds.lo;
    double edge = chosen_size(summary, n_pes);
    // Indices have 32 bits, with a margin for what rounding does.
    edge = std::clamp(std::max(edge, std::ldexp(widest, -30)), 1e-300, 1e300);
    plan.size = {edge, edge, edge};
  }
  for (std::uint32_t octave = 0; octave < 2048; ++octave) {
    if ((summary.octaves[octave / 64] >> octave % 64 & 1U) == 0) continue;
    // From its least to its greatest size.
    const double least = octave == 0 ? 0 : search::size_of_octave<double>(octave);
    for (Level l = plan.level_of(least); l <= plan.level_of(2 * least); ++l) plan.levels |= 1U << l;
  }
  static_cast<void>(plan.grid(0).cells_of(summary.bounds));  // throws
  return plan;
}

}  // namespace tess::collide
