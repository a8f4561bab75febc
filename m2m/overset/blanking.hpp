// What a piece of an overset mesh knows of its points: their roles, and the donors of its fringe.
// A member of the application's chare. It knows no message: a coupling takes flags() from the
// pieces of one mesh to offered() of another, as it takes fields. Each coupling has its own.
#pragma once

#include "m2m/coupling_id.hpp"
#include "m2m/overset/roles.hpp"
#include "m2m/status.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace tess::m2m {

/// A fringe point without a donor that can be used.
struct Orphan {
  enum class Reason : std::uint8_t {
    outside,       ///< no other mesh holds it
    hole,          ///< its donor has a corner in a hole
    least_quality  ///< the quality of its donor is below the least
  };
  GlobalId point = 0;
  Point at{};
  Reason reason = Reason::outside;
  friend bool operator==(const Orphan&, const Orphan&) = default;
};
[[nodiscard]] const char* name_of(Orphan::Reason reason) noexcept;

/// Counts over the points that a piece owns, or over those of many pieces.
struct BlankingReport {
  static constexpr std::size_t most_listed = 1000;

  std::uint64_t n_field = 0, n_hole = 0;
  std::uint64_t n_fringe = 0;  ///< with a donor
  std::uint64_t n_orphans = 0;
  std::uint64_t n_full = 0;       ///< fringe points with a donor of quality 1
  double least_quality = 1;       ///< of all donors
  std::vector<Orphan> orphans{};  ///< those with the lowest ids, at most `most_listed`
};
/// Joins reports in a reduction; the result does not depend on the order.
struct JoinBlankingReports {
  BlankingReport operator()(BlankingReport a, const BlankingReport& b) const;
};

class Blanking {
 public:
  /// The usual numbers of the field (PLOT3D, PEGASUS, Suggar++): a fringe point has minus the
  /// number of the mesh that it takes its value from.
  static constexpr std::int32_t hole = 0, field = 1, orphan = 101;

  /// Assigns the roles anew (roles_of()); fringe points have no donor yet. Until settle(), the
  /// coordinates stay as they are.
  void cut(const MeshView& mesh, std::span<const Wall> walls,
           std::span<const std::uint8_t> on_outer, BlankingOptions options = {});

  /// Per point of the piece.
  [[nodiscard]] std::span<const Role> roles() const { return roles_; }
  /// What a coupling gives: n_points × 2, (1 at a hole, 1 at a field point).
  [[nodiscard]] std::span<const double> flags() const { return flags_; }
  /// What it takes: n_owned × 2, the same interpolated. Kept until settle().
  [[nodiscard]] std::span<double> offered(CouplingId from);

  /// Call it after the coupling `from` has taken the flags of the mesh with number `mesh_number` (1
  /// or more), each time once. `status`: of that coupling, per point owned. Fringe points take the
  /// donor of the best quality; of equal ones that of the lower mesh. So couplings may come in any
  /// order.
  void settle(const MeshView& mesh, CouplingId from, std::span<const Status> status,
              std::int32_t mesh_number);

  /// Per point owned: hole, field, orphan, or minus the number of the donor's mesh.
  [[nodiscard]] std::span<const std::int32_t> iblank() const { return iblank_; }
  /// Per point owned: the sum of a donor's weights at field points, from 0 to 1; 1 means that all
  /// values are computed ones, 0 that all are interpolated ones. 1 at field points, 0 elsewhere.
  [[nodiscard]] std::span<const double> quality() const { return quality_; }
  [[nodiscard]] BlankingReport report(const MeshView& mesh) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(options_, roles_, flags_, offered_, iblank_, quality_, reasons_);
  }

 private:
  BlankingOptions options_;
  std::vector<Role> roles_;                            // per point
  std::vector<double> flags_;                          // per point × 2
  std::vector<std::int32_t> iblank_;                   // per point owned
  std::vector<double> quality_;                        // per point owned
  std::vector<Orphan::Reason> reasons_;                // per point owned; of orphans
  std::map<CouplingId, std::vector<double>> offered_;  // per point owned × 2
};

}  // namespace tess::m2m
