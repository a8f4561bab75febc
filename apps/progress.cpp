#include "apps/progress.hpp"

#include <fmt/format.h>
#include <string>
#include <unistd.h>

namespace apps {

Progress::Progress(std::FILE* terminal, std::chrono::milliseconds first,
                   std::chrono::milliseconds next)
    : terminal_(terminal) {
  if (terminal == nullptr || ::isatty(::fileno(terminal)) == 0) return;
  thread_ = std::jthread([this, first, next](const std::stop_token& stop) {
    std::unique_lock lock(line_);
    const auto never = [] { return false; };
    for (auto wait = first; !stop.stop_requested(); wait = next) {
      wake_.wait_for(lock, stop, wait, never);
      if (!stop.stop_requested()) show();
    }
  });
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  thread_.request_stop();
  thread_.join();
  clear();
}

void Progress::clear() {
  const std::lock_guard lock(line_);
  if (!shown_) return;
  shown_ = false;
  std::fputs("\r\x1b[K", terminal_);
  std::fflush(terminal_);
}

void Progress::show() {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const std::uint64_t part = part_.load(std::memory_order_relaxed);
  std::string line = "\r\x1b[K";
  if (part != 0) line += fmt::format("{} of {}: ", part >> 32U, part & 0xffffffffU);
  line += fmt::format("{}, {:.0f} s", phase_.load(std::memory_order_relaxed), elapsed.count());
  std::fputs(line.c_str(), terminal_);
  std::fflush(terminal_);
  shown_ = true;
}

}  // namespace apps
