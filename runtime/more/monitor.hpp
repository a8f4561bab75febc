// What a program draws on the page of --monitor. A program that links Tessera::live_view has it.
//
//     tess::show("temperature", [this] {
//       return tess::Picture{64, 64, x_, y_, tile_.width(), tile_.values()};
//     });
//
// Each element shows its part of the picture whenever it likes: while a browser watches, a part is
// taken about twice a second, or every eight seconds if it is shown much more rarely than others.
// Otherwise, or without --monitor, the function is not called.
#pragma once

#include "runtime/core/algorithm.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/interfaces/process_monitor.hpp"
#include "runtime/pe/runtime.hpp"

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tess {

/// A part of a picture: numbers, row by row, from the top left.
struct Picture {
  std::int32_t width = 0, height = 0;  ///< of the whole picture, in pixels; at most 2^20 of them
  std::int32_t x = 0, y = 0;           ///< of the part's first pixel
  std::int32_t columns = 0;            ///< of the part
  std::vector<double> values;          ///< of the part; not finite: drawn as the least
};

/// Shows what `picture()` returns; a page has pictures of at most 16 names. `part` distinguishes
/// the parts of a picture that one PE shows: it takes one of each between two samples. Parts of
/// different times may meet in a picture.
template <std::invocable F>
  requires std::same_as<std::invoke_result_t<F>, Picture>
void show(std::string_view name, std::uint64_t part, F&& picture) {
  Pe& pe = current_pe();
  detail::ProcessMonitor* const monitor = pe.runtime().monitor();
  if (monitor == nullptr || pe.stopped() || !monitor->wants_part(pe, name, part)) return;
  Picture of = std::forward<F>(picture)();
  if (of.values.empty()) return;
  const bool fits = of.width > 0 && of.height > 0 && of.x >= 0 && of.y >= 0 && of.y < of.height &&
                    of.columns > 0 && of.columns <= of.width - of.x &&
                    static_cast<std::int64_t>(of.width) * of.height <= 1 << 20 &&
                    of.values.size() <= static_cast<std::size_t>(of.columns) *
                                            static_cast<std::size_t>(of.height - of.y);
  TESS_CHECK(fits, "show(\"", name, "\"): ", of.values.size(), " values in ", of.columns,
             " columns at ", of.x, ",", of.y, " do not fit into a picture of ", of.width, " x ",
             of.height, " (at most 2^20 pixels)");
  detail::PicturePart out{std::string(name), of.width, of.height, of.x, of.y, of.columns, {}};
  constexpr double most = std::numeric_limits<float>::max();
  out.values.reserve(of.values.size());
  for (const double value : of.values)
    out.values.push_back(
        static_cast<float>(std::isfinite(value) ? std::clamp(value, -most, most) : value));
  monitor->draw(pe, std::move(out));
}
/// Shows the running element's part of a picture.
template <std::invocable F>
void show(std::string_view name, F&& picture) {
  const detail::Element* element = current_pe().context().element;
  show(name, reinterpret_cast<std::uintptr_t>(element), std::forward<F>(picture));
}
/// Shows a number of the running element as the pixel at `x`, `y`; nothing in a picture of more than
/// 2^20 pixels.
inline void show_pixel(std::string_view name, std::int64_t width, std::int32_t height,
                       std::int64_t x, std::int32_t y, double value) {
  if (width > 1 << 20 || width * height > 1 << 20) return;
  show(name, [&] {
    return Picture{
        static_cast<std::int32_t>(width), height, static_cast<std::int32_t>(x), y, 1, {value}};
  });
}

}  // namespace tess
