#include "m2m/mesh/workers/value_keeper.hpp"

#include "m2m/field.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace tess::m2m {

ValueKeeper::ValueKeeper(GlobalId n_vertices, std::uint64_t n_components)
    : first_(first_of(n_vertices, my_pe().value, n_pes())), n_components_(n_components) {
  n_due_ = static_cast<std::uint64_t>(first_of(n_vertices, my_pe().value + 1, n_pes()) - first_);
  values_.resize(n_due_ * n_components);
}

void ValueKeeper::take(const KeptRows& rows) {
  for (std::size_t i = 0; i < rows.vertices.size(); ++i)
    std::copy_n(
        rows.values.data() + i * n_components_, n_components_,
        values_.data() + static_cast<std::size_t>(rows.vertices[i] - first_) * n_components_);
  n_due_ -= rows.vertices.size();
}

std::uint64_t ValueKeeper::extend(const HashStart& start) {
  TESS_CHECK(n_due_ == 0, n_due_, " vertices have not come");
  std::uint64_t hash = start.hash;
  for (std::size_t row = start.first; row < values_.size(); row += n_components_)
    hash = result_hash(std::span(values_).subspan(row, start.n), hash);
  return hash;
}

}  // namespace tess::m2m
