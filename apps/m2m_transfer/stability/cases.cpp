#include "apps/m2m_transfer/stability/cases.hpp"

#include "m2m/kuhn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace m2m_transfer::stability {
namespace {

constexpr double exact = 1e-10;  // of a linear field with values up to ten

/// A linear field of the position in a box of side 1 before it was moved and scaled.
std::vector<double> linear(const TetMesh& mesh, const Aabb& box) {
  std::vector<double> out;
  for (const Point& p : mesh.points) {
    double value = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double side = box.hi[axis] - box.lo[axis];
      const double slope = std::array{2.0, -3.0, 5.0}[axis];
      if (side > 0) value += slope * ((p[axis] - box.lo[axis]) / side);
    }
    out.push_back(value);
  }
  return out;
}

Case linear_case(const std::string& name, TetMesh source, TetMesh target) {
  Case out{.name = name};
  const Aabb box = bounds(source);
  out.values = linear(source, box);
  out.truth = linear(target, box);
  out.tolerance = exact;
  out.source = std::move(source);
  out.target = std::move(target);
  return out;
}

Case with_parameter(Case c, const std::string& parameter, double value) {
  c.parameter = parameter;
  c.value = value;
  return c;
}

std::vector<bool> used_points(const TetMesh& mesh) {
  std::vector<bool> used(mesh.n_points());
  for (const Tet& tet : mesh.tets)
    for (const VertexId v : tet) used[static_cast<std::size_t>(v)] = true;
  return used;
}

/// The first of the vertices at the same place, per vertex: two sides of a crack have their own
/// ones.
std::vector<std::size_t> first_at_place(const TetMesh& mesh) {
  std::map<Point, std::size_t> first;
  std::vector<std::size_t> out;
  for (std::size_t v = 0; v < mesh.n_points(); ++v)
    out.push_back(first.try_emplace(mesh.points[v], v).first->second);
  return out;
}

/// Values without structure, so that a wrong vertex or a rounded weight shows. Vertices at one
/// place have one value. The truth is not known at vertices that no tetrahedron uses: they may lie
/// anywhere.
Case onto_itself(const std::string& name, const TetMesh& mesh) {
  Case out{.name = name, .source = mesh, .target = mesh};
  for (const std::size_t v : first_at_place(mesh))
    out.values.push_back(std::sin(static_cast<double>(v) * 12.9898));
  out.truth = out.values;
  const std::vector<bool> used = used_points(mesh);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v]) continue;
    out.truth[v] = std::numeric_limits<double>::quiet_NaN();
    out.outside = std::nullopt;
  }
  return out;
}

Case naming_donors(const std::string& name, const TetMesh& mesh, TetMesh points) {
  Case out{.name = name, .source = exploded(mesh), .target = std::move(points)};
  for (std::size_t t = 0; t < mesh.n_tets(); ++t)
    out.values.insert(out.values.end(), 4, static_cast<double>(t));
  return out;
}

Point on_shell(const Point& p) {
  const double r = 1 + p[2], a = p[0] * 1.2, b = p[1] * 1.2;
  return {r * std::sin(a), r * std::cos(a) * std::sin(b), r * std::cos(a) * std::cos(b)};
}

void add_places_and_scales(std::vector<Case>& all, const TetMesh& source, const TetMesh& target) {
  struct Place {
    double side, offset;
  };
  for (const auto& [side, offset] :
       {Place{1, 0}, {1, 1e3}, {1, -1e6}, {1, 1e9}, {1, 1e12}, {1e3, 1e14}, {1, 1e14}}) {
    Case c = with_parameter(
        linear_case("far away", changed(source, side, offset), changed(target, side, offset)),
        "offset", offset);
    if (side != 1) c.name += ", side 1000";
    c.may_be_refused = offset == 1e14 && side == 1;
    all.push_back(std::move(c));
  }
  for (const double scale : {1e-90, 1e-70, 1e-30, 1e30, 1e90}) {
    all.push_back(
        with_parameter(linear_case("scaled", changed(source, scale, 0), changed(target, scale, 0)),
                       "scale", scale));
    all.back().may_be_refused = scale < 1e-80;
  }
}

void add_thin(std::vector<Case>& all, const TetMesh& source, const TetMesh& target) {
  for (const double aspect : {1e3, 1e6}) {
    const auto flatten = [&](const Point& p) { return Point{p[0], p[1], p[2] / aspect}; };
    all.push_back(
        with_parameter(linear_case("flat layers", mapped(source, flatten), mapped(target, flatten)),
                       "aspect", aspect));
    const auto grade = [&](const Point& p) {
      return Point{p[0], p[1], (std::pow(aspect, p[2]) - 1) / (aspect - 1)};
    };
    all.push_back(
        with_parameter(linear_case("graded layers", mapped(source, grade), mapped(target, grade)),
                       "aspect", aspect));
  }
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-12})
    all.push_back(with_parameter(linear_case("slivers", with_slivers(source, height), target),
                                 "height", height));
  // Points just off a side on which flat tetrahedra lie. Rounding makes these slivers.
  const TetMesh flat = mapped(with_flat_side(6), turned);
  for (const double gap : {0.0, 1e-15, 1e-12}) {
    const auto lowered = [&](Point p) {
      if (p[2] == 0) p[2] = -gap;
      return turned(p);
    };
    all.push_back(with_parameter(
        linear_case("flat tetrahedra on a side", flat, mapped(kuhn_mesh({7}), lowered)), "gap",
        gap));
    if (gap == 0) all.back().outside = std::nullopt;
  }
}

void add_boundaries(std::vector<Case>& all, const TetMesh& source, const TetMesh& target) {
  all.push_back(linear_case("curved boundary", mapped(kuhn_mesh({6}), on_shell),
                            mapped(kuhn_mesh({9}), on_shell)));
  all.back().outside = std::nullopt;
  Case apart =
      linear_case("boundaries that do not match", source, mapped(target, [](const Point& p) {
                    return Point{0.8 * p[0] + 0.35, 0.9 * p[1] + 0.2, 1.1 * p[2] - 0.05};
                  }));
  apart.outside =
      static_cast<std::size_t>(std::ranges::count_if(apart.target.points, [](const Point& p) {
        return std::ranges::any_of(p, [](double x) { return x < 0 || x > 1; });
      }));
  all.push_back(std::move(apart));
  all.push_back(linear_case("no overlap", source, changed(target, 1, 5)));
  all.back().outside = target.n_points();
  all.push_back(
      linear_case("coarse beside fine", coarse_beside_fine(), mapped(target, [](const Point& p) {
                    return Point{2 * p[0], p[1], p[2]};
                  })));
}

void add_permuted(std::vector<Case>& all, const TetMesh& source, const TetMesh& target) {
  all.push_back(linear_case("ids of the source permuted",
                            permuted(source, random_order(source.n_points(), 3)), target));
  all.push_back(linear_case("ids as they are", source, target));
  const std::vector<std::size_t> order = random_order(target.n_points(), 4);
  all.push_back(linear_case("ids of the target permuted", source, permuted(target, order)));
  all.back().order = order;
}

void add_points(std::vector<Case>& all, const TetMesh& mesh, std::size_t n_points) {
  const TetMesh points = cloud(on_faces_and_edges(mesh, n_points));
  all.push_back(linear_case("points on faces and edges", mesh, points));
  all.push_back(naming_donors("the same, donors", mesh, points));
  std::vector<Point> used;
  const std::vector<bool> is_used = used_points(mesh);
  for (std::size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) used.push_back(mesh.points[v]);
  all.push_back(naming_donors("vertices, donors", mesh, cloud(std::move(used))));
}

}  // namespace

std::vector<Case> generated_cases(std::size_t n_points) {
  const TetMesh source = kuhn_mesh({6, 0.2}), target = kuhn_mesh({7, 0.1});
  std::vector<Case> all;
  add_places_and_scales(all, source, target);
  add_thin(all, source, target);
  add_boundaries(all, source, target);
  add_permuted(all, source, target);
  all.push_back(onto_itself("onto itself", source));
  all.push_back(onto_itself("onto itself, regular", kuhn_mesh({6})));
  add_points(all, kuhn_mesh({12, 0.2}), n_points);
  add_points(all, kuhn_mesh({12}), n_points);
  for (std::size_t k = all.size() - 3; k < all.size(); ++k) all[k].name += ", regular";
  return all;
}

std::vector<Case> cases_of(const TetMesh& mesh, std::size_t n_points) {
  std::vector<Case> all;
  const Aabb box = bounds(mesh);
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) side = std::max(side, box.hi[axis] - box.lo[axis]);
  all.push_back(onto_itself("onto itself", mesh));
  const std::vector<std::size_t> order = random_order(mesh.n_points(), 4);
  all.push_back(onto_itself("onto itself, target permuted", mesh));
  all.back().target = permuted(mesh, order);
  for (std::size_t k = 0; k < order.size(); ++k) all.back().truth[k] = all.front().truth[order[k]];
  all.back().order = order;
  for (const double times : {1e3, 1e6, 1e9}) {
    all.push_back(
        with_parameter(onto_itself("onto itself, far away", changed(mesh, 1, times * side)),
                       "offset", times * side));
    all.back().may_be_refused = true;
  }
  for (const double scale : {1e-30, 1e30, 1e90}) {
    all.push_back(with_parameter(onto_itself("onto itself, scaled", changed(mesh, scale / side, 0)),
                                 "scale", scale));
    all.back().may_be_refused = true;
  }
  add_points(all, mesh, n_points);
  for (Case& c : all) c.name = mesh.name.substr(mesh.name.rfind('/') + 1) + " " + c.name;
  return all;
}

Case case_between(const TetMesh& source, const TetMesh& target) {
  Case out = linear_case(source.name.substr(source.name.rfind('/') + 1) + " -> " +
                             target.name.substr(target.name.rfind('/') + 1),
                         source, target);
  out.outside = std::nullopt;
  return out;
}

}  // namespace m2m_transfer::stability
