#include "runtime/collections/arrays/array_of.hpp"

#include "runtime/collections/arrays/arrival.hpp"
#include "runtime/collections/arrays/moving.hpp"
#include "runtime/collections/arrays/routing.hpp"
#include "runtime/collections/arrays/saving.hpp"

namespace tess::detail {

template class ArrayOf<Index1>;
template class ArrayOf<Index2>;
template class ArrayOf<Index3>;

template void ElementMessage<Index1>::serialize_head(Writer&);
template void ElementMessage<Index1>::serialize_head(Reader&);
template void ElementMessage<Index2>::serialize_head(Writer&);
template void ElementMessage<Index2>::serialize_head(Reader&);
template void ElementMessage<Index3>::serialize_head(Writer&);
template void ElementMessage<Index3>::serialize_head(Reader&);

template struct Arrival<Index1>;
template struct Arrival<Index2>;
template struct Arrival<Index3>;

}  // namespace tess::detail
