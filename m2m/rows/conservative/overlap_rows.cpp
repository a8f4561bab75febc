#include "m2m/rows/conservative/overlap_rows.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

Aabb box_around(const Corners& corners) {
  Aabb box = collide::box_of(corners[0]);
  for (std::size_t c = 1; c < 4; ++c) grow(box, corners[c]);
  return box;
}

/// Without a common volume the tetrahedra have none either.
bool share_volume(const Aabb& a, const Aabb& b) {
  return collide::overlap(a, b, collide::Touching::does_not_count);
}

struct Entry {
  std::uint32_t row;
  VertexId column;
  double weight;
};

/// Entries are merged when there are so many, and again when there are four times as many as after
/// the last time: memory stays near that of the rows.
constexpr std::size_t first_merge = std::size_t{1} << 18;

class RowBuilder {
 public:
  RowBuilder(const MeshView& source, Centring centring, std::size_t n_rows)
      : source_(source), centring_(centring), n_rows_(n_rows) {
    sum_.assign(n_unknowns(source, centring), 0.0);
    is_used_.assign(sum_.size(), 0);
  }
  void add(std::uint32_t row, VertexId column, double weight) {
    entries_.push_back({row, column, weight});
  }
  /// Between tetrahedra.
  void merge_if_many() {
    if (entries_.size() <= next_merge_) return;
    const Rows<double> rows = take();
    for (std::size_t row = 0; row < n_rows_; ++row)
      for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k)
        add(static_cast<std::uint32_t>(row), rows.columns[k], rows.weights[k]);
    next_merge_ = std::max(first_merge, 4 * entries_.size());
  }
  /// The entries as rows; sums are exact, so their order is free.
  [[nodiscard]] Rows<double> take() {
    std::vector<std::uint64_t> next(n_rows_ + 1, 0);
    for (const Entry& entry : entries_) ++next[entry.row + 1];
    for (std::size_t row = 0; row < n_rows_; ++row) next[row + 1] += next[row];
    const std::vector<std::uint64_t> first = next;
    std::vector<std::uint32_t> order(entries_.size());
    for (std::size_t k = 0; k < entries_.size(); ++k)
      order[next[entries_[k].row]++] = static_cast<std::uint32_t>(k);
    Rows<double> rows;
    std::vector<VertexId> columns;
    for (std::size_t row = 0; row < n_rows_; ++row) {
      columns.clear();
      for (std::uint64_t k = first[row]; k < first[row + 1]; ++k) {
        const Entry& entry = entries_[order[k]];
        const auto column = static_cast<std::size_t>(entry.column);
        if (is_used_[column] == 0) columns.push_back(entry.column);
        is_used_[column] = 1;
        sum_[column] += entry.weight;
      }
      std::sort(columns.begin(), columns.end(), [&](VertexId a, VertexId b) {
        return id_of_unknown(source_, centring_, a) < id_of_unknown(source_, centring_, b);
      });
      for (const VertexId column : columns) {
        const auto c = static_cast<std::size_t>(column);
        rows.add(column, sum_[c]);
        sum_[c] = 0;
        is_used_[c] = 0;
      }
      rows.end_row();
    }
    entries_.clear();
    return rows;
  }

 private:
  const MeshView& source_;
  Centring centring_;
  std::size_t n_rows_;
  std::vector<Entry> entries_;
  std::size_t next_merge_ = first_merge;
  std::vector<double> sum_;            // per column; zero between rows
  std::vector<std::uint8_t> is_used_;  // per column
};

/// The integrals of one target tetrahedron, summed over the source tetrahedra.
class TetIntegrals {
 public:
  TetIntegrals(const MeshView& source, Centring centring)
      : source_(source), centring_(centring), slot_of_(n_unknowns(source, centring), -1) {}

  void add(std::int32_t tet, const Matrix4& integrals, const std::array<double, 4>& quanta) {
    const Tet& corners = source_.tets[static_cast<std::size_t>(tet)];
    for (std::size_t a = 0; a < 4; ++a) {
      std::array<double, 4>& sum = sum_of(unknown(corners, tet, a));
      for (std::size_t b = 0; b < 4; ++b) {
        // The quanta are powers of two: only nearbyint() rounds.
        const double exact = std::nearbyint(integrals[a][b] / quanta[b]) * quanta[b];
        if (!(exact > 0)) continue;
        sum[b] += exact;
        covered[b] += exact;
      }
    }
  }
  /// Moves the sums of corners with a row to the rows, and starts again.
  void move_to(RowBuilder& rows, const std::array<std::uint32_t, 4>& unknowns,
               std::uint32_t n_rows) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      for (std::size_t b = 0; b < 4; ++b)
        if (unknowns[b] < n_rows && sums_[k][b] > 0)
          rows.add(unknowns[b], columns_[k], sums_[k][b]);
      slot_of_[static_cast<std::size_t>(columns_[k])] = -1;
    }
    columns_.clear();
    sums_.clear();
    covered = {};
  }

  std::array<double, 4> covered{};

 private:
  [[nodiscard]] VertexId unknown(const Tet& corners, std::int32_t tet, std::size_t a) const {
    if (centring_ == Centring::nodes) return corners[a];
    return centring_ == Centring::cells ? tet : 4 * tet + static_cast<VertexId>(a);
  }
  std::array<double, 4>& sum_of(VertexId column) {
    std::int32_t& slot = slot_of_[static_cast<std::size_t>(column)];
    if (slot < 0) {
      slot = static_cast<std::int32_t>(columns_.size());
      columns_.push_back(column);
      sums_.push_back({});
    }
    return sums_[static_cast<std::size_t>(slot)];
  }

  const MeshView& source_;
  Centring centring_;
  std::vector<std::int32_t> slot_of_;  // per unknown: its position in columns_, or -1
  std::vector<VertexId> columns_;
  std::vector<std::array<double, 4>> sums_;
};

struct BoxedTet {
  Aabb box;
  std::int32_t tet;
};

/// The tetrahedra of some boxes of the cover that are near to a box.
void collect_near(const MeshView& source, const Cover& cover, std::span<const std::uint32_t> boxes,
                  const Aabb& around, std::vector<BoxedTet>& out) {
  out.clear();
  for (const std::uint32_t near : boxes)
    for (const std::uint32_t s : cover.members_of(near)) {
      const Aabb box = box_around(corners_of(source.points, source.tets[s]));
      if (share_volume(box, around)) out.push_back({box, static_cast<std::int32_t>(s)});
    }
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
  OverlapRows out;
  RowBuilder rows(source, centring, target.n_rows);
  TetIntegrals sums(source, centring);
  std::vector<BoxedTet> near;
  for (std::size_t b = 0; b + 1 < target.first.size(); ++b) {
    Aabb around = collide::no_box<double, 3>();
    for (std::uint32_t t = target.first[b]; t < target.first[b + 1]; ++t)
      for (const Point& corner : target.tets[t]) grow(around, corner);
    collect_near(
        source, cover,
        std::span(target.near)
            .subspan(target.first_near[b], target.first_near[b + 1] - target.first_near[b]),
        around, near);
    for (std::uint32_t t = target.first[b]; t < target.first[b + 1]; ++t) {
      const Aabb box = box_around(target.tets[t]);
      const std::array<std::uint32_t, 4>& unknowns = target.unknowns[t];
      std::array<double, 4> quanta;
      for (std::size_t c = 0; c < 4; ++c) quanta[c] = target.quanta[unknowns[c]];
      for (const BoxedTet& s : near) {
        if (!share_volume(s.box, box)) continue;
        ++out.n_tested;
        const PairMoments moments =
            pair_moments(corners_of(source.points, source.tets[static_cast<std::size_t>(s.tet)]),
                         target.tets[t]);
        if (moments.volume > 0) sums.add(s.tet, moments.mixed, quanta);
      }
      if (sums.covered != std::array<double, 4>{}) {
        out.tets.push_back(t);
        out.covered.push_back(sums.covered);
      }
      sums.move_to(rows, unknowns, target.n_rows);
      rows.merge_if_many();
    }
  }
  out.rows = rows.take();
  return out;
}

}  // namespace tess::m2m
