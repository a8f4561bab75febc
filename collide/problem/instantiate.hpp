// The kinds of boxes that a search is compiled for.
#pragma once

// Calls INSTANTIATE(Real, D), which ends with a semicolon, per kind.
#define TESS_FOR_EACH_KIND_OF_BOX(INSTANTIATE) \
  INSTANTIATE(float, 2)                        \
  INSTANTIATE(float, 3)                        \
  INSTANTIATE(float, 4)                        \
  INSTANTIATE(double, 2)                       \
  INSTANTIATE(double, 3)                       \
  INSTANTIATE(double, 4)
