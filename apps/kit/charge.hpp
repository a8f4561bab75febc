// What the numerics of a program cost on the simulated machine.
#pragma once

#include "runtime/here.hpp"
#include "runtime/run.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace kit {

/// On a simulated machine with a fixed cost per message n operations cost time, too, so that times
/// repeat to the last bit.
inline void charge(std::chrono::nanoseconds each, std::size_t n) {
  if (tess::machine().message_cost() > tess::Time(0))
    (void)tess::charge(each * static_cast<std::int64_t>(n));
}

}  // namespace kit
