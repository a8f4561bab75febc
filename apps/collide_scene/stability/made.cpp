#include "apps/collide_scene/stability/made.hpp"

#include "runtime/core/hash.hpp"

#include <cmath>
#include <type_traits>

namespace collide_scene::stability {
namespace {

using tess::collide::Aabb;
using tess::collide::Point;
using tess::collide::Triangle;

Point random_point(tess::Random& random, double half) {
  Point p{};
  for (double& at : p) at = half * (2 * random.unit() - 1);
  return p;
}

Aabb box_at(const Point& centre, const Point& extent) {
  Aabb box{};
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = centre[k] - 0.5 * extent[k];
    box.hi[k] = centre[k] + 0.5 * extent[k];
  }
  return box;
}

Triangle triangle_at(tess::Random& random, const Point& centre, double size) {
  Triangle triangle{};
  for (Point& corner : triangle.corners) {
    corner = random_point(random, size);
    for (std::size_t k = 0; k < 3; ++k) corner[k] += centre[k];
  }
  return triangle;
}

/// Between 10^-decades and 1.
double log_uniform(tess::Random& random, double decades) {
  return std::pow(10, -decades * random.unit());
}

/// A scene of n objects, each made by make(random, i): boxes or triangles.
template <class Make>
Scene scene_of(std::size_t n, std::uint64_t seed, const Make& make) {
  tess::Random random(seed);
  Scene scene;
  for (std::size_t i = 0; i < n; ++i) {
    const auto object = make(random, i);
    if constexpr (std::is_same_v<decltype(object), const Aabb>)
      scene.boxes.push_back(object);
    else
      scene.triangles.push_back(object);
  }
  return scene;
}

}  // namespace

Scene random_boxes_around_zero(std::size_t n) {
  const double edge = 2 * std::cbrt(1.0 / static_cast<double>(n));
  return scene_of(n, 3, [&](tess::Random& random, std::size_t) {
    const auto extent = [&] { return 2 * edge * random.unit(); };
    const Point size{extent(), extent(), extent()};
    return box_at(random_point(random, 1), size);
  });
}

Scene random_triangles(std::size_t n) {
  return scene_of(n, 5, [](tess::Random& random, std::size_t) {
    const Point centre = random_point(random, 1);
    return triangle_at(random, centre, 0.25);
  });
}

Scene changed(Scene scene, double scale, double offset) {
  const auto change = [&](Point& p) {
    for (double& at : p) at = at * scale + offset;
  };
  for (Triangle& triangle : scene.triangles)
    for (Point& corner : triangle.corners) change(corner);
  for (Aabb& box : scene.boxes) {
    change(box.lo);
    change(box.hi);
  }
  return scene;
}

Scene in_models(Scene scene, std::uint32_t n) {
  scene.models.clear();
  for (std::size_t i = 0; i < scene.n_objects(); ++i)
    scene.models.push_back(static_cast<std::uint32_t>(i % n));
  return scene;
}

Scene without_models(Scene scene) {
  scene.models.clear();
  return scene;
}

Scene each_twice(Scene scene) {
  const auto twice = [](auto& list) {
    const auto once = list;
    list.insert(list.end(), once.begin(), once.end());
  };
  twice(scene.triangles);
  twice(scene.boxes);
  return scene;
}

Scene with_one_over_all(Scene scene, double times) {
  const double t = times;
  if (scene.triangles.empty())
    scene.boxes.push_back(box_at({0, 0, 0}, {2 * t, 2 * t, 2 * t}));
  else
    scene.triangles.push_back(
        {{Point{-3 * t, -2 * t, 0.1}, Point{3 * t, -2 * t, -0.2}, Point{0, 4 * t, 0.05}}});
  return scene;
}

Scene lattice(int n) {
  Scene scene;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        scene.boxes.push_back(
            {{0.1 * i, 0.1 * j, 0.1 * k}, {0.1 * i + 0.15, 0.1 * j + 0.15, 0.1 * k + 0.15}});
  return scene;
}

Scene face_to_face(int n) {
  Scene scene;
  for (int i = -n / 2; i < n - n / 2; ++i)
    for (int j = -n / 2; j < n - n / 2; ++j)
      for (int k = -n / 2; k < n - n / 2; ++k) {
        const double x = i, y = j, z = k;
        scene.boxes.push_back({{x, y, z}, {x + 1, y + 1, z + 1}});
      }
  return scene;
}

Scene identical_boxes(std::size_t n) {
  Scene scene;
  scene.boxes.assign(n, {{0.1, 0.2, 0.3}, {0.4, 0.6, 0.7}});
  return scene;
}

Scene identical_triangles(std::size_t n) {
  Scene scene;
  scene.triangles.assign(n, {{Point{0.1, 0.2, 0.3}, Point{0.7, 0.1, 0.2}, Point{0.3, 0.9, 0.5}}});
  return scene;
}

Scene flat_boxes(std::size_t n, int n_flat) {
  return scene_of(n, 7, [&](tess::Random& random, std::size_t) {
    Point lo{}, hi{};
    for (double& at : lo) at = 0.1 * static_cast<double>(random.below(6));
    const std::uint64_t first = random.below(3);
    for (std::uint64_t k = 0; k < 3; ++k) {
      const std::size_t axis = (first + k) % 3;
      const bool flat = k < static_cast<std::uint64_t>(n_flat);
      hi[axis] = lo[axis] + (flat ? 0 : 0.1 * static_cast<double>(random.below(3)));
    }
    return Aabb{lo, hi};
  });
}

Scene mixed_boxes(std::size_t n, double decades) {
  return scene_of(n, 11, [&](tess::Random& random, std::size_t) {
    const double edge = 0.6 * log_uniform(random, decades);
    return box_at(random_point(random, 1), {edge, edge, edge});
  });
}

Scene mixed_triangles(std::size_t n, double decades) {
  return scene_of(n, 13, [&](tess::Random& random, std::size_t) {
    const Point centre = random_point(random, 1);
    const double size = log_uniform(random, decades);
    return triangle_at(random, centre, size);
  });
}

Scene needle_boxes(std::size_t n, double aspect) {
  constexpr double length = 0.35;
  return scene_of(n, 17, [&](tess::Random& random, std::size_t) {
    // On a lattice, so that thin ones meet, too.
    Point centre{}, extent{};
    for (double& at : centre) at = 0.1 * static_cast<double>(random.below(10));
    const std::uint64_t along = random.below(3);
    for (std::size_t k = 0; k < 3; ++k) extent[k] = k == along ? length : length / aspect;
    return box_at(centre, extent);
  });
}

Scene needle_triangles(std::size_t n, double aspect) {
  constexpr double length = 0.6;
  return scene_of(n, 19, [&](tess::Random& random, std::size_t i) {
    Triangle triangle{};
    auto& [a, b, c] = triangle.corners;
    a = random_point(random, 1);
    if (i % 2 == 0) a[2] = 0;  // half of them near a plane, where they meet
    for (std::size_t k = 0; k < 3; ++k) {
      b[k] = a[k] + (k == 2 && i % 2 == 0 ? 0 : length * (random.unit() - 0.5));
      c[k] = a[k] + length / aspect * random.unit();
    }
    return triangle;
  });
}

Scene in_one_plane(std::size_t n, double slope) {
  Scene scene = random_triangles(n);
  for (Triangle& triangle : scene.triangles)
    for (Point& p : triangle.corners) {
      for (double& at : p) at = std::round(at * 64) / 64;
      p[2] = slope * (p[0] + 2 * p[1]);
    }
  return scene;
}

Scene degenerate_triangles(std::size_t n) {
  Scene scene = random_triangles(n);
  for (std::size_t i = 0; i < n; ++i) {
    auto& [a, b, c] = scene.triangles[i].corners;
    for (Point* p : {&a, &b, &c})
      for (double& at : *p) at = std::round(at * 8) / 8;
    if (i % 4 == 0) b = a;                                                         // a segment
    if (i % 4 == 1) b = c = a;                                                     // a point
    for (std::size_t k = 0; i % 4 == 2 && k < 3; ++k) c[k] = 0.5 * (a[k] + b[k]);  // in a row
  }
  return scene;
}

}  // namespace collide_scene::stability
