// The pose of a moving object at fractions f of a step, and straight paths in the world as seen
// from the object: in the place, orientation and size that it has when the step begins, where its
// field is sampled. Exact at every f; a spin bends the path between. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/nearest_surface.hpp"
#include "collide/dn_field/rules/spring.hpp"

namespace tess::dn::lanes {

/// v turned about the unit vector `axis` (Rodrigues).
inline D3 turned(D3 v, Vec3 axis, Turn by) {
  const D along = (1.0 - by.cosine) * (axis.x * v.x + axis.y * v.y + axis.z * v.z);
  const D3 level = fma(by.cosine, v, by.sine * cross(axis, v));
  return {level.x + along * axis.x, level.y + along * axis.y, level.z + along * axis.z};
}

/// An object's pose at f.
class Pose {
 public:
  Pose(const PlacedObject& object, D f)
      : object_(object), f_(f), size_(1.0 + f * object.growth), spins_(object.spin != 0) {
    if (!spins_) return;
    axis_ = direction(object.frame.angular_velocity);
    by_ = turn_any(f * (object.step * norm(object.frame.angular_velocity)));
  }

  [[nodiscard]] D size() const { return size_; }
  /// Turns a vector from the step's start to now, and back, without scaling it.
  [[nodiscard]] D3 now(D3 v) const { return spins_ ? turned(v, axis_, by_) : v; }
  [[nodiscard]] D3 begin(D3 v) const {
    return spins_ ? turned(v, axis_, {by_.cosine, -by_.sine}) : v;
  }
  /// x relative to the object's origin.
  [[nodiscard]] D3 arm(D3 x) const { return (x - object_.frame.position) - gone(); }
  /// A point of the world as seen from the object, and back.
  [[nodiscard]] D3 seen(D3 x) const { return 1.0 / size_ * begin(arm(x)) + object_.frame.position; }
  [[nodiscard]] D3 place(D3 seen) const {
    return gone() + (size_ * now(seen - object_.frame.position) + object_.frame.position);
  }
  /// Velocity of the surface at `x`; its own point is `beside` from there, which matters for
  /// growth.
  [[nodiscard]] D3 surface_velocity(D3 x, D3 beside) const {
    const Frame& frame = object_.frame;
    const D3 q = arm(x);
    const D3 u = spins_ ? stiff_velocity(frame, q) : all(frame.velocity);
    return frame.is_growing() ? fma(frame.scale_rate / frame.scale / size_, q - beside, u) : u;
  }

 private:
  /// Displacement of the object's origin since the step's start.
  [[nodiscard]] D3 gone() const { return f_ * object_.step * all(object_.frame.velocity); }

  const PlacedObject& object_;
  D f_, size_;
  bool spins_;
  Vec3 axis_;
  Turn by_{};
};

/// A particle's place at f as seen from an object, and its velocity there, per step.
struct Seen {
  D3 place, way;
};

/// Of a particle that is at x at f and moves by `way` per step in the world.
inline Seen seen(const PlacedObject& object, const Pose& pose, D3 x, D3 way) {
  const Frame& frame = object.frame;
  const D3 drift = way - object.step * frame.velocity;
  if (!object.bends()) return {pose.seen(x), drift};
  const D3 q = pose.arm(x);
  const D3 rate = drift - cross(object.step * frame.angular_velocity, q);
  const D per = 1.0 / pose.size();
  return {pose.seen(x), per * pose.begin(fma(-object.growth * per, q, rate))};
}

/// Bounds of a bent path for times t up to `valid`: its displacement is at most speed t + gain t²,
/// and its deviation from the straight path at most bend t²/2.
struct Bend {
  D speed, gain, bend, valid;

  /// Lower bound of the time to a displacement of `free`.
  [[nodiscard]] D time_for(D free) const {
    return 2.0 * free / (speed + sqrt(fma(4.0 * gain, free, speed * speed)));
  }
  /// Lower bound of the time to a deviation of `off`.
  [[nodiscard]] D time_within(double off) const { return sqrt(2.0 * off / bend); }
};
inline Bend bend_of(const PlacedObject& object, const Pose& pose, D3 x, D3 way) {
  const D3 drift = way - object.step * object.frame.velocity, q = pose.arm(x);
  const D through = sqrt(dot(drift, drift)), r = sqrt(dot(q, q)), per = 1.0 / pose.size();
  // Seen from a shrinking object all lengths grow: valid until it has half its size.
  const bool shrinks = object.growth < 0;
  const D more = (shrinks ? 2.0 : 1.0) * per, grows = std::abs(object.growth) * more,
          turns = static_cast<double>(object.spin) + grows;
  return {more * (through + turns * r), more * (turns * through),
          more * turns * (2.0 * through + (turns + grows) * r),
          shrinks ? pose.size() * (-0.5 / object.growth) : all(HUGE_VAL)};
}

}  // namespace tess::dn::lanes
