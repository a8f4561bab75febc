#include "m2m/io/elements/split_element.hpp"

#include "m2m/rows/interpolate/native_element.hpp"
#include "m2m/surface/sides.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tess::m2m {
namespace {

using Face = std::vector<std::size_t>;  // vertices of an element

/// The sides of ExodusII, counter-clockwise seen from outside.
struct Shape {
  std::size_t n_vertices;
  std::vector<Face> sides;
};

const Shape& shape_of(ElementType type) {
  static const std::array<Shape, 10> shapes{{
      {4, {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}}},
      {8, {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}},
      {6, {{0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}, {0, 2, 1}, {3, 4, 5}}},
      {5, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {0, 4, 3}, {0, 3, 2, 1}}},
      {10, {{0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 2, 1, 6, 5, 4}}},
      {27,
       {{0, 1, 5, 4, 8, 13, 16, 12, 25},
        {1, 2, 6, 5, 9, 14, 17, 13, 24},
        {2, 3, 7, 6, 10, 15, 18, 14, 26},
        {0, 4, 7, 3, 12, 19, 15, 11, 23},
        {0, 3, 2, 1, 11, 10, 9, 8, 21},
        {4, 5, 6, 7, 16, 17, 18, 19, 22}}},
      {3, {{0, 1}, {1, 2}, {2, 0}}},
      {6, {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}}},
      {4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {2, {{0}, {1}}},
  }};
  return shapes[static_cast<std::size_t>(type)];
}

void append(const Tet& cell, std::vector<Tet>& cells, std::int32_t dimension = 3) {
  if (!names_corner_twice(cell, dimension)) cells.push_back(cell);
}

/// A six-node triangle gives those at its corners and that in its middle.
void split_surface(ElementType type, std::span<const VertexId> v, std::vector<Tet>& cells) {
  if (type == ElementType::tri6) {
    constexpr std::size_t parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    for (const auto& [a, b, c] : parts) append({v[a], v[b], v[c], v[c]}, cells, 2);
    return;
  }
  std::array<VertexId, 4> q{v[0], v[1], v[2], v[3]};
  std::ranges::rotate(q, std::ranges::min_element(q));
  append({q[0], q[1], q[2], q[2]}, cells, 2);
  append({q[0], q[2], q[3], q[3]}, cells, 2);
}

/// Corners first; of the octahedron, those around its diagonal from the edge 0 2 to the edge 1 3.
void split_tet10(std::span<const VertexId> v, std::vector<Tet>& tets) {
  constexpr std::size_t parts[8][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3},
                                       {4, 6, 7, 8}, {4, 5, 6, 8}, {6, 7, 8, 9}, {5, 9, 6, 8}};
  for (const auto& part : parts) append({v[part[0]], v[part[1]], v[part[2]], v[part[3]]}, tets);
}

/// The eight hexahedra at its corners.
void split_hex27(std::span<const VertexId> v, std::vector<Tet>& tets) {
  std::array<std::size_t, 27> at{};  // the vertex at each place of a grid of 3³
  for (std::size_t k = 0; k < 27; ++k) {
    const Point r = reference_vertex(27, k);
    at[static_cast<std::size_t>(2 * (r[0] + 3 * r[1] + 9 * r[2]))] = k;
  }
  constexpr std::size_t firsts[8] = {0, 1, 3, 4, 9, 10, 12, 13};
  constexpr std::size_t steps[8] = {0, 1, 4, 3, 9, 10, 13, 12};
  for (const std::size_t first : firsts) {
    std::array<VertexId, 8> part{};
    for (std::size_t k = 0; k < 8; ++k) part[k] = v[at[first + steps[k]]];
    split_element(ElementType::hex8, part, tets);
  }
}

}  // namespace

std::size_t n_vertices(ElementType type) noexcept {
  return shape_of(type).n_vertices;
}
std::size_t n_sides(ElementType type) noexcept {
  return shape_of(type).sides.size();
}

void split_element(ElementType type, std::span<const VertexId> vertices, std::vector<Tet>& tets) {
  const Shape& shape = shape_of(type);
  TESS_CHECK(vertices.size() == shape.n_vertices, "expected ", shape.n_vertices, " vertices, got ",
             vertices.size());
  if (type == ElementType::tet10) return split_tet10(vertices, tets);
  if (type == ElementType::hex27) return split_hex27(vertices, tets);
  if (is_simplex(type)) {
    Tet& cell = tets.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) cell[k] = vertices[std::min(k, vertices.size() - 1)];
    return;
  }
  if (dimension_of(type) == 2) return split_surface(type, vertices, tets);
  const VertexId apex = *std::min_element(vertices.begin(), vertices.end());
  for (const Face& side : shape.sides) {
    std::array<VertexId, 4> face{};
    std::size_t n = 0;
    for (; n < side.size(); ++n) face[n] = vertices[side[n]];
    const auto end = face.begin() + static_cast<std::ptrdiff_t>(n);
    if (std::find(face.begin(), end, apex) != end) continue;
    std::rotate(face.begin(), std::min_element(face.begin(), end), end);
    // The face is counter-clockwise from outside, and the apex inside.
    append({face[0], face[2], face[1], apex}, tets);
    if (n == 4) append({face[0], face[3], face[2], apex}, tets);
  }
}

void ElementSplitter::add(ElementType type, std::span<const VertexId> vertices) {
  const auto first_tet = static_cast<GlobalId>(mesh_.n_tets());
  if (runs_.empty() || runs_.back().type != type)
    runs_.push_back({type, n_elements_, first_tet, std::ssize(mesh_.elements.vertices), {}});
  ++n_elements_;
  split_element(type, vertices, mesh_.tets);
  if (is_simplex(type)) return;
  std::vector<VertexId>& all = mesh_.elements.vertices;
  all.push_back(static_cast<VertexId>(vertices.size()));
  all.insert(all.end(), vertices.begin(), vertices.end());
  runs_.back().first_tets.push_back(first_tet);
}

const ElementSplitter::Run* ElementSplitter::run_of(GlobalId element) const {
  if (element < 0 || element >= n_elements_) return nullptr;
  return &*std::prev(std::partition_point(
      runs_.begin(), runs_.end(), [&](const Run& r) { return r.first_element <= element; }));
}

std::size_t ElementSplitter::n_sides_of(GlobalId element) const {
  const Run* const run = run_of(element);
  return run == nullptr ? 0 : n_sides(run->type);
}

void ElementSplitter::append_side(GlobalId element, std::int64_t side,
                                  std::vector<Side>& sides) const {
  const Run* const run = run_of(element);
  TESS_CHECK(run != nullptr, "there is no element ", element, " of ", n_elements_);
  const auto number = static_cast<std::size_t>(element - run->first_element);
  if (is_simplex(run->type)) {
    sides.push_back(
        {run->first_tet + static_cast<GlobalId>(number), static_cast<std::int32_t>(side)});
    return;
  }
  const Shape& shape = shape_of(run->type);
  const std::span<const VertexId> vertices = mesh_.elements.vertices_at(run->begin_of(number));
  std::vector<VertexId> face;
  for (const std::size_t v : shape.sides[static_cast<std::size_t>(side - 1)])
    face.push_back(vertices[v]);
  const Run* const next =
      run_of(run->first_element + static_cast<GlobalId>(run->first_tets.size()));
  const GlobalId end =
      number + 1 < run->first_tets.size()
          ? run->first_tets[number + 1]
          : (next == nullptr ? static_cast<GlobalId>(mesh_.n_tets()) : next->first_tet);
  const std::int32_t dimension = dimension_of(run->type);
  for (GlobalId t = run->first_tets[number]; t < end; ++t)
    for (std::int32_t s = 1; s <= dimension + 1; ++s) {
      const Tet corners = side_of(mesh_.tets[static_cast<std::size_t>(t)], dimension, s);
      const bool on_side = std::ranges::all_of(
          corners, [&](VertexId v) { return std::ranges::find(face, v) != face.end(); });
      if (on_side) sides.push_back({t, s});
    }
}

std::uint64_t ElementSplitter::n_folded(GlobalId begin, GlobalId end) const {
  constexpr double rounding = 1e-9;  // relative to the volume of the element
  std::uint64_t n = 0;
  for (GlobalId t = begin; t < end;) {
    double right = 0, left = 0;
    for (const GlobalId element = mesh_.element_of_tet[static_cast<std::size_t>(t)];
         t < end && mesh_.element_of_tet[static_cast<std::size_t>(t)] == element; ++t) {
      const double volume = signed_volume(mesh_, static_cast<std::size_t>(t));
      (volume > 0 ? right : left) += std::abs(volume);
    }
    n += std::min(right, left) > rounding * (right + left) ? 1U : 0U;
  }
  return n;
}

void ElementSplitter::finish() {
  const bool any =
      std::any_of(runs_.begin(), runs_.end(), [](const Run& run) { return !is_simplex(run.type); });
  if (!any) return;
  mesh_.element_of_tet.resize(mesh_.n_tets());
  if (mesh_.dimension == 3) mesh_.elements.of_tet.assign(mesh_.n_tets(), -1);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Run& run = runs_[r];
    const GlobalId end =
        r + 1 < runs_.size() ? runs_[r + 1].first_tet : static_cast<GlobalId>(mesh_.n_tets());
    GlobalId element = run.first_element;
    for (GlobalId t = run.first_tet; t < end; ++t) {
      if (is_simplex(run.type)) {
        element = run.first_element + (t - run.first_tet);
      } else {
        const auto after = std::upper_bound(run.first_tets.begin(), run.first_tets.end(), t);
        element = run.first_element + (after - run.first_tets.begin()) - 1;
      }
      mesh_.element_of_tet[static_cast<std::size_t>(t)] = element;
      if (mesh_.dimension == 3 && !is_simplex(run.type))
        mesh_.elements.of_tet[static_cast<std::size_t>(t)] =
            run.begin_of(static_cast<std::size_t>(element - run.first_element));
    }
    if (is_simplex(run.type)) continue;
    const auto known = std::find_if(mesh_.split.begin(), mesh_.split.end(), [&](const auto& split) {
      return split.type == name_of(run.type);
    });
    SplitElements& split = known != mesh_.split.end()
                               ? *known
                               : mesh_.split.emplace_back(SplitElements{name_of(run.type)});
    split.n_elements += run.first_tets.size();
    split.n_tets += static_cast<std::uint64_t>(end - run.first_tet);
    split.n_folded += n_folded(run.first_tet, end);
  }
}

}  // namespace tess::m2m
