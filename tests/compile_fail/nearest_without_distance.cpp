// expect: nearest() needs a function distance2(const Object&, const Point&) beside the type
#include "collide/queries.hpp"

struct Cloud {
  tess::collide::Aabb box;
};
tess::collide::Aabb box_of(const Cloud& cloud) {
  return cloud.box;
}

void misuse(const tess::collide::Index<Cloud>& clouds) {
  (void)clouds.nearest({0, 0, 0}, 1);
}
