#include "runtime/machine/team.hpp"

#include <algorithm>
#include <thread>

namespace tess::detail {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// The most messages that a step runs before the PE checks its inbox and the network again.
constexpr std::size_t step_most = 64;

/// A busy PE polls the network with this period; its steps are kept shorter than that.
constexpr auto network_period = 30us;

/// A network has to be polled, so sleeps are short there, and grow while nothing comes; an inbox
/// wakes its PE by itself. Waking a thread costs about 5 us and a yield among yielding threads
/// 0.5 us, so yielding comes first and lasts longer.
Patience patience(bool oversubscribed, bool network) {
  const auto sleep = network ? std::chrono::nanoseconds(50us) : Parker::forever;
  const auto longest = network ? std::chrono::nanoseconds(5ms) : Parker::forever;
  if (oversubscribed)
    return {.spin = 0ns, .yield = network ? 200us : 20us, .sleep = sleep, .longest_sleep = longest};
  return {.spin = network ? 200us : 50us,
          .yield = network ? 1ms : 200us,
          .sleep = sleep,
          .longest_sleep = longest};
}

/// The number of messages in the next step, derived from the duration of the last one.
class Stride {
 public:
  [[nodiscard]] std::size_t most() const noexcept { return most_; }

  /// True if it is time to poll the network.
  bool due() noexcept {
    const auto now = Clock::now();
    const auto took = now - since_;
    if (took > 2 * network_period)
      most_ = std::max<std::size_t>(1, most_ / 2);
    else if (took < network_period)
      most_ = std::min(step_most, most_ * 2);
    since_ = now;
    if (now < next_) return false;
    next_ = now + network_period;
    return true;
  }

 private:
  std::size_t most_ = step_most;
  Clock::time_point since_ = Clock::now();
  Clock::time_point next_ = since_;
};

}  // namespace

Team::Team(PeId first, std::int32_t n_pes, Placement placement, Network* network)
    : first_(first),
      placement_(placement),
      network_(network),
      patience_(patience(placement.oversubscribed, network != nullptr)),
      seats_(static_cast<std::size_t>(n_pes)) {}

void Team::run(Program& program, const Topology& topology) {
  const auto n = static_cast<std::int32_t>(seats_.size());
  n_running_ = n;
  const auto drive_one = [&](std::int32_t local) {
    if (placement_.pinned) topology.pin(placement_.first_core + local);
    drive(program, PeId{first_.value + local}, seats_[static_cast<std::size_t>(local)]);
  };
  std::vector<std::jthread> others;
  for (std::int32_t local = 1; local < n; ++local) others.emplace_back(drive_one, local);
  drive_one(0);
  others.clear();  // joins
  if (placement_.pinned) topology.unpin();
}

void Team::stop() noexcept {
  if (stopping_.exchange(true)) return;
  for (Seat& seat : seats_) seat.parker.wake();
}

// noexcept: the program handles exceptions of entry methods; an exception that arrives here is a
// bug.
void Team::drive(Program& program, PeId pe, Seat& seat) noexcept {
  program.start(pe);
  Backoff rest(patience_);
  Stride stride;
  // relaxed: the flag transfers no data; the barrier below provides the order that is needed.
  while (!stopping_.load(std::memory_order_relaxed)) {
    bool worked = take_in(program, pe, seat);
    if (program.step(pe, stride.most()) > 0) worked = true;
    if (network_ != nullptr && (!worked || stride.due()) && network_->progress(program, pe))
      worked = true;
    if (worked || program.idle(pe)) {
      rest.reset();
      continue;
    }
    if (rest.pause())
      seat.parker.park(rest.sleep(), [&] { return !seat.empty() || stopping_.load(); });
  }
  wait_for_all();
  take_in(program, pe, seat);
  program.finish(pe);
}

bool Team::take_in(Program& program, PeId pe, Seat& seat) noexcept {
  bool any = false;
  for (Link* link = seat.bundles.take_all(); link != nullptr; any = true) {
    Link* const next = link->next;
    program.accept_bundle(pe, static_cast<Bundle*>(link));
    link = next;
  }
  if (Link* const first = seat.inbox.take_all()) {
    program.accept(pe, first);
    any = true;
  }
  return any;
}

void Team::wait_for_all() noexcept {
  if (n_running_.fetch_sub(1) == 1) {
    n_running_.notify_all();
    return;
  }
  for (std::int32_t n = n_running_.load(); n != 0; n = n_running_.load()) n_running_.wait(n);
}

}  // namespace tess::detail
