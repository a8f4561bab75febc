// Boxes that move over a time step: their box over the step, and when two of them first touch. This
// is the fourth axis of the voxel method (Lawlor and Kalé 2002, section 2): a broad phase over
// box_of() of swept boxes finds the pairs that may touch within the step, and intersect() those
// that do.
#pragma once

#include "collide/box.hpp"
#include "collide/capsule.hpp"

#include <optional>

namespace tess::collide {

/// A box whose corners move along straight lines, from `start` at time 0 to `end` at time 1. Both
/// have the same type, and are valid (is_valid()).
template <class Box = Aabb>
struct Swept {
  Box start;
  Box end;

  friend bool operator==(const Swept&, const Swept&) = default;
};

/// The smallest box that contains the moving box at all times of the step; not valid if `start` or
/// `end` is not.
template <class Box>
[[nodiscard]] Box box_of(const Swept<Box>& swept) noexcept {
  if (!is_valid(swept.start)) return swept.start;
  if (!is_valid(swept.end)) return swept.end;
  return merged(swept.start, swept.end);
}

/// A capsule around the way of the centre: of a box that moves far it is much thinner than
/// box_of().
[[nodiscard]] Capsule capsule_of(const Swept<Aabb>& swept) noexcept;
[[nodiscard]] inline Capsule capsule_of(const Swept<Box<float, 3>>& swept) noexcept {
  return capsule_of(Swept<Aabb>{in_double(swept.start), in_double(swept.end)});
}

namespace detail {

/// How far a lower face is above an upper face, at the start and at the end. The boxes overlap on
/// this axis while no gap is open. The four coordinates are kept, because a difference is rounded.
struct Gap {
  double low_at_start, high_at_start, low_at_end, high_at_end;
};

/// The first time in [0, 1] at which no gap is open, or the earliest after which none is if touching
/// does not count. Whether there is one is decided exactly; the time has a relative error below
/// 2^-50.
[[nodiscard]] std::optional<double> first_closed(std::span<const Gap> gaps,
                                                 Touching touching) noexcept;

template <class Box>
[[nodiscard]] std::optional<double> first_closed(const Swept<Box>& a, const Swept<Box>& b,
                                                 Touching touching) noexcept {
  constexpr std::size_t n_axes = std::tuple_size_v<decltype(Box::lo)>;
  std::array<Gap, 2 * n_axes> gaps{};
  for (std::size_t k = 0; k < n_axes; ++k) {
    gaps[2 * k] = {a.start.lo[k], b.start.hi[k], a.end.lo[k], b.end.hi[k]};
    gaps[2 * k + 1] = {b.start.lo[k], a.start.hi[k], b.end.lo[k], a.end.hi[k]};
  }
  return first_closed(gaps, touching);
}

}  // namespace detail

/// The first time in [0, 1] at which two moving boxes have a common point: 0 if they overlap at the
/// start, nothing if they never do. Boxes that touch for an instant only are found, too: whether
/// there is a contact is decided exactly. The time has a relative error below 2^-50.
template <class Box>
[[nodiscard]] std::optional<double> first_contact(const Swept<Box>& a,
                                                  const Swept<Box>& b) noexcept {
  return detail::first_closed(a, b, Touching::counts);
}

/// Whether two moving boxes overlap at some time of the step. If touching does not count, they must
/// do so as open boxes.
template <class Box>
[[nodiscard]] bool intersect(const Swept<Box>& a, const Swept<Box>& b, Touching touching) noexcept {
  return detail::first_closed(a, b, touching).has_value();
}

}  // namespace tess::collide
