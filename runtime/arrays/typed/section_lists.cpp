#include "runtime/arrays/typed/section_lists.hpp"

#include "runtime/arrays/typed/moving.hpp"
#include "runtime/arrays/typed/routing.hpp"

namespace tess::detail {

template class SectionListsOf<Index1>;
template class SectionListsOf<Index2>;
template class SectionListsOf<Index3>;

}  // namespace tess::detail
