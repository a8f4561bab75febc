#include "collide/dn_field/frame.hpp"

#include "apps/kit/worst.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

namespace {

using namespace tess::dn;

constexpr double pi = 3.14159265358979323846;

double deviation(const Frame& frame) {  // from orthonormal, right-handed axes
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      kit::worsen(worst, std::abs(dot(frame.axes[i], frame.axes[j]) - (i == j ? 1 : 0)));
  kit::worsen(worst, norm(cross(frame.axes[0], frame.axes[1]) - frame.axes[2]));
  return worst;
}

TEST_CASE("to_object undoes to_world", "[dn_field][frame]") {
  Frame frame;
  frame.axes = rotation({1, 2, -0.5});
  frame.position = {3, -4, 5};
  frame.scale = 0.25;
  const Vec3 p{0.3, 0.7, -1.1};
  CHECK(norm(frame.to_object(frame.to_world(p)) - p) < 1e-14);
  CHECK(norm(frame.to_world(p) - frame.to_world({})) == Approx(0.25 * norm(p)));
}

TEST_CASE("a rotation by half a turn about z flips x and y", "[dn_field][frame]") {
  const auto axes = rotation({0, 0, pi});
  CHECK(norm(axes[0] - Vec3{-1, 0, 0}) < 1e-15);
  CHECK(norm(axes[1] - Vec3{0, -1, 0}) < 1e-15);
  CHECK(axes[2] == Vec3{0, 0, 1});
  CHECK(rotation({}) == Frame{}.axes);
}

TEST_CASE("a frame that advances comes round, and its axes stay orthonormal", "[dn_field][frame]") {
  Frame frame;
  frame.velocity = {1, 0, -2};
  frame.angular_velocity = 2 * pi * direction({1, 2, 3});
  for (int i = 0; i < 10'000; ++i) frame.advance(1e-3);
  CHECK(deviation(frame) < 1e-14);
  CHECK(norm(frame.axes[0] - Vec3{1, 0, 0}) < 1e-10);  // ten turns
  CHECK(norm(frame.position - Vec3{10, 0, -20}) < 1e-10);
}

TEST_CASE("the surface's velocity is the derivative of where its points stand",
          "[dn_field][frame][growth]") {
  for (const double scale_rate : {0.0, -0.7}) {
    INFO("scale rate " << scale_rate);
    Frame frame;
    frame.axes = rotation({0.1, 0.2, 0.3});
    frame.position = {1, 2, 3};
    frame.scale = 2;
    frame.velocity = {0.5, -1, 0.25};
    frame.angular_velocity = {2, -1, 0.5};
    frame.scale_rate = scale_rate;
    const Vec3 own{0.4, -0.6, 0.2}, at = frame.to_world(own);
    const double step = 1e-6;
    Frame later = frame;
    later.advance(step);
    const Vec3 arm = at - frame.position;
    const Vec3 velocity =
        frame.velocity + cross(frame.angular_velocity, arm) + 0.5 * scale_rate * arm;
    CHECK(norm((1 / step) * (later.to_world(own) - at) - velocity) < 1e-5);
    CHECK(later.scale == Approx(2 + 1e-6 * scale_rate).epsilon(1e-12));
    CHECK(frame.is_moving());
  }
}

TEST_CASE("a matrix with shear, zero or unequal scale, or a mirror is refused by its reason",
          "[dn_field][frame]") {
  const auto refusal = [](const std::array<Vec3, 3>& columns) {
    return tess::test::message_of([&] { (void)frame_from(columns, {}); });
  };
  const auto has = [](const std::string& text, const char* part) {
    INFO(text);
    CHECK_THAT(text, Contains(part));
  };
  has(refusal({{{1, 0, 0}, {0.1, 1, 0}, {0, 0, 1}}}), "shear between axes 0 and 1");
  has(refusal({{{1, 0, 0}, {0.6, 0.8, 0}, {0, 0, 1}}}), "shear between axes 0 and 1");
  has(refusal({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}), "zero scale");
  has(refusal({{{1, 0, 0}, {0, 2, 0}, {0, 0, 1}}}), "uniform scale");
  has(refusal({{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}), "mirrors");
  has(refusal({{{1, 0, 0}, {0, std::nan(""), 0}, {0, 0, 1}}}), "finite");
  const auto axes = rotation({1, -2, 0.5});
  const Frame frame = frame_from({{3 * axes[0], 3 * axes[1], 3 * axes[2]}}, {1, 2, 3});
  CHECK(frame.scale == Approx(3));
  CHECK(deviation(frame) < 1e-14);
}

}  // namespace
