#include "collide/swept.hpp"

#include "collide/shapes/sign_of.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::collide {
namespace {

Point centre(const Aabb& box) noexcept {
  Point out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = 0.5 * box.lo[k] + 0.5 * box.hi[k];
  return out;
}

/// Of a ball around `at` that contains the box; not less, whatever is rounded.
double radius(const Aabb& box, const Point& at) noexcept {
  Point half;
  for (std::size_t k = 0; k < 3; ++k) half[k] = std::max(box.hi[k] - at[k], at[k] - box.lo[k]);
  const double most = std::max({half[0], half[1], half[2]});
  if (!(most > 0)) return most;
  double squares = 0;
  for (const double h : half) squares += (h / most) * (h / most);
  return most * std::sqrt(squares) * (1 + 0x1p-48) + std::numeric_limits<double>::denorm_min();
}

}  // namespace

Capsule capsule_of(const Swept<Aabb>& swept) noexcept {
  const Point from = centre(swept.start), to = centre(swept.end);
  return {from, to, std::max(radius(swept.start, from), radius(swept.end, to))};
}

}  // namespace tess::collide

namespace tess::collide::detail {
namespace {

bool is_open_at_start(const Gap& g, Touching touching) noexcept {
  return touching == Touching::counts ? g.low_at_start > g.high_at_start
                                      : g.low_at_start >= g.high_at_start;
}
bool is_open_at_end(const Gap& g, Touching touching) noexcept {
  return touching == Touching::counts ? g.low_at_end > g.high_at_end
                                      : g.low_at_end >= g.high_at_end;
}

/// When a gap that is open at the start is closed: at s / (s - e) of its two widths.
double closing_time(const Gap& g) noexcept {
  const double start = g.low_at_start - g.high_at_start, end = g.low_at_end - g.high_at_end;
  if (start - end <= 0x1p1000) return start / (start - end);
  using shapes::ExactNumber;
  const ExactNumber s = ExactNumber(g.low_at_start) - ExactNumber(g.high_at_start);
  const ExactNumber e = ExactNumber(g.low_at_end) - ExactNumber(g.high_at_end);
  return ExactNumber::quotient(s, s - e);
}

/// Whether a gap has closed when another opens. If touching does not count, it must close before.
bool closes_in_time(const Gap& closing, const Gap& opening, Touching touching) noexcept {
  // s / (s - e) <= t / (t - f), with s - e > 0 and t - f < 0, means t e - s f >= 0.
  const int sign = shapes::sign_of([&](auto number) {
    const auto s = number(closing.low_at_start) - number(closing.high_at_start);
    const auto e = number(closing.low_at_end) - number(closing.high_at_end);
    const auto t = number(opening.low_at_start) - number(opening.high_at_start);
    const auto f = number(opening.low_at_end) - number(opening.high_at_end);
    return t * e - s * f;
  });
  return touching == Touching::counts ? sign >= 0 : sign > 0;
}

}  // namespace

std::optional<double> first_closed(std::span<const Gap> gaps, Touching touching) noexcept {
  double time = 0;
  for (const Gap& g : gaps) {
    if (!is_open_at_start(g, touching)) continue;
    if (is_open_at_end(g, touching)) return std::nullopt;
    const double t = closing_time(g);
    time = t > time ? t : time;
  }
  // Each gap that closes must do so before any other opens.
  for (const Gap& closing : gaps) {
    if (!is_open_at_start(closing, touching)) continue;
    for (const Gap& opening : gaps)
      if (is_open_at_end(opening, touching) && !closes_in_time(closing, opening, touching))
        return std::nullopt;
  }
  return time;
}

}  // namespace tess::collide::detail
