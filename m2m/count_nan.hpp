// NaN in a field is a value as any other: a target point whose donors have one gets NaN. This
// counts such points after a transfer.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tess::m2m {

/// The rows with a NaN. `values`: rows × n_components, row-major.
[[nodiscard]] inline std::size_t count_nan_rows(std::span<const double> values,
                                                std::size_t n_components = 1) {
  std::size_t n = 0;
  for (std::size_t row = 0; row < values.size(); row += n_components) {
    bool has_nan = false;
    for (std::size_t c = 0; c < n_components; ++c) has_nan |= std::isnan(values[row + c]);
    n += has_nan ? 1 : 0;
  }
  return n;
}

}  // namespace tess::m2m
