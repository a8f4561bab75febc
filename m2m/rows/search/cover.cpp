#include "m2m/rows/search/cover.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/search/cells.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

/// Objects per box. (Measured with kuhn:55 and 26: 32 to 128 take the same time.)
constexpr std::size_t objects_per_box = 64;

/// `place(object)`: a point of the object. `add(object, box)`: extends a box by it.
template <class Place, class Add>
Cover cover(const Aabb& around, std::size_t n, const Place& place, const Add& add) {
  const Cells cells(around, n / objects_per_box + 1);
  std::vector<Aabb> boxes(cells.n_cells(), collide::no_box<double, 3>());
  std::vector<std::uint32_t> cell_of(n), count(cells.n_cells());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t cell = cells.cell_of(place(i));
    cell_of[i] = static_cast<std::uint32_t>(cell);
    ++count[cell];
    add(i, boxes[cell]);
  }
  Cover out;
  out.first.push_back(0);
  std::vector<std::uint32_t> next(cells.n_cells());
  for (std::size_t cell = 0; cell < cells.n_cells(); ++cell) {
    if (count[cell] == 0) continue;
    next[cell] = out.first.back();
    out.boxes.push_back(boxes[cell]);
    out.first.push_back(out.first.back() + count[cell]);
  }
  out.members.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    out.members[next[cell_of[i]]++] = static_cast<std::uint32_t>(i);
  return out;
}

}  // namespace

Cover cover_points(std::span<const Point> points) {
  return cover(
      collide::box_around(points), points.size(), [&](std::size_t i) { return points[i]; },
      [&](std::size_t i, Aabb& box) { grow(box, points[i]); });
}

Cover cover_tets(std::span<const Point> points, std::span<const Tet> tets, double reach) {
  Cover out = cover(
      collide::box_around(points), tets.size(),
      [&](std::size_t t) { return points[static_cast<std::size_t>(tets[t][0])]; },
      [&](std::size_t t, Aabb& box) {
        for (const VertexId v : tets[t]) grow(box, points[static_cast<std::size_t>(v)]);
      });
  for (Aabb& box : out.boxes) box = padded(box, reach);
  return out;
}

// There are about as many boxes as numbers, so a mark per box is several times faster than a sort.
void sort_unique_boxes(std::vector<std::uint32_t>& boxes) {
  if (boxes.empty()) return;
  std::vector<std::uint8_t> marks(*std::max_element(boxes.begin(), boxes.end()) + std::size_t{1});
  for (const std::uint32_t box : boxes) marks[box] = 1;
  boxes.clear();
  for (std::size_t box = 0; box < marks.size(); ++box)
    if (marks[box] != 0) boxes.push_back(static_cast<std::uint32_t>(box));
}

}  // namespace tess::m2m
