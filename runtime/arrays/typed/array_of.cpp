#include "runtime/arrays/typed/array_of.hpp"

#include "runtime/arrays/typed/arrival.hpp"
#include "runtime/arrays/typed/moving.hpp"
#include "runtime/arrays/typed/routing.hpp"
#include "runtime/arrays/typed/saving.hpp"

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
