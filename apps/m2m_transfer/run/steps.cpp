#include "apps/m2m_transfer/run/steps.hpp"

#include "runtime/more/when.hpp"

#include <algorithm>

namespace m2m_transfer {
namespace {

void keep_least(double& least, double value) {
  least = least == 0 ? value : std::min(least, value);
}

}  // namespace

TransferOptions options_of(const Problem& problem) {
  TransferOptions options;
  options.voxel_size = problem.voxel;
  options.policy = problem.policy;
  options.kind = problem.kind;
  options.tolerance = problem.tolerance;
  options.clamp = problem.clamp;
  options.order = problem.order;
  return options;
}

GraphRun::GraphRun(Problem& problem, std::vector<DistributedMesh>& meshes, kit::Progress& progress)
    : problem_(problem),
      meshes_(meshes),
      progress_(progress),
      on_phase_([&progress](const char* name) { progress.phase(name); }) {
  TransferOptions options = options_of(problem);
  options.on_phase = &on_phase_;
  for (const Pair& pair : problem.pairs)
    transfers_.emplace_back(meshes[pair.source], meshes[pair.target], options);
  found_.resize(problem.pairs.size());
  seconds_.resize(problem.pairs.size());
  searches_.resize(problem.pairs.size());
  motions_.resize(meshes.size());
  for (std::size_t m = 0; m < meshes.size(); ++m) origin_.push_back(m);
}

Task GraphRun::search() {
  std::vector<TaskOf<SearchSummary>> tasks;
  tasks.reserve(transfers_.size());
  for (Transfer& transfer : transfers_) tasks.push_back(transfer.search());
  found_ = co_await tess::when_all(std::move(tasks));
  for (std::size_t p = 0; p < transfers_.size(); ++p) {
    seconds_[p].broad = found_[p].broad;
    seconds_[p].narrow = found_[p].narrow;
    ++searches_[p];
  }
}

Task GraphRun::steps() {
  for (std::int32_t step = 0; step < problem_.steps; ++step) {
    if (problem_.steps > 1) progress_.part(step + 1, problem_.steps);
    if (step != 0) co_await move_meshes();
    progress_.phase("apply");
    co_await apply_levels(!audits_.empty() && step + 1 == problem_.steps);
  }
}

Task GraphRun::steps_with_audits() {
  audits_.resize(problem_.pairs.size());
  return steps();
}

Task GraphRun::move_meshes() {
  bool moved = false;
  for (std::size_t m = 0; m < meshes_.size(); ++m)
    for (StepMotion& step : problem_.meshes[m].motions) {
      const RigidMotion motion = step.motion;
      // One after the other: broadcasts of one epoch may overtake each other.
      co_await epoch([&] { meshes_[m].workers.broadcast<&Worker::move>(motion); });
      motions_[m].push_back(motion);
      move_centres(problem_.meshes[m].motions, motion);
      moved = true;
    }
  if (moved) co_await search_again();
}

Task GraphRun::search_again() {
  std::vector<TaskOf<SearchSummary>> tasks;
  std::vector<std::size_t> pairs;
  tasks.reserve(transfers_.size());
  for (std::size_t p = 0; p < transfers_.size(); ++p) {
    const Pair& pair = problem_.pairs[p];
    if (problem_.source_of(pair).motions.empty() && problem_.target_of(pair).motions.empty())
      continue;
    tasks.push_back(transfers_[p].search());
    pairs.push_back(p);
  }
  std::vector<SearchSummary> found = co_await tess::when_all(std::move(tasks));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::size_t p = pairs[k];
    found_[p] = std::move(found[k]);
    keep_least(seconds_[p].again, found_[p].broad + found_[p].narrow);
    ++searches_[p];
  }
}

Task GraphRun::apply_levels(bool audited) {
  std::size_t n_levels = 0;
  for (const Pair& pair : problem_.pairs) n_levels = std::max(n_levels, pair.level + 1);
  for (std::size_t level = 0; level < n_levels; ++level) {
    std::vector<std::size_t> pairs;
    for (std::size_t p = 0; p < transfers_.size(); ++p)
      if (problem_.pairs[p].level == level) pairs.push_back(p);
    if (audited)
      for (const std::size_t p : pairs) co_await audit_source(p);
    std::vector<Task> tasks;
    tasks.reserve(pairs.size());
    for (const std::size_t p : pairs) tasks.push_back(apply(p));
    co_await tess::when_all(std::move(tasks));
    for (const std::size_t p : pairs)
      origin_[problem_.pairs[p].target] = origin_[problem_.pairs[p].source];
    if (audited)
      for (const std::size_t p : pairs) co_await audit_target(p);
  }
}

Task GraphRun::apply(std::size_t pair) {
  const Time begin = now();
  co_await transfers_[pair].apply();
  keep_least(seconds_[pair].apply, seconds_since(begin));
}

Task GraphRun::audit_source(std::size_t pair) {
  const std::size_t source = problem_.pairs[pair].source;
  std::vector<FormulaField> zeros(problem_.field_names.size(), {"0", {}});
  audits_[pair].source =
      co_await measure_norms(meshes_[source], problem_.meshes[source].name, std::move(zeros));
}

/// Compares with the formulas at the places where the target is now. The formulas follow the mesh
/// that the values were sampled on.
Task GraphRun::audit_target(std::size_t pair) {
  const std::size_t target = problem_.pairs[pair].target;
  const RunMesh& mesh = problem_.meshes[target];
  std::vector<FormulaField> truth;
  for (const std::string& name : problem_.field_names) truth.push_back({name, problem_.domain});
  audits_[pair].target =
      co_await measure_norms(meshes_[target], mesh.name, std::move(truth), back(target));
  audits_[pair].result_hash = co_await hash_values(meshes_[target], mesh.survey.n_points,
                                                   scalar_columns(problem_.field_names.size()));
}

Task GraphRun::destroy() {
  co_await epoch([&] {
    for (Transfer& transfer : transfers_) transfer.destroy();
  });
}

}  // namespace m2m_transfer
