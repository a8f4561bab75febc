// How a checkpoint is written.
#pragma once

#include <string>

namespace tess {

struct CheckpointOptions {
  /// The number of checkpoints that are kept; older ones are removed. At least 1.
  int keep = 2;
  /// A text for people in the manifest: the program's options, the step.
  std::string note{};
  /// The folder is local to each host, such as one in /dev/shm, and every PE's file is kept twice:
  /// on its host, and by a buddy PE of another process, on another host if the run has several.
  bool buddy_copies = false;
};

}  // namespace tess
