// Spatial queries over a set of objects: what lies within a radius of a point, the nearest, and
// what a ray hits. An Index is built once, copies the objects, and never changes; queries may run
// on any thread. Answers name objects by their position in the input. They do not depend on the
// order of the input, but that the smaller position comes first among equals.
//
//     const tess::collide::Index index{std::span<const Triangle>(triangles)};
//     for (const Neighbour& n : index.nearest(point, 3)) use(triangles[n.object], n.distance2);
//
// Objects are boxes, points, segments, triangles, balls, tetrahedra, or of any type with
//
//     Aabb box_of(const Object&);                               contains the object
//     double distance2(const Object&, const Point&);            for within() and nearest()
//     std::optional<double> hit(const Object&, const Ray&);     for first_hit() and all_hits()
//
// Errors: Error (bad_value) for an object whose box is not valid, with its position, and for a
// query that is not finite.
#pragma once

#include "collide/box_tree.hpp"
#include "collide/distance.hpp"
#include "collide/ray.hpp"

#include <concepts>
#include <optional>
#include <vector>

namespace tess::collide {

/// An object and its squared distance.
struct Neighbour {
  std::uint32_t object;
  double distance2;

  friend auto operator<=>(const Neighbour& a, const Neighbour& b) noexcept {
    return a.distance2 != b.distance2 ? a.distance2 <=> b.distance2
                                      : std::partial_ordering(a.object <=> b.object);
  }
  friend bool operator==(const Neighbour&, const Neighbour&) = default;
};

/// An object and where a ray first meets it: at from + at · direction.
struct RayHit {
  std::uint32_t object;
  double at;

  friend auto operator<=>(const RayHit& a, const RayHit& b) noexcept {
    return a.at != b.at ? a.at <=> b.at : std::partial_ordering(a.object <=> b.object);
  }
  friend bool operator==(const RayHit&, const RayHit&) = default;
};

namespace detail {

/// Where a ray enters a box, at most; HUGE_VAL if it certainly misses.
class RayToBox {
 public:
  explicit RayToBox(const Ray& ray) noexcept;
  [[nodiscard]] double entry(const Aabb& box) const noexcept;

 private:
  Ray ray_;
  Point inverse_{};
};

[[noreturn]] void refuse_object(std::size_t position, const Aabb& box);
void check_count(std::size_t n);
void check_point(const Point& p);
void check_radius(double radius);
void check_ray(const Ray& ray);

/// Builds the tree over valid boxes, and sets the boxes of its nodes.
[[nodiscard]] BoxTree<Aabb, 3> tree_over(std::span<const Aabb> boxes);

/// The box of an object in double; a box is its own.
template <class Object>
[[nodiscard]] Aabb aabb_of(const Object& object) {
  const auto convert = [](const auto& box) {
    static_assert(std::tuple_size_v<std::remove_cvref_t<decltype(box.lo)>> == 3,
                  "an Index holds objects in three dimensions");
    return Aabb{{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
  };
  if constexpr (requires { object.lo, object.hi; })
    return convert(object);
  else
    return convert(box_of(object));
}

template <class Object>
concept HasDistance = requires(const Object& o, const Point& p) {
  { distance2(o, p) } -> std::convertible_to<double>;
};
template <class Object>
concept CanBeHit = requires(const Object& o, const Ray& ray) {
  { hit(o, ray) } -> std::convertible_to<std::optional<double>>;
};
template <class Object>
concept MeetsSphere = requires(const Object& o, const Sphere& s) {
  { intersect(s, o, Touching::counts) } -> std::convertible_to<bool>;
};

}  // namespace detail

template <class Object>
class Index {
 public:
  explicit Index(std::span<const Object> objects);

  [[nodiscard]] std::size_t size() const { return objects_.size(); }
  /// The object at a position of the input.
  [[nodiscard]] const Object& object(std::uint32_t position) const {
    return objects_[places_[position]];
  }

  /// The objects of which a point is at most `radius` from `p`, by position. For the library's
  /// shapes this is decided exactly.
  [[nodiscard]] std::vector<std::uint32_t> within(const Point& p, double radius) const;

  /// The `k` nearest objects (fewer if there are no more), near ones first. Distances are rounded;
  /// those that are equal then are equal here: also those below 1e-162 or above 1e154, whose
  /// squares are zero or infinite.
  [[nodiscard]] std::vector<Neighbour> nearest(const Point& p, std::size_t k) const;

  /// The object that a ray meets first, if it meets any.
  [[nodiscard]] std::optional<RayHit> first_hit(const Ray& ray) const;

  /// Each object that a ray meets, with its first point, in the order along the ray.
  [[nodiscard]] std::vector<RayHit> all_hits(const Ray& ray) const;

  /// Calls visit(position, object) for the objects whose boxes `may_meet` allows: a predicate of
  /// boxes that is true for a box if it is true for a box inside.
  template <class MayMeet, class Visit>
  void for_each(const MayMeet& may_meet, const Visit& visit) const;

 private:
  std::optional<double> hit_of(const detail::RayToBox& to_box, const Ray& ray,
                               std::size_t place) const;

  BoxTree<Aabb, 3> tree_;
  std::vector<Object> objects_;        // by place
  std::vector<std::uint32_t> places_;  // by position
};

template <class Object>
Index<Object>::Index(std::span<const Object> objects) {
  detail::check_count(objects.size());
  std::vector<Aabb> boxes(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    boxes[i] = detail::aabb_of(objects[i]);
    if (!is_valid(boxes[i])) detail::refuse_object(i, boxes[i]);
  }
  tree_ = detail::tree_over(boxes);
  objects_.reserve(objects.size());
  places_.resize(objects.size());
  for (std::uint32_t place = 0; place < objects.size(); ++place) {
    objects_.push_back(objects[tree_.object(place)]);
    places_[tree_.object(place)] = place;
  }
}

template <class Object>
template <class MayMeet, class Visit>
void Index<Object>::for_each(const MayMeet& may_meet, const Visit& visit) const {
  tree_.descend([&](std::uint32_t at) {
    const auto& node = tree_.nodes()[at];
    if (!may_meet(node.box)) return false;
    tree_.each_place(node, [&](std::uint32_t i) {
      if (may_meet(detail::aabb_of(objects_[i]))) visit(tree_.object(i), objects_[i]);
    });
    return true;
  });
}

template <class Object>
std::vector<std::uint32_t> Index<Object>::within(const Point& p, double radius) const {
  static_assert(detail::HasDistance<Object> || detail::MeetsSphere<Object>,
                "within() needs a function distance2(const Object&, const Point&) beside the type");
  detail::check_point(p);
  detail::check_radius(radius);
  // Rounding and underflow never leave out a box that is near enough.
  const double limit2 = radius * radius * (1 + 1e-9) + 1e-300;
  std::vector<std::uint32_t> found;
  for_each([&](const Aabb& box) { return distance2(box, p) <= limit2; },
           [&](std::uint32_t position, const Object& object) {
             bool is_near = false;
             if constexpr (detail::MeetsSphere<Object>)
               is_near = intersect(Sphere{p, radius}, object, Touching::counts);
             else
               is_near = distance2(object, p) <= radius * radius;
             if (is_near) found.push_back(position);
           });
  std::sort(found.begin(), found.end());
  return found;
}

template <class Object>
std::vector<Neighbour> Index<Object>::nearest(const Point& p, std::size_t k) const {
  static_assert(
      detail::HasDistance<Object>,
      "nearest() needs a function distance2(const Object&, const Point&) beside the type");
  detail::check_point(p);
  k = std::min(k, size());
  std::vector<Neighbour> best;  // a heap, the furthest first
  if (k == 0) return best;
  best.reserve(k);
  double limit = HUGE_VAL;
  tree_.descend_near([&](const Aabb& box) { return distance2(box, p); }, limit,
                     [&](const auto& leaf) {
                       tree_.each_place(leaf, [&](std::uint32_t i) {
                         // It is not less than the distance of its box, whatever is rounded. So the
                         // order in which the tree is visited has no influence.
                         const double to_box = distance2(detail::aabb_of(objects_[i]), p);
                         if (to_box > limit) return;
                         const double to_object = distance2(objects_[i], p);
                         const Neighbour candidate{tree_.object(i), std::max(to_box, to_object)};
                         if (best.size() == k) {
                           if (!(candidate < best.front())) return;
                           std::pop_heap(best.begin(), best.end());
                           best.pop_back();
                         }
                         best.push_back(candidate);
                         std::push_heap(best.begin(), best.end());
                         if (best.size() == k) limit = best.front().distance2;
                       });
                     });
  std::sort_heap(best.begin(), best.end());
  return best;
}

template <class Object>
std::optional<double> Index<Object>::hit_of(const detail::RayToBox& to_box, const Ray& ray,
                                            std::size_t place) const {
  static_assert(detail::CanBeHit<Object>,
                "rays need a function hit(const Object&, const Ray&) beside the type; a point or a "
                "segment is hit by no ray");
  const double entry = to_box.entry(detail::aabb_of(objects_[place]));
  if (entry == HUGE_VAL) return std::nullopt;
  const std::optional<double> at = hit(objects_[place], ray);
  return at ? std::optional(std::max(*at, entry)) : at;  // not before its box, as above
}

template <class Object>
std::optional<RayHit> Index<Object>::first_hit(const Ray& ray) const {
  detail::check_ray(ray);
  const detail::RayToBox to_box(ray);
  std::optional<RayHit> first;
  double limit = std::numeric_limits<double>::max();
  tree_.descend_near([&](const Aabb& box) { return to_box.entry(box); }, limit,
                     [&](const auto& leaf) {
                       tree_.each_place(leaf, [&](std::uint32_t i) {
                         const std::optional<double> at = hit_of(to_box, ray, i);
                         if (!at) return;
                         const RayHit candidate{tree_.object(i), *at};
                         if (first && !(candidate < *first)) return;
                         first = candidate;
                         limit = std::min(limit, candidate.at);
                       });
                     });
  return first;
}

template <class Object>
std::vector<RayHit> Index<Object>::all_hits(const Ray& ray) const {
  detail::check_ray(ray);
  const detail::RayToBox to_box(ray);
  std::vector<RayHit> hits;
  tree_.descend([&](std::uint32_t at) {
    const auto& node = tree_.nodes()[at];
    if (to_box.entry(node.box) == HUGE_VAL) return false;
    tree_.each_place(node, [&](std::uint32_t i) {
      if (const std::optional<double> t = hit_of(to_box, ray, i))
        hits.push_back({tree_.object(i), *t});
    });
    return true;
  });
  std::sort(hits.begin(), hits.end());
  return hits;
}

}  // namespace tess::collide
