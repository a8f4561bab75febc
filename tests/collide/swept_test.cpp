#include "collide/swept.hpp"

#include "tests/collide/shapes/oracle.hpp"
#include "tests/collide/shapes/rational.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

using MovingBox = Swept<Aabb>;

Rational at(double start, double end, const Rational& t) {
  return Rational(start) + t * (Rational(end) - Rational(start));
}

bool overlap_at(const MovingBox& a, const MovingBox& b, const Rational& t, Touching touching) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational al = at(a.start.lo[k], a.end.lo[k], t), ah = at(a.start.hi[k], a.end.hi[k], t);
    const Rational bl = at(b.start.lo[k], b.end.lo[k], t), bh = at(b.start.hi[k], b.end.hi[k], t);
    if (touching == Touching::counts ? al > bh || bl > ah : al >= bh || bl >= ah) return false;
  }
  return true;
}

/// All times at which two faces are level, 0 and 1, and the middles between: whether boxes overlap
/// changes at the former only.
std::vector<Rational> times(const MovingBox& a, const MovingBox& b) {
  std::vector<Rational> all{0, 1};
  const auto add_crossing = [&](double p0, double p1, double q0, double q1) {
    const Rational start = Rational(p0) - Rational(q0), end = Rational(p1) - Rational(q1);
    if (start == end) return;
    const Rational t = start / (start - end);
    if (t > 0 && t < 1) all.push_back(t);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    add_crossing(a.start.lo[k], a.end.lo[k], b.start.hi[k], b.end.hi[k]);
    add_crossing(b.start.lo[k], b.end.lo[k], a.start.hi[k], a.end.hi[k]);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = all.size() - 1; i > 0; --i) all.push_back((all[i] + all[i - 1]) / 2);
  std::sort(all.begin(), all.end());
  return all;
}

Aabb some_box(SmallPoints& random, int size) {
  return merged(box_of(random.point(size)), box_of(random.point(size)));
}

MovingBox scaled(MovingBox m, int power, double offset) {
  for (Aabb* box : {&m.start, &m.end})
    for (Point* p : {&box->lo, &box->hi})
      for (double& x : *p) x = std::ldexp(x, power) + offset;
  return m;
}

}  // namespace

TEST_CASE("the first contact of moving boxes agrees with rational numbers, touches included",
          "[collide][shapes]") {
  SmallPoints random(1);
  int n_late = 0, n_at_start = 0, n_never = 0, n_instant = 0;
  for (int i = 0; i < 5000; ++i) {
    const int size = 3 + i % 5;
    MovingBox a{some_box(random, size), some_box(random, size)};
    MovingBox b{some_box(random, size), some_box(random, size)};
    if (i % 4 == 1) b.end = b.start;  // at rest
    if (i % 4 == 2) {                 // both move alike on one axis
      b.start.lo[0] = a.start.lo[0] + 1, b.start.hi[0] = a.start.hi[0] + 1;
      b.end.lo[0] = a.end.lo[0] + 1, b.end.hi[0] = a.end.hi[0] + 1;
    }
    if (i % 4 == 3)  // points
      a.start.hi = a.start.lo, a.end.hi = a.end.lo;
    std::optional<Rational> expected;
    bool is_open = false, is_instant = true;
    for (const Rational& t : times(a, b)) {
      if (!overlap_at(a, b, t, Touching::counts)) continue;
      if (!expected) expected = t;
      is_instant &= t == *expected;
      is_open |= overlap_at(a, b, t, Touching::does_not_count);
    }
    const auto contact = first_contact(a, b);
    INFO(i);
    REQUIRE(contact.has_value() == expected.has_value());
    REQUIRE(first_contact(b, a) == contact);
    REQUIRE(intersect(a, b, Touching::counts) == expected.has_value());
    REQUIRE(intersect(a, b, Touching::does_not_count) == is_open);
    for (const auto& [power, offset] :
         {std::pair{0, 1e12}, {30, 0.0}, {-30, 0.0}, {1021, 0.0}, {-1074, 0.0}})
      REQUIRE(first_contact(scaled(a, power, offset), scaled(b, power, offset)) == contact);
    for (const Touching touching : both)
      if (intersect(a, b, touching)) REQUIRE(overlap(box_of(a), box_of(b), touching));
    if (!expected) {
      ++n_never;
      continue;
    }
    REQUIRE(abs(Rational(*contact) - *expected) <= *expected * Rational(0x1p-50));
    ++(*expected == 0 ? n_at_start : n_late);
    n_instant += is_instant && *expected > 0 ? 1 : 0;
  }
  CHECK(std::min({n_late, n_at_start, n_never}) > 500);
  CHECK(n_instant > 50);
}

TEST_CASE("boxes overlap at their first contact, and not at 999 times before",
          "[collide][shapes]") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> some(0, 1);
  const auto box = [&] {
    Aabb out{};
    for (std::size_t k = 0; k < 3; ++k) {
      out.lo[k] = 3 * some(random);
      out.hi[k] = out.lo[k] + some(random);
    }
    return out;
  };
  const auto is_apart = [](const MovingBox& a, const MovingBox& b, double t) {
    const auto between = [&](const Aabb& p, const Aabb& q) {
      Aabb out{};
      for (std::size_t k = 0; k < 3; ++k) {
        out.lo[k] = (1 - t) * p.lo[k] + t * q.lo[k];
        out.hi[k] = (1 - t) * p.hi[k] + t * q.hi[k];
      }
      return out;
    };
    return !overlap(between(a.start, a.end), between(b.start, b.end), Touching::counts);
  };
  int n_late = 0;
  for (int i = 0; i < 600; ++i) {
    const MovingBox a{box(), box()}, b{box(), box()};
    const auto contact = first_contact(a, b);
    const double until = contact ? *contact * (1 - 1e-12) : 1;
    bool all_apart = true;
    for (int s = 0; s < 999; ++s) all_apart &= until == 0 || is_apart(a, b, until * s / 999.0);
    REQUIRE(all_apart);
    if (!contact || *contact == 0) continue;
    ++n_late;
    REQUIRE(is_apart(a, b, *contact - 1e-9));
    // A grazing contact may end at once; a box that is 1e-9 larger overlaps for certain.
    MovingBox larger = a;
    for (Aabb* each : {&larger.start, &larger.end})
      for (std::size_t k = 0; k < 3; ++k) each->lo[k] -= 1e-9, each->hi[k] += 1e-9;
    REQUIRE_FALSE(is_apart(larger, b, *contact));
  }
  CHECK(n_late > 30);
}

TEST_CASE("a box that moves at unit speed touches after the distance", "[collide][shapes]") {
  const Aabb unit{{0, 0, 0}, {1, 1, 1}};
  const MovingBox rest{unit, unit};
  const auto moved = [&](Point by) {
    Aabb out = unit;
    for (std::size_t k = 0; k < 3; ++k) out.lo[k] += by[k], out.hi[k] += by[k];
    return out;
  };
  CHECK(first_contact(rest, {moved({3, 0, 0}), moved({-5, 0, 0})}) == 0.25);
  CHECK_FALSE(first_contact(rest, {moved({3, 3, 0}), moved({-5, 0, 0})}));  // past, too early
  CHECK(first_contact(rest, {moved({3, 3, 0}), moved({-1, 0, 0})}).value() == Approx(2.0 / 3));
  CHECK(first_contact(rest, {moved({0.5, 0.5, 0.5}), moved({9, 9, 9})}) == 0.0);
  CHECK(first_contact(rest, {moved({1, 0, 0}), moved({9, 0, 0})}) == 0.0);  // touches, and leaves
  CHECK_FALSE(intersect(rest, {moved({1, 0, 0}), moved({9, 0, 0})}, Touching::does_not_count));
  CHECK(first_contact(rest, {moved({9, 0, 0}), moved({1, 0, 0})}) == 1.0);  // arrives at the end
  CHECK_FALSE(first_contact(rest, {moved({2, 0, 0}), moved({2, 5, 5})}));
  // Past the corner: it touches the edge x = y = 1 in one instant, or misses it by one ulp.
  CHECK(first_contact(rest, {moved({0, 2, 0}), moved({2, 0, 0})}) == 0.5);
  CHECK_FALSE(first_contact(rest, {moved({0, 2, 0}), moved({2 + 0x1p-51, 0, 0})}));
}
