#include "m2m/couple/point_directory.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace tess::m2m {

void PointDirectory::add(std::vector<PointReport> reports) {
  reports_.insert(reports_.end(), reports.begin(), reports.end());
}

void PointDirectory::resolve(const Callback<SharedPoints>& target) {
  for (SharedPoints& shared : compare(std::exchange(reports_, {}))) target(std::move(shared));
}

std::vector<SharedPoints> compare(std::vector<PointReport> all) {
  // Owners first.
  std::sort(all.begin(), all.end(), [](const PointReport& a, const PointReport& b) {
    return std::tuple(a.id, a.n_tets < 0, a.piece) < std::tuple(b.id, b.n_tets < 0, b.piece);
  });
  std::map<collide::OwnerId, SharedPoints> lists;
  for (auto first = all.begin(); first != all.end();) {
    const auto end =
        std::find_if(first, all.end(), [&](const PointReport& r) { return r.id != first->id; });
    const PointReport& owner = *first;
    if (owner.n_tets < 0)
      fail(ErrorCode::bad_mesh, "point ", owner.id,
           " of the target is a ghost of a piece, but no piece owns it: let one piece own it "
           "(MeshView::n_owned)");
    std::int32_t n_tets = 0;
    for (const PointReport& report : std::span(first, end)) {
      n_tets += report.n_own_tets;
      if (&report == &owner) continue;
      if (report.n_tets >= 0)
        fail(ErrorCode::bad_mesh, "point ", owner.id,
             " of the target is owned by two pieces: give the points of separate meshes different "
             "ids, and let one piece own each");
      lists[owner.piece].points.push_back(
          {report.piece, owner.id, owner.point, report.point, true, owner.volume});
      lists[report.piece].points.push_back(
          {owner.piece, owner.id, report.point, owner.point, false, owner.volume});
    }
    if (n_tets != owner.n_tets)
      fail(ErrorCode::bad_mesh, "the piece that owns point ", owner.id, " of the target shows ",
           owner.n_tets, " of the ", n_tets,
           " tetrahedra around it: a conservative kind needs a halo of one layer "
           "(MeshView::n_own_tets)");
    first = end;
  }
  std::vector<SharedPoints> out;
  for (auto& [piece, shared] : lists) {
    shared.piece = piece;
    out.push_back(std::move(shared));
  }
  return out;
}

}  // namespace tess::m2m
