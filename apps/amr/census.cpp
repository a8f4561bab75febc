#include "apps/amr/census.hpp"

#include <algorithm>

namespace amr {

Norms operator+(const Norms& a, const Norms& b) {
  return {a.mass + b.mass,
          a.l1 + b.l1,
          a.l2 + b.l2,
          std::max(a.linf, b.linf),
          std::max(a.largest, b.largest),
          std::min(a.least, b.least),
          a.hash + b.hash};
}

Census operator+(Census a, const Census& b) {
  a.norms = a.norms + b.norms;
  a.n_blocks += b.n_blocks;
  a.n_new += b.n_new;
  for (std::size_t level = 0; level < a.of_level.size(); ++level)
    a.of_level[level] += b.of_level[level];
  return a;
}

}  // namespace amr
