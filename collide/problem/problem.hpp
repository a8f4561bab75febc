// A collision problem: one set of boxes with itself, or two sets. Searches in one thread and voxels on
// chares solve it with the same code (search/voxel_search.hpp).
#pragma once

#include "collide/box.hpp"
#include "collide/problem/entry.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tess::collide::search {

/// The objects of a search: pairs of `a` with `b`, and with `within_a` also pairs within `a`. The
/// entries refer to boxes_a and boxes_b.
template <class Real, std::size_t D>
struct Problem {
  const Box<Real, D>* boxes_a;
  const Box<Real, D>* boxes_b;
  std::span<const Entry> a;
  std::span<const Entry> b;
  bool within_a;

  [[nodiscard]] double n_comparisons() const noexcept {
    const auto n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
    return n_a * ((within_a ? n_a / 2 : 0) + n_b);
  }
};

/// The bounds of the objects' boxes.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> bounds_of(const Box<Real, D>* boxes, std::span<const Entry> entries) {
  Box<Real, D> bounds = no_box<Real, D>();
  for (const Entry entry : entries) bounds = merged(bounds, boxes[object_of(entry)]);
  return bounds;
}

/// A position in a sample that does not follow a period of the input. That of sample 0 is the first
/// object, unless a seed is given.
[[nodiscard]] inline std::size_t scattered(std::size_t i, std::size_t n_samples, std::size_t n,
                                           std::size_t seed = 0) {
  const std::size_t begin = i * n / n_samples, end = (i + 1) * n / n_samples;
  return begin + ((i + seed) * 0x9E3779B97F4A7C15U >> 32) % (end - begin);
}

}  // namespace tess::collide::search
