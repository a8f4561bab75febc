#include <array>
#include <collide/dn_field/build_field.hpp>
#include <collide/dn_field/look_up.hpp>
#include <collide/dn_field/shapes.hpp>
#include <cstdio>

using namespace tess::dn;

int main() {
  const Surface ball = make_sphere(1, 24);
  const Field field = build_field(ball, grid_around(bounds(ball), 40, 0.5), {.thickness = 2});
  const std::array<float, 1> x{0}, y{0.5F}, z{0};
  std::array<float, 1> distance{};
  look_up(field, LookUp::trilinear, {x, y, z}, {.distance = distance});
  std::printf("distance %.2f\n", static_cast<double>(distance[0]));
}
