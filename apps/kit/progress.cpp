#include "apps/kit/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <unistd.h>

namespace kit {

std::optional<double> seconds_left(std::uint32_t part, std::uint32_t n_parts, double began,
                                   double lasted) noexcept {
  if (part < 2 || part > n_parts) return std::nullopt;
  const double each = began / (part - 1);
  return std::max(each - lasted, 0.0) + each * (n_parts - part);
}

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
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::uint64_t shown = part_.load(std::memory_order_relaxed);
  const auto part = static_cast<std::uint32_t>(shown >> 32U);
  const auto n_parts = static_cast<std::uint32_t>(shown & 0xffffffffU);
  if (shown != part_shown_) {
    part_shown_ = shown;
    part_began_ = elapsed;
    if (part <= 1) first_part_began_ = elapsed;
  }
  std::string line = "\r\x1b[K";
  if (part != 0) line += fmt::format("{} of {}: ", part, n_parts);
  line += fmt::format("{}, {:.0f} s", phase_.load(std::memory_order_relaxed), elapsed);
  if (const auto left =
          seconds_left(part, n_parts, part_began_ - first_part_began_, elapsed - part_began_)) {
    line += fmt::format(", about {:.0f} s left", *left);
  }
  std::fputs(line.c_str(), terminal_);
  std::fflush(terminal_);
  shown_ = true;
}

}  // namespace kit
