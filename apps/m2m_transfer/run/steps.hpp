// Runs the steps of a graph: a handle per pair, which is searched once, or again after a motion.
#pragma once

#include "apps/m2m_transfer/run/meshes.hpp"
#include "m2m/field_norms.hpp"
#include "m2m/transfer.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace m2m_transfer {

/// What a pair did when it was applied for the last time.
struct PairAudit {
  std::vector<FieldNorms> source;  ///< per field: what it read
  std::vector<FieldNorms> target;  ///< per field: what it wrote, against the formulas
  std::uint64_t result_hash = 0;   ///< of what it wrote
};

/// What all pairs of a run have in common.
TransferOptions options_of(const Problem& problem);

class GraphRun {
 public:
  /// `problem` and `meshes` outlive the run, and the meshes move with the steps.
  GraphRun(Problem& problem, std::vector<DistributedMesh>& meshes, kit::Progress& progress);

  /// Searches all pairs at once.
  Task search();
  /// All steps. Fills in the fastest times of searches again and of applications.
  Task steps();
  /// The same, and audits every pair in the last step, before a later pair overwrites what it read
  /// and wrote.
  Task steps_with_audits();
  Task destroy();

  /// The motions that lead the points of a mesh to where the formulas hold that its values follow.
  [[nodiscard]] std::vector<RigidMotion> back(std::size_t mesh) const {
    return opposite(motions_[origin_[mesh]]);
  }
  /// The motions of a mesh so far.
  [[nodiscard]] const std::vector<RigidMotion>& made(std::size_t mesh) const {
    return motions_[mesh];
  }
  /// Per pair, after steps_with_audits().
  [[nodiscard]] const std::vector<PairAudit>& audits() const { return audits_; }
  [[nodiscard]] const std::vector<SearchSummary>& found() const { return found_; }
  [[nodiscard]] const std::vector<PhaseSeconds>& seconds() const { return seconds_; }
  [[nodiscard]] std::int32_t searches(std::size_t pair) const { return searches_[pair]; }

 private:
  Task move_meshes();
  Task search_again();
  Task apply_levels(bool audited);
  Task apply(std::size_t pair);
  Task audit_source(std::size_t pair);
  Task audit_target(std::size_t pair);

  Problem& problem_;
  std::vector<DistributedMesh>& meshes_;
  kit::Progress& progress_;
  const std::function<void(const char*)> on_phase_;
  std::vector<Transfer> transfers_;
  std::vector<SearchSummary> found_;
  std::vector<PhaseSeconds> seconds_;
  std::vector<PairAudit> audits_;    // empty: none are wanted
  std::vector<std::size_t> origin_;  // per mesh: the one whose values it has, as they were sampled
  std::vector<std::vector<RigidMotion>> motions_;  // per mesh, made so far
  std::vector<std::int32_t> searches_;             // per pair
};

}  // namespace m2m_transfer
