// Straight ways in the world as a moving object sees them: at fractions f of a step, in the place,
// attitude and size that the object has when the step begins (where its field is looked up). Exact
// at every f; a spin bends the way between, growth slows it down. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/placed_lanes.hpp"
#include "collide/dn_field/rules/spring_lanes.hpp"

namespace tess::dn::lanes {

/// v turned about the unit vector `axis` (Rodrigues).
inline D3 turned(D3 v, Vec3 axis, Turn by) {
  const D along = (1.0 - by.cosine) * (axis.x * v.x + axis.y * v.y + axis.z * v.z);
  const D3 level = fma(by.cosine, v, by.sine * cross(axis, v));
  return {level.x + along * axis.x, level.y + along * axis.y, level.z + along * axis.z};
}

/// How an object stands at f.
class Pose {
 public:
  Pose(const Placed& object, D f)
      : object_(object), f_(f), size_(1.0 + f * object.growth), spins_(object.spin != 0) {
    if (!spins_) return;
    axis_ = direction(object.frame.angular_velocity);
    by_ = turn_any(f * (object.step * norm(object.frame.angular_velocity)));
  }

  [[nodiscard]] D size() const { return size_; }
  /// A vector of the step's begin as it is now, but for its size; and the other way about.
  [[nodiscard]] D3 now(D3 v) const { return spins_ ? turned(v, axis_, by_) : v; }
  [[nodiscard]] D3 begin(D3 v) const {
    return spins_ ? turned(v, axis_, {by_.cosine, -by_.sine}) : v;
  }
  /// From the object's origin.
  [[nodiscard]] D3 arm(D3 x) const { return (x - object_.frame.position) - gone(); }
  /// A point as the object sees it; and the other way about.
  [[nodiscard]] D3 seen(D3 x) const { return 1.0 / size_ * begin(arm(x)) + object_.frame.position; }
  [[nodiscard]] D3 place(D3 seen) const {
    return gone() + (size_ * now(seen - object_.frame.position) + object_.frame.position);
  }
  /// Of the surface at `x`, which stands `beside` its own points (growth takes those along).
  [[nodiscard]] D3 surface_velocity(D3 x, D3 beside) const {
    const Frame& frame = object_.frame;
    const D3 q = arm(x);
    const D3 u = spins_ ? stiff_velocity(frame, q) : all(frame.velocity);
    return frame.is_growing() ? fma(frame.scale_rate / frame.scale / size_, q - beside, u) : u;
  }

 private:
  /// The way of the object's origin since the step's begin.
  [[nodiscard]] D3 gone() const { return f_ * object_.step * all(object_.frame.velocity); }

  const Placed& object_;
  D f_, size_;
  bool spins_;
  Vec3 axis_;
  Turn by_{};
};

/// Where a particle is at f, and how it flies there: by `way` a step at this moment.
struct Seen {
  D3 place, way;
};

/// A particle at x at f that flies by `way` a step, in the world.
inline Seen seen(const Placed& object, const Pose& pose, D3 x, D3 way) {
  const Frame& frame = object.frame;
  const D3 drift = way - object.step * frame.velocity;
  if (!object.bends()) return {pose.seen(x), drift};
  const D3 q = pose.arm(x);
  const D3 rate = drift - cross(object.step * frame.angular_velocity, q);
  const D per = 1.0 / pose.size();
  return {pose.seen(x), per * pose.begin(fma(-object.growth * per, q, rate))};
}

/// How a way bends, in a time t up to `valid`: it comes no further than speed t + gain t², and no
/// further than bend t²/2 off the straight one.
struct Bend {
  D speed, gain, bend, valid;

  /// How long it takes to go as far as `free`, at least.
  [[nodiscard]] D time_for(D free) const {
    return 2.0 * free / (speed + sqrt(fma(4.0 * gain, free, speed * speed)));
  }
  /// How long it stays as near as `off` to the straight way, at least.
  [[nodiscard]] D time_within(double off) const { return sqrt(2.0 * off / bend); }
};
inline Bend bend_of(const Placed& object, const Pose& pose, D3 x, D3 way) {
  const D3 drift = way - object.step * object.frame.velocity, q = pose.arm(x);
  const D through = sqrt(dot(drift, drift)), r = sqrt(dot(q, q)), per = 1.0 / pose.size();
  // The smaller the object, the larger is all that it sees: until it is half as large.
  const bool shrinks = object.growth < 0;
  const D more = (shrinks ? 2.0 : 1.0) * per, grows = std::abs(object.growth) * more,
          turns = static_cast<double>(object.spin) + grows;
  return {more * (through + turns * r), more * (turns * through),
          more * turns * (2.0 * through + (turns + grows) * r),
          shrinks ? pose.size() * (-0.5 / object.growth) : all(HUGE_VAL)};
}

}  // namespace tess::dn::lanes
