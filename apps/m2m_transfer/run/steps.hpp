// Runs the steps of a graph: a handle per pair, which is searched once, or again after a motion.
#pragma once

#include "apps/m2m_transfer/run/meshes.hpp"

#include <functional>
#include <vector>

namespace m2m_transfer {

class GraphRun {
 public:
  /// Called when a pair was applied for the last time and its target has these values.
  using AtEnd = std::function<void(std::size_t pair, const Gathered& result)>;

  /// `problem` and `meshes` outlive the run. Its meshes move with the steps.
  GraphRun(Problem& problem, std::vector<DistributedMesh>& meshes, apps::Progress& progress);

  /// Searches all pairs at once.
  Task search();
  /// All steps. Fills in the fastest times of searches again and of applications.
  Task steps();
  /// The result of every pair: gathered after the pair's level in the last step if a later pair
  /// overwrites it, otherwise now. Call before destroy().
  Task finish(const AtEnd& at_end);
  Task destroy();

  /// The mesh whose motion the values of a mesh follow: the one that they were sampled on.
  [[nodiscard]] std::size_t origin(std::size_t mesh) const { return origin_[mesh]; }
  /// The motions made so far.
  [[nodiscard]] const std::vector<RigidMotion>& motions(std::size_t mesh) const {
    return motions_[mesh];
  }
  [[nodiscard]] const std::vector<SearchSummary>& found() const { return found_; }
  [[nodiscard]] const std::vector<PhaseSeconds>& seconds() const { return seconds_; }
  [[nodiscard]] std::int32_t searches() const { return searches_; }

 private:
  Task move_meshes();
  Task search_again();
  Task apply_levels(bool last);
  Task apply(std::size_t pair);
  [[nodiscard]] bool is_overwritten(std::size_t pair) const;

  Problem& problem_;
  std::vector<DistributedMesh>& meshes_;
  apps::Progress& progress_;
  std::vector<Transfer> transfers_;
  std::vector<SearchSummary> found_;
  std::vector<PhaseSeconds> seconds_;
  std::vector<Gathered> early_;  // per pair; empty: gathered at the end
  std::vector<std::size_t> origin_;
  std::vector<std::vector<RigidMotion>> motions_;
  std::int32_t searches_ = 0;
};

}  // namespace m2m_transfer
