#include "runtime/collections/section_lists.hpp"

#include "runtime/collections/moving.hpp"
#include "runtime/collections/routing.hpp"

namespace tess::detail {

template class SectionListsOf<Index1>;
template class SectionListsOf<Index2>;
template class SectionListsOf<Index3>;

}  // namespace tess::detail
