#include "collide/hit.hpp"

#include "collide/owner.hpp"
#include "runtime/core/error.hpp"

namespace tess::collide {

void check_boxes(std::span<const Item> items) {
  for (const Item& item : items) {
    if (is_valid(item.box)) continue;
    const auto& [lo, hi] = item.box;
    fail(ErrorCode::bad_value, "box [", lo[0], ", ", hi[0], "] x [", lo[1], ", ", hi[1], "] x [",
         lo[2], ", ", hi[2], "] of object ", static_cast<std::uint32_t>(item.id.local),
         " of owner ", owner_text(item.id.owner), ", model ",
         static_cast<std::uint32_t>(item.id.model),
         " is not valid; give finite numbers with lo <= hi");
  }
}

}  // namespace tess::collide
