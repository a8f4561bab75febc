#include "collide/problem/thin_objects.hpp"

#include <cmath>

namespace tess::collide::search {
namespace {

/// The nearest number of the type below or above.
template <class Real>
Real rounded_down(double x) noexcept {
  const auto out = static_cast<Real>(x);
  return double{out} > x ? std::nextafter(out, -std::numeric_limits<Real>::infinity()) : out;
}
template <class Real>
Real rounded_up(double x) noexcept {
  const auto out = static_cast<Real>(x);
  return double{out} < x ? std::nextafter(out, std::numeric_limits<Real>::infinity()) : out;
}

}  // namespace

double longest_extent(const Capsule& capsule) noexcept {
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k)
    length = std::max(length, std::abs(capsule.to[k] - capsule.from[k]));
  return length;
}

int n_pieces(const Capsule& capsule, double longest) noexcept {
  const double length = longest_extent(capsule);
  if (!std::isfinite(length) || !std::isfinite(capsule.radius)) return 1;
  const double n = std::ceil(length / longest);
  return n > 1 ? static_cast<int>(std::min<double>(n, most_pieces)) : 1;
}

template <class Real>
Box<Real, 3>* cut(const Box<Real, 3>& box, const Capsule& capsule, int n,
                  Box<Real, 3>* out) noexcept {
  if (n == 1) {
    *out++ = box;
    return out;
  }
  Point way, margin;
  for (std::size_t k = 0; k < 3; ++k) {
    way[k] = capsule.to[k] - capsule.from[k];
    // An end of a piece passes four roundings, of numbers below twice the largest coordinate.
    margin[k] = capsule.radius * (1 + 0x1p-50) +
                0x1p-49 * std::max(std::abs(capsule.from[k]), std::abs(capsule.to[k])) + 0x1p-1070;
  }
  Point begin = capsule.from;
  for (int piece = 1; piece <= n; ++piece) {
    Point end = capsule.to;
    const double share = static_cast<double>(piece) / n;
    bool is_empty = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (piece < n) end[k] = capsule.from[k] + share * way[k];
      out->lo[k] = std::max(box.lo[k], rounded_down<Real>(std::min(begin[k], end[k]) - margin[k]));
      out->hi[k] = std::min(box.hi[k], rounded_up<Real>(std::max(begin[k], end[k]) + margin[k]));
      is_empty = is_empty || out->lo[k] > out->hi[k];
    }
    if (!is_empty) ++out;
    begin = end;
  }
  return out;
}

template <class Real>
ThinObjects<Real>::ThinObjects(const ThinSet<Real>& objects, const Frame& frame, double longest,
                               std::uint64_t first_number)
    : objects_(objects.boxes), first_number_(first_number) {
  const std::size_t n = objects_.size();
  capsules_.resize(n);
  if (longest == whole) {
    for (std::size_t i = 0; i < n; ++i) capsules_.data()[i] = slim(objects.capsules[i], frame);
    return;
  }
  begins_.resize(n + 1);
  std::size_t end = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Capsule capsule = objects.capsules[i];
    capsules_.data()[i] = slim(capsule, frame);
    begins_.data()[i] = static_cast<std::uint32_t>(end);
    pieces_.resize(end + most_pieces);
    objects_of_.resize(end + most_pieces);
    Box<Real, 3>* const boxes = pieces_.data() + end;
    const auto n_boxes = static_cast<std::size_t>(
        cut(objects_[i], capsule, n_pieces(capsule, longest), boxes) - boxes);
    std::fill_n(objects_of_.data() + end, n_boxes, static_cast<std::uint32_t>(i));
    end += n_boxes;
  }
  begins_.data()[n] = static_cast<std::uint32_t>(end);
  pieces_.resize(end);
  objects_of_.resize(end);
}

template class ThinObjects<float>;
template class ThinObjects<double>;
template Box<float, 3>* cut(const Box<float, 3>&, const Capsule&, int, Box<float, 3>*) noexcept;
template Box<double, 3>* cut(const Box<double, 3>&, const Capsule&, int, Box<double, 3>*) noexcept;

}  // namespace tess::collide::search
