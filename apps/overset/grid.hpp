// A piece of one of the meshes, as a chare of the program: it holds its part of the mesh and
// the values, and the library sees spans. What the library does for it is Piece and Blanking.
#pragma once

#include "m2m/coupling.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/overset.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace overset {

/// What a piece starts from. Its part has a halo of as many layers as the fringe.
struct GridLoad {
  tess::m2m::MeshPart part;
  std::vector<std::uint8_t> on_outer{};  ///< per point of the part, or empty
  std::vector<tess::m2m::Wall> walls{};  ///< of the other meshes, as seen from the part
  std::vector<double> values{};          ///< per point of the part
  tess::m2m::BlankingOptions options{};
};

/// The points that pieces own, in any order.
struct Rows {
  std::vector<tess::m2m::GlobalId> points{};
  std::vector<std::int32_t> iblank{};
  std::vector<double> quality{}, values{};
};
struct JoinRows {
  Rows operator()(Rows a, const Rows& b) const;
};

class Grid : public tess::Chare<Grid, tess::Index1>, public tess::m2m::Piece<Grid> {
 public:
  void load(GridLoad load) { load_ = std::move(load); }
  /// Blanks the points within the walls; the value of a hole becomes 0.
  void cut();
  /// Decides which fringe points have donors in the mesh with this number.
  void settle(tess::m2m::CouplingId from, std::int32_t mesh_number) {
    blanking_.settle(mesh_view(), from, status(from), mesh_number);
  }
  /// Writes the values that have arrived from the mesh to the fringe.
  void use(tess::m2m::CouplingId from, std::int32_t mesh_number);
  void report(tess::Callback<tess::m2m::BlankingReport> result) {
    contribute(tess::m2m::JoinBlankingReports{}, blanking_.report(mesh_view()), std::move(result));
  }
  void gather(tess::Callback<Rows> result);

  // What couplings call.
  [[nodiscard]] tess::m2m::MeshView mesh_view() const { return tess::m2m::view_of(load_.part); }
  [[nodiscard]] std::span<const double> flags() const { return blanking_.flags(); }
  [[nodiscard]] std::span<double> offered(tess::m2m::CouplingId from) {
    return blanking_.offered(from);
  }
  [[nodiscard]] std::span<const double> values() const { return load_.values; }
  [[nodiscard]] std::span<double> taken(tess::m2m::CouplingId from);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, load_, blanking_, taken_);
  }

 private:
  GridLoad load_;
  tess::m2m::Blanking blanking_;
  std::map<tess::m2m::CouplingId, std::vector<double>> taken_;  // per point owned
};

}  // namespace overset
