#include "apps/collide_scene/input/motion.hpp"

#include "apps/collide_scene/input/load.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace collide_scene {
namespace {
using tess::collide::Aabb;
using tess::collide::Point;

/// The median of the longest extents (of an even number the upper one of the two in the middle: a
/// scene's numbers rest on it); 1 if all objects are points.
double median_size(const Scene& scene) {
  std::vector<double> sizes;
  sizes.reserve(scene.n_objects());
  for (const Aabb& box : boxes_of(scene))
    sizes.push_back(
        std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]}));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle > 0 ? *middle : 1;
}

/// A unit vector by number, evenly spread over the sphere.
Point direction(std::uint64_t number) {
  const double z = 2 * tess::unit(tess::mix(2 * number + 1)) - 1;
  const double angle = 2 * std::numbers::pi * tess::unit(tess::mix(2 * number + 2));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace

Motion::Motion(const std::string& text, const Scene& scene) {
  if (text.empty()) {
    kind_ = scene.move ? Kind::own : Kind::still;
    return;
  }
  const auto refuse = [&](const std::string& why) {
    tess::fail(tess::ErrorCode::bad_argument, "--move ", text, ": ", why);
  };
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  std::optional<double> given;
  if (colon != std::string::npos) {
    given = tess::parse_number<double>(std::string_view(text).substr(colon + 1));
    if (!given || !std::isfinite(*given))
      refuse(fmt::format("'{}' is not a finite number", text.substr(colon + 1)));
  }
  if (name == "own" && !given) {
    if (!scene.move) refuse("the scene does not move by itself; give drift or turn");
    kind_ = Kind::own;
  } else if (name == "still" && !given) {
    kind_ = Kind::still;
  } else if (name == "drift") {
    kind_ = Kind::drift;
    amount_ = given.value_or(0.1) * median_size(scene);
    at_first_ = scene;
  } else if (name == "turn") {
    if (scene.triangles.empty()) refuse("boxes do not turn; give drift");
    kind_ = Kind::turn;
    amount_ = given.value_or(1);
    at_first_ = scene;
    std::vector<Aabb> bounds(std::max(1U, n_models(scene)),
                             tess::collide::box_around(std::span<const Point>{}));
    for (std::size_t i = 0; i < scene.triangles.size(); ++i)
      bounds[group_of(i)] = merged(bounds[group_of(i)], box_of(scene.triangles[i]));
    for (const Aabb& box : bounds) {
      Point& centre = centres_.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) centre[k] = box.lo[k] + 0.5 * (box.hi[k] - box.lo[k]);
    }
  } else {
    refuse("there are own, still, drift[:D] and turn[:DEGREES]");
  }
}

std::uint32_t Motion::group_of(std::size_t object) const noexcept {
  if (!at_first_.models.empty()) return at_first_.models[object];
  return kind_ == Kind::drift ? static_cast<std::uint32_t>(object) : 0;
}

void Motion::place(int step, Scene& scene) const {
  if (kind_ == Kind::own) scene.move(step, scene);
  if (kind_ == Kind::drift) {
    for (std::size_t i = 0; i < scene.n_objects(); ++i) {
      const Point way = direction(group_of(i));
      const auto shift = [&](Point& to, const Point& from) {
        for (std::size_t k = 0; k < 3; ++k) to[k] = from[k] + step * amount_ * way[k];
      };
      if (i < scene.triangles.size()) {
        for (std::size_t c = 0; c < 3; ++c)
          shift(scene.triangles[i].corners[c], at_first_.triangles[i].corners[c]);
      } else {
        const std::size_t box = i - scene.triangles.size();
        shift(scene.boxes[box].lo, at_first_.boxes[box].lo);
        shift(scene.boxes[box].hi, at_first_.boxes[box].hi);
      }
    }
  }
  if (kind_ == Kind::turn) {
    const double angle = step * amount_ * std::numbers::pi / 180;
    const double cosine = std::cos(angle);
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      const std::uint32_t model = group_of(i);
      const Point& centre = centres_[model];
      const double sine = model % 2 == 0 ? std::sin(angle) : -std::sin(angle);
      for (std::size_t c = 0; c < 3; ++c) {
        const Point& from = at_first_.triangles[i].corners[c];
        if (step == 0) {
          scene.triangles[i].corners[c] = from;
          continue;
        }
        const double x = from[0] - centre[0], y = from[1] - centre[1];
        scene.triangles[i].corners[c] = {centre[0] + cosine * x - sine * y,
                                         centre[1] + sine * x + cosine * y, from[2]};
      }
    }
  }
}

std::string Motion::describe() const {
  switch (kind_) {
    case Kind::own:
      return "as the scene moves by itself";
    case Kind::still:
      return "none";
    case Kind::drift:
      return fmt::format("each model drifts {:.4g} per step", amount_);
    case Kind::turn:
      return fmt::format("each model turns {:.4g} degrees per step", amount_);
  }
  return {};
}

}  // namespace collide_scene
