// How a checkpoint is written.
#pragma once

#include <string>

namespace tess {

struct CheckpointOptions {
  /// The number of checkpoints that are kept; older ones are removed. At least 1.
  int keep = 2;
  /// A text for people in the manifest: the program's options, the step.
  std::string note{};
};

}  // namespace tess
