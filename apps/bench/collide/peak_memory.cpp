#include "apps/bench/collide/peak_memory.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <fstream>
#include <malloc.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace bench {
namespace {

/// A figure of /proc/self/status in bytes.
std::size_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key) {
      std::size_t kib = 0;
      status >> kib;
      return kib << 10;
    }
  return 0;
}

std::size_t growth_of(const std::function<void()>& run) {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak is the present size again
  const std::size_t before = status_bytes("VmRSS:");
  run();
  return std::max(status_bytes("VmHWM:"), before) - before;
}

}  // namespace

std::size_t peak_bytes(const std::function<void()>& run) {
  int ends[2];
  TESS_CHECK(pipe(ends) == 0, "pipe fails");
  const pid_t child = fork();
  TESS_CHECK(child >= 0, "fork fails");
  if (child == 0) {
    const std::size_t bytes = growth_of(run);
    _exit(write(ends[1], &bytes, sizeof bytes) == sizeof bytes ? 0 : 1);
  }
  close(ends[1]);
  std::size_t bytes = 0;
  const bool got = read(ends[0], &bytes, sizeof bytes) == sizeof bytes;
  close(ends[0]);
  int status = 0;
  TESS_CHECK(waitpid(child, &status, 0) == child && got && status == 0,
             "the measured process ended with status ", status);
  return bytes;
}

}  // namespace bench
