#include "collide/serial/pair_search.hpp"

namespace tess {

void PairSearch::sort_along_widest_axis() {
  double widest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto begin = lanes_.lo[k].begin();
    const auto [least, most] =
        std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(lanes_.n));
    if (*most - *least > widest) {
      widest = *most - *least;
      axis_ = k;
    }
  }
  order_.resize(lanes_.n);
  for (std::size_t i = 0; i < lanes_.n; ++i)
    order_[i] = {lanes_.lo[axis_][i], static_cast<std::uint32_t>(i)};
  std::sort(order_.begin(), order_.end());
  sorted_.resize(lanes_.n);
  for (std::size_t i = 0; i < lanes_.n; ++i) sorted_.copy(i, lanes_, order_[i].second);
}

}  // namespace tess
