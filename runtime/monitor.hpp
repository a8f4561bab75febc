// What a program draws on the page of --monitor.
//
//     tess::show("temperature", {.width = 64, .height = 64, .x = 16 * i, .y = 16 * j, .columns = 16},
//                [this] { return tile_.values(); });
//
// Each element shows its part of the picture as often as it likes: a part is taken about twice a
// second, and otherwise, or without --monitor, the function is not called.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/monitor/monitor.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <concepts>
#include <cstdint>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace tess {

/// Where a part stands in a picture, in pixels from the top left.
struct PictureArea {
  std::int32_t width = 0, height = 0;  ///< of the whole picture; at most 2^20 pixels
  std::int32_t x = 0, y = 0;           ///< of the part's first pixel
  std::int32_t columns = 0;            ///< of the part
};

/// Shows a part of a picture: the values that `values()` returns, row by row (any range of
/// numbers). Parts of different times may meet in a picture.
template <std::invocable F>
  requires std::ranges::input_range<std::invoke_result_t<F>>
void show(const std::string& name, const PictureArea& area, F&& values) {
  Pe& pe = current_pe();
  auto* const monitor = static_cast<detail::Monitor*>(pe.runtime().monitor());
  if (monitor == nullptr || pe.stopped() || !monitor->wants_part(pe, name, area.x, area.y)) return;
  TESS_CHECK(area.width > 0 && area.height > 0 && area.columns > 0 && area.x >= 0 && area.y >= 0 &&
                 area.x + area.columns <= area.width,
             "show(\"", name, "\"): a part of ", area.columns, " columns at ", area.x, ",", area.y,
             " is outside of a picture of ", area.width, " x ", area.height);
  detail::PicturePart part{name, area.width, area.height, area.x, area.y, area.columns, {}};
  for (const auto value : std::forward<F>(values)())
    part.values.push_back(static_cast<float>(value));
  detail::send_part(pe, std::move(part));
}

}  // namespace tess
