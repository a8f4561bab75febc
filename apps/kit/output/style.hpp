// The look that charts and pictures share: one font, and colours that differ for colour-blind
// readers and, the first five, in grey, too.
#pragma once

#include <array>

namespace kit {

inline constexpr double font_size = 13;
/// Okabe and Ito (2008), in another order.
inline constexpr std::array colours{"#0072b2", "#e69f00", "#000000", "#cc79a7",
                                    "#d55e00", "#009e73", "#56b4e9", "#999999"};

}  // namespace kit
