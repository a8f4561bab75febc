// Finds the ghosts of the points of a mesh: which pieces hold a copy of a point that another piece
// owns. Every piece reports its points to the PE that a hash of the id names; that PE compares
// them, and reports to each piece the others that share the point.
#pragma once

#include "collide/collider.hpp"
#include "m2m/mesh.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// A point as one piece sees it.
struct PointReport {
  GlobalId id = 0;
  collide::OwnerId piece{};
  std::int32_t point = 0;       ///< local
  std::int32_t n_own_tets = 0;  ///< around it: of the piece's own tetrahedra
  std::int32_t n_tets = -1;     ///< around it, halo included; -1: the point is a ghost
  double volume = 0;            ///< of these, if the point is owned
};

/// Reports to a piece a point that it shares with another piece.
struct SharedPoint {
  collide::OwnerId other{};
  GlobalId id = 0;
  std::int32_t point = 0;  ///< local
  std::int32_t there = 0;  ///< local in the other piece
  bool is_owner = false;   ///< this piece owns it, and the other holds a ghost
  double volume = 0;       ///< of the tetrahedra around it
};
struct SharedPoints {
  collide::OwnerId piece{};  ///< the receiver
  std::vector<SharedPoint> points;
};

/// What each piece has to know, from all reports of some points. Throws Error (bad_mesh) if a ghost
/// has no owner, a point has two, or the piece that owns it lacks a tetrahedron around it.
[[nodiscard]] std::vector<SharedPoints> compare(std::vector<PointReport> reports);

class PointDirectory : public Group<PointDirectory> {
 public:
  /// Entry method: reports for this PE, at most one per piece and point.
  void add(std::vector<PointReport> reports);
  /// Entry method: compares the reports and calls target for every piece that shares points.
  void resolve(const Callback<SharedPoints>& target);

  /// For checkpoints: between two searches there are no reports.
  template <class Ar>
  void serialize(Ar& /*ar*/) {}
  void absorb(PointDirectory&& /*other*/) {}

 private:
  std::vector<PointReport> reports_;
};

/// The PE that compares the reports of a point.
[[nodiscard]] inline int directory_pe(GlobalId id, int n_pes) {
  const std::uint64_t mixed = static_cast<std::uint64_t>(id) * 0x9E3779B97F4A7C15u;
  return static_cast<int>((mixed >> 32) % static_cast<std::uint64_t>(n_pes));
}

}  // namespace tess::m2m
