#include "runtime/core/check.hpp"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace tess {
namespace {
std::atomic<CheckContext> context_of_thread{nullptr};
std::atomic<CheckAbort> end_of_job{nullptr};
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
  std::fprintf(stderr, "tessera: check failed: %s\n  %s\n  at %s:%d\n%s", condition,
               message.c_str(), file, line, context.empty() ? "" : ("  " + context + "\n").c_str());
  std::fflush(nullptr);
  if (const CheckAbort end = end_of_job) end();
  std::_Exit(1);
}

}  // namespace tess
