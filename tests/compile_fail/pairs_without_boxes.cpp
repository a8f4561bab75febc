// expect: objects that are searched need Box<Real, D> box_of(const Object&) beside their type
#include "collide/pairs.hpp"

struct Ring {
  double x = 0, y = 0, radius = 0;
};
inline bool intersect(const Ring&, const Ring&, tess::collide::Touching) {
  return true;
}

void misuse(const std::vector<Ring>& rings) {
  (void)tess::collide::count_pairs(std::span<const Ring>(rings));
}
