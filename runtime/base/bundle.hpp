// Several messages to one PE, handed over at once: the receiver gets an array of pointers, so that
// it can fetch the next messages into its cache while it runs the first. A bundle costs its sender
// one atomic operation, however many messages it holds.
#pragma once

#include "runtime/base/link.hpp"

#include <array>
#include <cstdint>

namespace tess {

/// Four cache lines, with the header of its pool.
struct Bundle : Link {
  static constexpr std::uint32_t capacity = 28;
  std::uint32_t n = 0;
  std::array<Link*, capacity> messages;  // the first n
};

}  // namespace tess
