#include "m2m/rows/conservative/overlap_rows.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/supermesh/triangles.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace tess::m2m {
namespace {

/// Sums are merged into rows when there are so many, and again when there are as many as weights of
/// rows: memory stays near that of the rows.
constexpr std::size_t first_merge = std::size_t{1} << 16;

/// Sums integrals per target tetrahedron and unknown of the source, and makes rows of these sums.
class RowBuilder {
 public:
  RowBuilder(const MeshView& source, Centring centring, std::size_t n_rows, std::size_t n_tets)
      : source_(source), centring_(centring), n_rows_(n_rows) {
    reserve(std::min(first_merge, 32 * n_tets));
    const std::size_t n = n_unknowns(source, centring);
    slot_of_.assign(n, -1);
    sum_.assign(n, 0.0);
    for (std::size_t u = 0; u < n; ++u)
      ids_.push_back(id_of_unknown(source, centring, static_cast<VertexId>(u)));
  }

  void add(std::int32_t tet, const Matrix4& integrals, Four quanta) {
    const Tet& corners = source_.tets[static_cast<std::size_t>(tet)];
    // The quanta are powers of two: only nearbyint() rounds.
    const Four per_quantum = 1 / quanta;
    Four covered = covered_;
    for (std::size_t a = 0; a < 4; ++a) {
      Four exact = simd::load<Four>(integrals[a].data()) * per_quantum;
      for (std::size_t b = 0; b < 4; ++b) exact[b] = std::nearbyint(exact[b]);
      exact *= quanta;
      sum_of(unknown(corners, tet, a)) += exact;
      covered += exact;
    }
    covered_ = covered;
  }
  /// Ends a target tetrahedron. Returns the loads of the constant 1.
  std::array<double, 4> end_tet(const std::array<std::uint32_t, 4>& unknowns) {
    for (std::size_t k = tets_.empty() ? 0 : tets_.back().end; k < columns_.size(); ++k)
      slot_of_[static_cast<std::size_t>(columns_[k])] = -1;
    tets_.push_back({unknowns, columns_.size()});
    if (columns_.size() > next_merge_) {
      merged_ = take();
      next_merge_ = std::max(first_merge, merged_.weights.size());
      reserve(next_merge_ + next_merge_ / 8);
    }
    std::array<double, 4> covered;
    simd::store(covered.data(), std::exchange(covered_, Four{}));
    return covered;
  }
  /// The rows; sums are exact, so their order is free.
  [[nodiscard]] Rows<double> take() {
    const Rows<double> merged = std::exchange(merged_, {});
    std::vector<std::uint32_t> next(n_rows_ + 1, 0);
    const auto visit = [&](auto&& what) {  // of each row: tetrahedra with a corner there
      for (std::uint32_t t = 0; t < tets_.size(); ++t)
        for (std::uint32_t b = 0; b < 4; ++b)
          if (tets_[t].unknowns[b] < n_rows_) what(tets_[t].unknowns[b], 4 * t + b);
    };
    visit([&](std::uint32_t row, std::uint32_t /*corner*/) { ++next[row + 1]; });
    for (std::size_t row = 0; row < n_rows_; ++row) next[row + 1] += next[row];
    const std::vector<std::uint32_t> first = next;
    std::vector<std::uint32_t> corners(first.back());
    visit([&](std::uint32_t row, std::uint32_t corner) { corners[next[row]++] = corner; });
    Rows<double> rows;
    rows.columns.reserve(merged.columns.size() + columns_.size() / 4);
    rows.weights.reserve(rows.columns.capacity());
    std::vector<VertexId> columns;
    const auto add = [&](VertexId u, double weight) {
      const auto column = static_cast<std::size_t>(u);
      if (sum_[column] == 0) columns.push_back(u);
      sum_[column] += weight;  // more than zero
    };
    for (std::size_t row = 0; row < n_rows_; ++row) {
      columns.clear();
      if (merged.n_rows() > 0)
        for (std::uint64_t k = merged.begin[row]; k < merged.begin[row + 1]; ++k)
          add(merged.columns[k], merged.weights[k]);
      for (std::uint32_t i = first[row]; i < first[row + 1]; ++i) {
        const std::size_t t = corners[i] / 4, b = corners[i] % 4;
        for (std::size_t k = t == 0 ? 0 : tets_[t - 1].end; k < tets_[t].end; ++k)
          if (sums_[k][b] > 0) add(columns_[k], sums_[k][b]);
      }
      std::sort(columns.begin(), columns.end(), [&](VertexId a, VertexId b) {
        return ids_[static_cast<std::size_t>(a)] < ids_[static_cast<std::size_t>(b)];
      });
      for (const VertexId column : columns) {
        const auto c = static_cast<std::size_t>(column);
        rows.add(column, sum_[c]);
        sum_[c] = 0;
      }
      rows.end_row();
    }
    tets_.clear();
    columns_.clear();
    sums_.clear();
    return rows;
  }

 private:
  struct EndedTet {
    std::array<std::uint32_t, 4> unknowns;
    std::size_t end;  // in columns_ and sums_
  };

  [[nodiscard]] VertexId unknown(const Tet& corners, std::int32_t tet, std::size_t a) const {
    if (centring_ == Centring::nodes) return corners[a];
    return centring_ == Centring::cells ? tet : 4 * tet + static_cast<VertexId>(a);
  }
  void reserve(std::size_t n_sums) {
    columns_.reserve(n_sums);
    sums_.reserve(n_sums);
  }
  Four& sum_of(VertexId column) {
    std::int32_t& slot = slot_of_[static_cast<std::size_t>(column)];
    if (slot < 0) {
      slot = static_cast<std::int32_t>(columns_.size());
      columns_.push_back(column);
      sums_.push_back(Four{});
    }
    return sums_[static_cast<std::size_t>(slot)];
  }

  const MeshView& source_;
  Centring centring_;
  std::size_t n_rows_;
  std::vector<GlobalId> ids_;  // per unknown of the source
  std::vector<std::int32_t>
      slot_of_;  // per unknown: where the tetrahedron has it in columns_, or -1
  std::vector<EndedTet> tets_;
  std::vector<VertexId> columns_;
  std::vector<Four> sums_;  // per column of a tetrahedron and corner of the tetrahedron
  Four covered_{};
  Rows<double> merged_;
  std::size_t next_merge_ = first_merge;
  std::vector<double> sum_;  // per column; zero between rows
};

/// Boxes that are compared eight at a time.
class BoxList {
 public:
  void add(const Aabb& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis].push_back(box.lo[axis]);
      high_[axis].push_back(box.hi[axis]);
    }
  }
  /// Adds some of others.
  void add(const BoxList& from, std::span<const std::uint32_t> which) {
    const auto copy = [&](const std::vector<double>& sides, std::vector<double>& to) {
      const std::size_t n = to.size();
      to.resize(n + which.size());
      for (std::size_t k = 0; k < which.size(); ++k) to[n + k] = sides[which[k]];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      copy(from.low_[axis], low_[axis]);
      copy(from.high_[axis], high_[axis]);
    }
  }
  void reserve(std::size_t n) {
    for (auto* sides : {&low_, &high_})
      for (std::vector<double>& side : *sides) side.reserve(n);
  }
  /// Between the last add() and find(), and before a new range: fills up with boxes that hold nothing.
  void pad() {
    while (size() % n_lanes != 0) add(collide::no_box<double, 3>());
  }
  void clear() {
    for (auto* sides : {&low_, &high_})
      for (std::vector<double>& side : *sides) side.clear();
  }
  [[nodiscard]] std::size_t size() const { return low_[0].size(); }
  /// Those of a padded range that share a volume with `box`. (Without one, what they hold has none in
  /// common, either.) Valid until the next call.
  std::span<const std::uint32_t> find(std::uint32_t first, std::uint32_t last, const Aabb& box) {
    if (found_.size() < last - first) found_.resize(last - first);
    std::uint32_t* end = found_.data();
    Numbers numbers = Numbers{0, 1, 2, 3, 4, 5, 6, 7} + first;
    for (std::uint32_t k = first; k < last; k += n_lanes, numbers += n_lanes) {
      simd::Bits shared = 0xFF;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        shared = simd::less<false>(shared, simd::load<Sides>(low_[axis].data() + k),
                                   Sides{} + box.hi[axis]);
        shared = simd::less<false>(shared, Sides{} + box.lo[axis],
                                   simd::load<Sides>(high_[axis].data() + k));
      }
      end = simd::compress(end, shared, numbers);
    }
    return std::span<const std::uint32_t>(found_.data(), end);
  }

 private:
  using Sides = simd::Vector<double, 8>;
  using Numbers = simd::Vector<std::uint32_t, 8>;
  static constexpr std::uint32_t n_lanes = 8;
  std::array<std::vector<double>, 3> low_, high_;  // per axis
  std::vector<std::uint32_t> found_;
};

/// The tetrahedra of some boxes of the source's cover that are near to a box of the target's; with
/// TrianglePlane for Planes the triangles, whose boxes may be flat.
template <class Planes>
class NearTets {
 public:
  NearTets(const MeshView& source, const Cover& cover, std::span<const std::uint32_t> boxes)
      : source_(source), cover_(cover), made_at_(cover.boxes.size(), {0, 0}) {
    std::size_t n = 0;
    for (const std::uint32_t b : boxes)
      if (std::exchange(made_at_[b].first, 1) == 0) n += cover.members_of(b).size() + 7;
    planes_.reserve(n);
    tets_.reserve(n);
    made_.reserve(n);
  }

  void collect(std::span<const std::uint32_t> boxes, const Aabb& around) {
    near_.clear();
    at_.clear();
    for (const std::uint32_t b : boxes) {
      if (made_at_[b].second == 0) make(b);
      const auto found = made_.find(made_at_[b].first, made_at_[b].second, around);
      near_.add(made_, found);
      at_.insert(at_.end(), found.begin(), found.end());
    }
    near_.pad();
  }
  /// Calls found(tetrahedron, planes) for those near whose box shares a volume with this one.
  template <class Found>
  void visit(const Aabb& box, const Found& found) {
    for (const std::uint32_t k : near_.find(0, static_cast<std::uint32_t>(near_.size()), box))
      found(tets_[at_[k]], planes_[at_[k]]);
  }

 private:
  /// Makes those of all tetrahedra in a box of the cover.
  void make(std::uint32_t b) {
    made_at_[b].first = static_cast<std::uint32_t>(made_.size());
    for (const std::uint32_t s : cover_.members_of(b)) {
      const Corners corners = corners_of(source_.points, source_.tets[s]);
      planes_.emplace_back(corners);
      tets_.push_back(static_cast<std::int32_t>(s));
      made_.add(std::is_same_v<Planes, TrianglePlane> ? search_box(corners)
                                                      : collide::box_around(corners));
    }
    made_.pad();
    planes_.resize(made_.size());
    tets_.resize(made_.size());
    made_at_[b].second = static_cast<std::uint32_t>(made_.size());
  }

  const MeshView& source_;
  const Cover& cover_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> made_at_;  // per box: its range of made_
  BoxList made_, near_;
  std::vector<Planes> planes_;      // per box of made_
  std::vector<std::int32_t> tets_;  // likewise
  std::vector<std::uint32_t> at_;   // per box of near_: that of made_
};

/// Triangles that overlap may be apart by the tolerance, and by rounding.
Aabb widened(const Aabb& box, const TargetTets& target) {
  return target.dimension == 3 ? box : padded(box, target.tolerance);
}

template <class Planes, class Cutter>
OverlapRows cut_rows(const MeshView& source, Centring centring, const Cover& cover,
                     const TargetTets& target, Cutter pairs) {
  OverlapRows out;
  RowBuilder rows(source, centring, target.n_rows, target.tets.size());
  NearTets<Planes> near(source, cover, target.near);
  for (std::size_t b = 0; b + 1 < target.first.size(); ++b) {
    Aabb around = collide::no_box<double, 3>();
    for (std::uint32_t t = target.first[b]; t < target.first[b + 1]; ++t)
      for (const Point& corner : target.tets[t]) grow(around, corner);
    near.collect(
        std::span(target.near)
            .subspan(target.first_near[b], target.first_near[b + 1] - target.first_near[b]),
        widened(around, target));
    for (std::uint32_t t = target.first[b]; t < target.first[b + 1]; ++t) {
      const Planes planes(target.tets[t]);
      near.visit(widened(collide::box_around(target.tets[t]), target),
                 [&](std::int32_t s, const Planes& by) { pairs.add(by, planes, s); });
      out.n_tested += pairs.size();
      const std::array<std::uint32_t, 4>& unknowns = target.unknowns[t];
      Four quanta;
      for (std::size_t c = 0; c < 4; ++c) quanta[c] = target.quanta[unknowns[c]];
      pairs.cut(
          [&](std::int32_t s, const PairMoments& moments) { rows.add(s, moments.mixed, quanta); });
      const std::array<double, 4> covered = rows.end_tet(unknowns);
      if (covered == std::array<double, 4>{}) continue;
      out.tets.push_back(t);
      out.covered.push_back(covered);
    }
  }
  out.rows = rows.take();
  return out;
}

}  // namespace

double quantum_of(double volume) {
  // Sums of integrals stay below the volume, so they have at most 53 bits, unless the source
  // overlaps itself.
  return volume > 0 ? std::ldexp(1.0, std::ilogb(volume) - 52) : 1;
}

std::size_t n_unknowns(const MeshView& mesh, Centring centring) {
  if (centring == Centring::nodes) return mesh.points.size();
  return centring == Centring::cells ? mesh.tets.size() : 4 * mesh.tets.size();
}

GlobalId id_of_unknown(const MeshView& mesh, Centring centring, VertexId unknown) {
  const auto u = static_cast<std::size_t>(unknown);
  if (centring == Centring::nodes) return mesh.point_ids[u];
  if (centring == Centring::cells) return mesh.tet_ids[u];
  const GlobalId tet = mesh.tet_ids[u / 4];
  TESS_CHECK(tet <= std::numeric_limits<GlobalId>::max() / 4, "tet_ids has ", tet,
             ": values at corners need ids below 2^61");
  return 4 * tet + static_cast<GlobalId>(u % 4);
}

OverlapRows overlap_rows(const MeshView& source, Centring centring, const Cover& cover,
                         const TargetTets& target) {
  TESS_CHECK(source.dimension == target.dimension, "cells of the dimensions ", source.dimension,
             " and ", target.dimension, " have no overlap");
  if (target.dimension == 3)
    return cut_rows<TetPlanes>(source, centring, cover, target, PairCutter{});
  return cut_rows<TrianglePlane>(source, centring, cover, target,
                                 TriangleCutter(target.tolerance, target.facing));
}

}  // namespace tess::m2m
