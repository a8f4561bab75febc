#include "m2m/conservative/overlaps.hpp"

#include "m2m/interpolate/locate.hpp"
#include "m2m/search/cells.hpp"

#include <algorithm>

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

/// Pairs of tetrahedra of two boxes, one of each side.
class PairsOfBoxes {
 public:
  PairsOfBoxes(const MeshView& source, const Cover& cover) : source_(source), cover_(cover) {}

  /// Calls found(source tetrahedron, target tetrahedron). `targets`: first and end.
  template <class Found>
  void visit(std::uint32_t source_box, std::span<const Aabb> target_boxes, std::uint32_t first,
             const Aabb& around, const Found& found) {
    sources_.clear();
    for (const std::uint32_t s : cover_.members_of(source_box)) {
      const Aabb box = box_around(corners_of(source_.points, source_.tets[s]));
      if (share_volume(box, around)) sources_.push_back({box, static_cast<std::int32_t>(s)});
    }
    if (sources_.empty()) return;
    for (std::size_t t = 0; t < target_boxes.size(); ++t) {
      if (!share_volume(target_boxes[t], cover_.boxes[source_box])) continue;
      for (const Boxed& s : sources_)
        if (share_volume(s.box, target_boxes[t]))
          found(s.tet, first + static_cast<std::uint32_t>(t));
    }
  }

 private:
  struct Boxed {
    Aabb box;
    std::int32_t tet;
  };
  const MeshView& source_;
  const Cover& cover_;
  std::vector<Boxed> sources_;
};

struct Near {
  std::uint32_t target;
  GlobalId source_id;
  std::int32_t source;
};

}  // namespace

Overlaps find_overlaps(const MeshView& source, const Cover& cover, const TargetTets& target) {
  Overlaps out;
  PairsOfBoxes pairs(source, cover);
  std::vector<Aabb> boxes;
  std::vector<Near> near;
  for (std::size_t b = 0; b + 1 < target.first.size(); ++b) {
    const std::uint32_t first = target.first[b];
    boxes.clear();
    near.clear();
    Aabb around = collide::no_box<double, 3>();
    for (std::uint32_t t = first; t < target.first[b + 1]; ++t) {
      boxes.push_back(box_around(target.tets[t]));
      for (const Point& corner : target.tets[t]) grow(around, corner);
    }
    for (std::uint32_t k = target.first_near[b]; k < target.first_near[b + 1]; ++k)
      pairs.visit(target.near[k], boxes, first, around, [&](std::int32_t s, std::uint32_t t) {
        near.push_back({t, source.tet_ids[static_cast<std::size_t>(s)], s});
      });
    out.n_tested += near.size();
    // The order of ids makes sums independent of the decomposition.
    std::sort(near.begin(), near.end(), [](const Near& x, const Near& y) {
      return x.target != y.target ? x.target < y.target : x.source_id < y.source_id;
    });
    for (const Near& pair : near) {
      const PairMoments moments = pair_moments(
          corners_of(source.points, source.tets[static_cast<std::size_t>(pair.source)]),
          target.tets[pair.target]);
      if (!(moments.volume > 0)) continue;
      if (out.targets.empty() || out.targets.back() != pair.target) {
        if (!out.targets.empty())
          out.first.push_back(static_cast<std::uint32_t>(out.sources.size()));
        out.targets.push_back(pair.target);
      }
      out.sources.push_back(pair.source);
      out.integrals.push_back(moments.mixed);
    }
  }
  if (!out.targets.empty()) out.first.push_back(static_cast<std::uint32_t>(out.sources.size()));
  return out;
}

void add_load(const MeshView& source, std::int32_t tet, const Matrix4& integrals,
              const SourceField& field, std::span<double> out) {
  const Tet& corners = source.tets[static_cast<std::size_t>(tet)];
  const std::size_t n = field.n_components;
  for (std::size_t c = 0; c < n; ++c) {
    Weights u;
    for (std::size_t a = 0; a < 4; ++a) u[a] = field.at(corners, tet, a, c);
    for (std::size_t b = 0; b < 4; ++b)
      out[b * n + c] += (integrals[0][b] * u[0] + integrals[1][b] * u[1]) +
                        (integrals[2][b] * u[2] + integrals[3][b] * u[3]);
  }
}

void add_range(const MeshView& source, std::int32_t tet, const SourceField& field,
               std::span<ValueRange> out) {
  const Tet& corners = source.tets[static_cast<std::size_t>(tet)];
  for (std::size_t c = 0; c < field.n_components; ++c)
    for (std::size_t a = 0; a < 4; ++a) {
      const double u = field.at(corners, tet, a, c);
      if (u < out[c].low) out[c].low = u;
      if (u > out[c].high) out[c].high = u;
    }
}

}  // namespace tess::m2m
