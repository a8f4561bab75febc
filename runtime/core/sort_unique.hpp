// Sorts a list and drops repeats.
#pragma once

#include "runtime/core/algorithm.hpp"

namespace tess {

template <class List>
void sort_unique(List& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace tess
