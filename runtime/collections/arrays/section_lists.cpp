#include "runtime/collections/arrays/section_lists.hpp"

#include "runtime/collections/arrays/moving.hpp"
#include "runtime/collections/arrays/routing.hpp"

namespace tess::detail {

template class SectionListsOf<Index1>;
template class SectionListsOf<Index2>;
template class SectionListsOf<Index3>;

}  // namespace tess::detail
