#include "runtime/core/check.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace tess {
namespace {
std::atomic<CheckContext> context_of_thread{nullptr};
std::atomic<CheckAbort> end_of_job{nullptr};

/// Without the folders of the machine on which the project was compiled.
const char* in_project(const char* file) {
  const std::string_view path = file;
  std::size_t from = 0;
  for (const char* folder : {"/runtime/", "/collide/", "/m2m/", "/apps/", "/tests/"})
    if (const std::size_t at = path.rfind(folder); at != std::string_view::npos)
      from = std::max(from, at + 1);
  return file + from;
}
}  // namespace

void set_check_context(CheckContext describe) noexcept {
  context_of_thread = describe;
}
CheckAbort set_check_abort(CheckAbort end) noexcept {
  return end_of_job.exchange(end);
}

void check_failed(const char* condition, const char* file, int line, const std::string& message) {
  const CheckContext describe = context_of_thread;
  const std::string context = describe != nullptr ? describe() : std::string();
  std::fprintf(stderr, "tessera: %s\n%s  the check is %s at %s:%d\n", message.c_str(),
               context.empty() ? "" : ("  " + context + "\n").c_str(), condition, in_project(file),
               line);
  std::fflush(nullptr);
  if (const CheckAbort end = end_of_job) end();
  std::_Exit(1);
}

}  // namespace tess
