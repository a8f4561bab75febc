#include "collide/search/survey.hpp"

#include "collide/search/instantiate.hpp"
#include "runtime/core/error.hpp"

#include <cstring>
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

/// The bytes of the processor's vectors. Wider ones are taken apart, element by element.
#ifdef __AVX512F__
constexpr std::size_t widest = 64;
#else
constexpr std::size_t widest = 32;
#endif

/// Puts the upper end of a box in place of each lower end. It changes its argument: how a function
/// returns a vector depends on the instruction set, of which g++ warns.
template <std::size_t D, class Eight, std::size_t... k>
void take_upper_ends(Eight& x, std::index_sequence<k...> /*lanes*/) {
  x = __builtin_shufflevector(x, x, (k < D ? k + D : k)...);
}

}  // namespace

template <class Real, std::size_t D>
Box<Real, D> checked_bounds(std::span<const Box<Real, D>> boxes, const char* set) {
  Box<Real, D> bounds = no_box<Real, D>();
  if (boxes.empty()) return bounds;
  // Eight numbers at a time: a box, and of the next one what fits. Four streams keep the memory
  // twice as busy as one.
  using Eight [[gnu::vector_size(8 * sizeof(Real))]] = Real;
  using Bits = decltype(Eight{} < Eight{});
  Eight least = Eight{} + std::numeric_limits<Real>::infinity(), greatest = -least;
  Bits bad{};
  constexpr std::size_t n_streams = 4;
  const std::size_t length = sizeof(Eight) <= widest ? (boxes.size() - 1) / n_streams : 0;
  for (std::size_t i = 0; i < length; ++i)
    for (std::size_t s = 0; s < n_streams; ++s) {
      Eight x;
      std::memcpy(&x, boxes[i + s * length].lo.data(), sizeof x);
      least = x < least ? x : least;
      greatest = x > greatest ? x : greatest;
      Eight upper = x;
      take_upper_ends<D>(upper, std::make_index_sequence<8>());
      bad |= ~(x <= upper);  // also for NaN
    }
  bool good = true;
  for (std::size_t k = 0; k < D && length > 0; ++k) {
    bounds.lo[k] = least[k];
    bounds.hi[k] = greatest[k + D];
    good = good && bad[k] == 0;
  }
  for (const Box<Real, D>& box : boxes.subspan(n_streams * length)) {
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
