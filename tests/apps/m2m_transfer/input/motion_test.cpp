#include "apps/m2m_transfer/input/motion.hpp"

#include "tests/support/catch.hpp"

#include <numbers>

using namespace m2m_transfer;

namespace {
const std::vector<std::string> two_meshes{"kuhn:2", "kuhn:3"};
}  // namespace

TEST_CASE("a motion names its mesh, or moves the default", "[apps][motion]") {
  const StepMotion turn = parse_motion("kuhn:2:rotate(0,0,2,90deg)", two_meshes, 1);
  CHECK(turn.mesh == 0);
  CHECK(turn.motion.angle == Approx(std::numbers::pi / 2));
  CHECK(turn.about_middle);
  const StepMotion about = parse_motion("rotate(1,0,0,-30deg,1,2,3)", two_meshes, 1);
  CHECK(about.mesh == 1);
  CHECK(about.motion.angle == Approx(-std::numbers::pi / 6));
  CHECK_FALSE(about.about_middle);
  CHECK(about.motion.centre == Point{1, 2, 3});
  CHECK(parse_motion("A:translate(1,-2,3e-1)", two_meshes, 1).motion.translation ==
        Point{1, -2, 0.3});
}

TEST_CASE("a motion with a mistake is refused with the grammar", "[apps][motion]") {
  for (const char* text : {"", "B", "B:turn(1,2,3)", "B:rotate(0,0,1)", "B:rotate(0,0,1,5rad)",
                           "B:rotate(0,0,1,5)", "B:translate(1,2)", "B:translate(1,2,nan)",
                           "B:translate(1,2,x)", "B:translate(1,2,3", "B:translate(1,2,3deg)"})
    CHECK_THROWS_WITH(parse_motion(text, two_meshes, 1), Contains("MESH:rotate("));
  CHECK_THROWS_WITH(parse_motion("B:rotate(0,0,0,5deg)", two_meshes, 1),
                    Contains("axis (0, 0, 0)"));
  CHECK_THROWS_WITH(parse_motion("C:translate(1,0,0)", two_meshes, 1), Contains("'C' is no mesh"));
}

TEST_CASE("motions that are undone lead back", "[apps][motion]") {
  const std::vector<RigidMotion> motions{
      {.axis = {1, 2, 3}, .angle = 0.7, .centre = {0.5, 0, 1}, .translation = {0.1, 0.2, 0.3}},
      {.axis = {0, -1, 0}, .angle = 2, .centre = {3, 0, 0}}};
  std::vector<Point> points{{0.25, 0.5, 0.75}, {-1, 2, 8}};
  const std::vector<Point> before = points;
  for (const RigidMotion& motion : motions) move_points(points, motion);
  CHECK(points[0] != before[0]);
  for (const RigidMotion& motion : opposite(motions)) move_points(points, motion);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      CHECK(points[i][axis] == Approx(before[i][axis]).margin(1e-14));
}
