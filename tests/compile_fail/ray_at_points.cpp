// expect: a point or a segment is hit by no ray
#include "collide/queries.hpp"

void misuse(const tess::collide::Index<tess::collide::Point>& points) {
  (void)points.first_hit({{0, 0, 0}, {1, 0, 0}});
}
