#include "runtime/collections/array_of.hpp"

#include "runtime/collections/moving.hpp"
#include "runtime/collections/routing.hpp"
#include "runtime/collections/saving.hpp"

namespace tess::detail {

template class ArrayOf<Index1>;
template class ArrayOf<Index2>;
template class ArrayOf<Index3>;

}  // namespace tess::detail
