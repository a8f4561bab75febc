// expect: pairs of objects that are no boxes need bool intersect(const A&, const B&, Touching)
#include "collide/pairs.hpp"

struct Disc {
  double x = 0, y = 0, radius = 0;
};
inline tess::collide::Box<double, 2> box_of(const Disc& disc) {
  return {{disc.x - disc.radius, disc.y - disc.radius},
          {disc.x + disc.radius, disc.y + disc.radius}};
}

void misuse(const std::vector<Disc>& discs) {
  (void)tess::collide::count_pairs(std::span<const Disc>(discs));
}
