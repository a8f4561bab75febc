// How a checkpoint is written.
#pragma once

#include <type_traits>

namespace tess {

struct CheckpointOptions {
  /// The number of checkpoints that are kept; older ones are removed. At least 1.
  int keep = 2;
  /// The folder is local to each host, such as one in /dev/shm, and every PE's file is kept twice:
  /// on its host, and by a buddy PE of another process, on another host if the run has several.
  bool buddy_copies = false;
};
static_assert(std::is_trivially_destructible_v<CheckpointOptions>,
              "g++ 12 destroys an aggregate twice that is written in a co_await expression");

}  // namespace tess
