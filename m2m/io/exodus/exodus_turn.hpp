// libexodusII is not reentrant: the readers take turns in a process.
#pragma once

#include <mutex>

namespace tess::m2m {

/// Held by each reader while it calls the library.
inline std::mutex& exodus_turn() {
  static std::mutex turn;
  return turn;
}

}  // namespace tess::m2m
