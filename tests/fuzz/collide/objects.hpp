// The objects of a Look: random shapes of the library.
#pragma once

#include "collide/swept.hpp"
#include "collide/tetrahedron.hpp"
#include "runtime/core/hash.hpp"
#include "tests/fuzz/collide/look.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace collide_fuzz {

namespace shapes = tess::collide;

/// Draws objects in the unit cube, and places their coordinates at offset + scale * x.
class Drawer {
 public:
  explicit Drawer(const Look& look) : look_(look), random_(tess::mix(look.seed)) {}

  template <class Object>
  std::vector<Object> objects() {
    std::vector<Object> out;
    for (std::uint32_t i = 0; i < look_.n; ++i) {
      if (i > 0 && random_.chance(look_.repeated)) {
        out.push_back(out[random_.below(i)]);
        continue;
      }
      begin(look_.has_large_one && i == look_.n / 2);
      out.push_back(object(static_cast<Object*>(nullptr)));
    }
    return out;
  }
  std::vector<std::uint32_t> models() {
    std::vector<std::uint32_t> out(look_.n);
    for (std::uint32_t& model : out)
      model = static_cast<std::uint32_t>(random_.below(look_.n_models));
    return out;
  }

 private:
  using Where = std::array<double, 4>;  // in the unit cube

  /// Chooses where the next object is, and its extents.
  void begin(bool over_all) {
    const double size =
        over_all ? 3 : look_.largest * std::pow(10, -look_.decades * random_.unit());
    const auto cluster = static_cast<double>(random_.below(5));
    for (std::size_t k = 0; k < at_.size(); ++k) {
      at_[k] = random_.unit() - 0.5;
      const double middle = tess::unit(tess::mix(k + 7)) - 0.5;
      if (look_.place == Place::clusters)
        at_[k] = std::sin(cluster * 12.9 + static_cast<double>(k)) + 1e-3 * at_[k];
      if (look_.place == Place::one_point || (look_.place == Place::plane && k == 2) ||
          (look_.place == Place::line && k > 0))
        at_[k] = middle;
      if (over_all) at_[k] = -1.5;
      extent_[k] = random_.chance(look_.no_extent) && !over_all ? 0 : size * random_.unit();
      if (over_all) extent_[k] = size;
      if (look_.place == Place::lattice) {
        at_[k] = std::round(8 * at_[k]) / 8;
        extent_[k] = std::round(8 * extent_[k]) / 8;
      }
    }
  }
  /// A coordinate `share` of the way through the object.
  [[nodiscard]] double coordinate(std::size_t k, double share) const {
    return look_.offset + look_.scale * (at_[k] + share * extent_[k]);
  }
  template <class Real, std::size_t D>
  std::array<Real, D> corner(double share) const {
    std::array<Real, D> out{};
    for (std::size_t k = 0; k < D; ++k) out[k] = static_cast<Real>(coordinate(k, share));
    return out;
  }
  /// Somewhere in the box of the object; on a lattice at a corner.
  template <class Real>
  std::array<Real, 3> point() {
    std::array<Real, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double share =
          look_.place == Place::lattice ? static_cast<double>(random_.below(2)) : random_.unit();
      out[k] = static_cast<Real>(coordinate(k, share));
    }
    return out;
  }
  /// Corners, some of which nearly stand in a line or coincide.
  template <class Real, std::size_t N>
  std::array<std::array<Real, 3>, N> corners() {
    std::array<std::array<Real, 3>, N> out{};
    for (auto& one : out) one = point<Real>();
    if (!random_.chance(look_.degenerate)) return out;
    if (random_.chance(0.3)) {
      out[N - 1] = out[random_.below(N - 1)];
    } else {
      for (std::size_t k = 0; k < 3; ++k) out[N - 1][k] = out[0][k] / 2 + out[1][k] / 2;
      if (random_.chance(0.5)) out[N - 1][0] = std::nextafter(out[N - 1][0], Real{0});
    }
    return out;
  }

  template <class Real, std::size_t D>
  shapes::Box<Real, D> object(shapes::Box<Real, D>* /*type*/) {
    return {corner<Real, D>(0), corner<Real, D>(1)};
  }
  template <class Real>
  shapes::TriangleOf<Real> object(shapes::TriangleOf<Real>* /*type*/) {
    return {corners<Real, 3>()};
  }
  shapes::Sphere object(shapes::Sphere* /*type*/) {
    return {corner<double, 3>(0.5), look_.scale * extent_[0] / 2};
  }
  shapes::Tetrahedron object(shapes::Tetrahedron* /*type*/) { return {corners<double, 4>()}; }
  shapes::Segment object(shapes::Segment* /*type*/) {
    const auto ends = corners<double, 3>();
    return {ends[0], ends[2]};
  }
  shapes::Swept<> object(shapes::Swept<>* /*type*/) {
    const shapes::Aabb start = object(static_cast<shapes::Aabb*>(nullptr));
    for (double& x : at_) x += look_.largest * (random_.unit() - 0.5);
    return {start, object(static_cast<shapes::Aabb*>(nullptr))};
  }

  const Look& look_;
  tess::Random random_;
  std::array<double, 4> at_{}, extent_{};
};

/// Calls visit(objects, drawer) with the objects of a Look.
template <class Visit>
auto with_objects(const Look& look, const Visit& visit) {
  Drawer drawer(look);
  switch (look.shape) {
    case Shape::box:
      break;
    case Shape::box_of_float:
      return visit(drawer.objects<shapes::Box<float, 3>>(), drawer);
    case Shape::box_in_2d:
      return visit(drawer.objects<shapes::Box<double, 2>>(), drawer);
    case Shape::box_of_float_in_4d:
      return visit(drawer.objects<shapes::Box<float, 4>>(), drawer);
    case Shape::triangle:
      return visit(drawer.objects<shapes::Triangle>(), drawer);
    case Shape::triangle_of_float:
      return visit(drawer.objects<shapes::TriangleOf<float>>(), drawer);
    case Shape::sphere:
      return visit(drawer.objects<shapes::Sphere>(), drawer);
    case Shape::tetrahedron:
      return visit(drawer.objects<shapes::Tetrahedron>(), drawer);
    case Shape::segment:
      return visit(drawer.objects<shapes::Segment>(), drawer);
    case Shape::swept_box:
      return visit(drawer.objects<shapes::Swept<>>(), drawer);
  }
  return visit(drawer.objects<shapes::Aabb>(), drawer);
}

/// Whether two objects are a pair, by the test of the library: for boxes that of their type.
template <class Real, std::size_t D>
bool is_pair(const shapes::Box<Real, D>& a, const shapes::Box<Real, D>& b,
             shapes::Touching touching) {
  return overlap(a, b, touching);
}
template <class A, class B>
bool is_pair(const A& a, const B& b, shapes::Touching touching) {
  return intersect(a, b, touching);
}

/// For brute force over all pairs of a scene. The box decides first only where there are many.
template <class Objects>
auto pair_test(const Objects& objects, shapes::Touching touching) {
  using Object = typename Objects::value_type;
  using shapes::box_of;
  std::vector<decltype(box_of(std::declval<const Object&>()))> boxes;
  constexpr std::size_t many = 300;
  if (objects.size() > many)
    for (const Object& object : objects) boxes.push_back(box_of(object));
  return [&objects, touching, boxes = std::move(boxes)](std::uint32_t i, std::uint32_t j) {
    if (!boxes.empty() && !overlap(boxes[i], boxes[j], shapes::Touching::counts)) return false;
    return is_pair(objects[i], objects[j], touching);
  };
}

}  // namespace collide_fuzz
