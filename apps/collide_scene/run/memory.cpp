#include "apps/collide_scene/run/result.hpp"

#include <sys/resource.h>

namespace collide_scene {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace collide_scene
