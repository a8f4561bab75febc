#include "collide/problem/survey.hpp"

#include "collide/problem/instantiate.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/simd.hpp"

#include <string>
#include <utility>

namespace tess::collide::search {
namespace {

template <class Real, std::size_t D>
[[noreturn]] void refuse(std::span<const Box<Real, D>> boxes, const char* set) {
  std::size_t i = 0;
  while (is_valid(boxes[i])) ++i;
  std::string box;
  for (std::size_t k = 0; k < D; ++k)
    box += text(k == 0 ? "[" : " x [", boxes[i].lo[k], ", ", boxes[i].hi[k], "]");
  // No other shape of the library has an empty box.
  const bool is_empty = boxes[i].lo == no_box<Real, D>().lo && boxes[i].hi == no_box<Real, D>().hi;
  fail(ErrorCode::bad_value, "pairs: box ", box, " of object ", i, set,
       " is not valid; give finite numbers with lo <= hi",
       is_empty ? " (of a ball: a radius that is not negative)" : "");
}

/// The upper end of a box in place of each lower end.
template <std::size_t D, class Eight, std::size_t... k>
Eight upper_ends(Eight x, std::index_sequence<k...> /*lanes*/) {
  return __builtin_shufflevector(x, x, (k < D ? k + D : k)...);
}

}  // namespace

template <class Real, std::size_t D>
Box<Real, D> checked_bounds(std::span<const Box<Real, D>> boxes, const char* set) {
  Box<Real, D> bounds = no_box<Real, D>();
  if (boxes.empty()) return bounds;
  bool good = true;
  std::size_t n_done = 0;
  // Eight numbers at a time: a box, and of the next one what fits. Four streams keep the memory
  // twice as busy as one.
  using Eight = simd::Vector<Real, 8>;
  if constexpr (sizeof(Eight) <= simd::widest) {
    Eight least = simd::all<Eight>(std::numeric_limits<Real>::infinity()), greatest = -least;
    decltype(least < greatest) bad{};
    constexpr std::size_t n_streams = 4;
    const std::size_t length = (boxes.size() - 1) / n_streams;
    for (std::size_t i = 0; i < length; ++i)
      for (std::size_t s = 0; s < n_streams; ++s) {
        const auto x = simd::load<Eight>(boxes[i + s * length].lo.data());
        least = simd::min(x, least);
        greatest = simd::max(x, greatest);
        bad |= ~(x <= upper_ends<D>(x, std::make_index_sequence<8>()));  // also for NaN
      }
    for (std::size_t k = 0; k < D && length > 0; ++k) {
      bounds.lo[k] = least[k];
      bounds.hi[k] = greatest[k + D];
      good = good && bad[k] == 0;
    }
    n_done = n_streams * length;
  }
  for (const Box<Real, D>& box : boxes.subspan(n_done)) {
    for (std::size_t k = 0; k < D; ++k) good &= box.lo[k] <= box.hi[k];
    bounds = merged(bounds, box);
  }
  if (!good || !is_valid(bounds)) refuse(boxes, set);
  return bounds;
}

#define TESS_INSTANTIATE(Real, D) \
  template Box<Real, D> checked_bounds(std::span<const Box<Real, D>>, const char*);
TESS_FOR_EACH_KIND_OF_BOX(TESS_INSTANTIATE)
#undef TESS_INSTANTIATE

}  // namespace tess::collide::search
