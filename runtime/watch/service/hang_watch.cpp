#include "runtime/watch/service/hang_watch.hpp"

#include "runtime/pe/report/pe_watch.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>

namespace tess::detail {

HangWatch::HangWatch(Runtime& runtime, Time limit, Clock::time_point now)
    : runtime_(runtime),
      limit_(limit),
      n_entered_(static_cast<std::size_t>(runtime.machine().n_pes_here())),
      named_(n_entered_.size()),
      changed_(now),
      next_(changed_ + limit) {}

Time HangWatch::period() const {
  return std::clamp<Time>(limit_ / 8, std::chrono::milliseconds(10), std::chrono::seconds(1));
}

std::vector<std::string> HangWatch::look(Clock::time_point now) {
  std::vector<std::string> lines;
  const PeId first = runtime_.machine().first_pe(runtime_.machine().process());
  for (std::size_t i = 0; i < n_entered_.size(); ++i) {
    const PeId pe{first.value + static_cast<std::int32_t>(i)};
    const std::uint64_t n = runtime_.pe(pe).measuring().watch()->n_entered();
    if (n != n_entered_[i]) {
      n_entered_[i] = n;
      named_[i] = false;
      changed_ = now;
      next_ = now + limit_;
      reported_ = false;
    } else if (const auto running = runtime_.watched(pe);
               running && !named_[i] && running->seconds >= seconds(limit_)) {
      named_[i] = true;
      lines.push_back(running->text);
    }
  }
  return lines;
}

}  // namespace tess::detail
