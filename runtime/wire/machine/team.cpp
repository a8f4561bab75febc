#include "runtime/wire/machine/team.hpp"

#include "runtime/base/ticks.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <thread>

namespace tess::detail {
namespace {

using namespace std::chrono_literals;

/// The most messages that a step runs before the PE checks its inbox and the network again.
constexpr std::size_t step_most = 64;

/// A busy PE checks its inbox and polls the network with about this period.
constexpr double step_seconds = 30e-6;

/// The program learns with this period that a PE is busy.
constexpr double busy_seconds = 1e-3;

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

/// Whether the threads may run their PEs: none does before all threads have started.
enum class Gate : std::uint8_t { closed, open, cancelled };

/// The number of messages in the next step, derived from the duration of the last one. It begins
/// with one and grows while steps are full and short, so that a PE whose messages take long checks
/// its inbox after each.
class Stride {
 public:
  [[nodiscard]] std::size_t most() const noexcept { return most_; }

  void begins() noexcept { began_ = read_ticks(); }
  /// The step ran so many messages.
  void ended(std::size_t n_messages) noexcept {
    const std::uint64_t now = read_ticks();
    const std::uint64_t took = now - began_;
    if (took > 2 * period_) {
      most_ = static_cast<std::size_t>(
          std::clamp<std::uint64_t>(n_messages * period_ / took, 1, step_most));
    } else if (took < period_ && n_messages == most_) {
      most_ = std::min(step_most, most_ * 2);
    }
    is_due_ = now - polled_ >= period_;
    if (is_due_) polled_ = now;
    works_ += took;
  }
  /// True if it is time to poll the network.
  [[nodiscard]] bool due() const noexcept { return is_due_; }

  void idle() noexcept { works_ = 0; }
  /// True once per `busy_seconds` of steps since idle().
  [[nodiscard]] bool busy() noexcept {
    if (works_ < busy_period_) return false;
    works_ = 0;
    return true;
  }

 private:
  const std::uint64_t period_ = static_cast<std::uint64_t>(step_seconds / seconds_per_tick());
  const std::uint64_t busy_period_ = static_cast<std::uint64_t>(busy_seconds / seconds_per_tick());
  std::size_t most_ = 1;
  std::uint64_t works_ = 0;  // ticks in steps since idle()
  std::uint64_t began_ = 0, polled_ = read_ticks();
  bool is_due_ = false;
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
  std::atomic<Gate> gate{Gate::closed};
  const auto set_gate = [&gate](Gate to) {
    gate = to;
    gate.notify_all();
  };
  std::vector<std::jthread> others;
  try {
    others.reserve(seats_.size());
    for (std::int32_t local = 1; local < n; ++local)
      others.emplace_back([&gate, &drive_one, local] {
        gate.wait(Gate::closed);
        if (gate == Gate::open) drive_one(local);
      });
  } catch (const std::exception& error) {
    const std::size_t n_started = 1 + others.size();
    set_gate(Gate::cancelled);
    others.clear();
    fail(ErrorCode::environment, "--pes ", n, ": this system starts no more than ", n_started,
         n_started == 1 ? " thread (" : " threads (", error.what(), "); give fewer PEs");
  }
  set_gate(Gate::open);
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
    stride.begins();
    if (const std::size_t ran = program.step(pe, stride.most()); ran > 0) {
      stride.ended(ran);
      if (stride.busy()) program.busy(pe);
      worked = true;
    }
    if (network_ != nullptr && (!worked || stride.due()) && network_->progress(program, pe))
      worked = true;
    if (!worked) stride.idle();
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
