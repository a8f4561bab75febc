#include "runtime/pe/peers.hpp"

#include "runtime/base/ticks.hpp"
#include "runtime/pe/block.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/queues/outbox.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

namespace tess::detail {
namespace {

/// The longest time that a message waits for others to the same PE of this process, or to another
/// process.
constexpr double bundle_seconds = 1e-6;
constexpr double packed_seconds = 4e-6;
/// The most messages between two readings of the clock, if messages are held back and short.
constexpr std::uint32_t most_between_looks = 8;

}  // namespace

Peers::Peers(Pe& pe, const MessageOptions& messages)
    : pe_(pe),
      first_here_(pe.machine().first_pe(pe.machine().process_of(pe.id())).value),
      n_here_(pe.machine().pes_per_process()),
      bundle_ticks_(static_cast<std::uint64_t>(bundle_seconds / seconds_per_tick())),
      packed_ticks_(static_cast<std::uint64_t>(packed_seconds / seconds_per_tick())),
      bundles_(pe.machine().takes_bundles() ? static_cast<std::size_t>(n_here_) : 0),
      outbox_(
          std::make_unique<Outbox>(pe.id(), pe.machine(), messages, pe.statistics().bytes_sent)) {}
Peers::~Peers() = default;

void Peers::hold() {
  if (holds_) return;
  holds_ = true;
  held_since_ = last_look_ = read_ticks();
  until_look_ = look_every_ = 1;
}

void Peers::pack(Envelope* message) {
  try {
    outbox_->put(message);
  } catch (...) {  // serialize() of an argument threw; the message counts as sent already
    pe_.error().keep(std::current_exception());
  }
  if (outbox_->holds()) hold();
}

void Peers::pass(PeId to, Envelope* message, std::size_t n_bytes) {
  if (bundles_.empty()) {
    pe_.machine().post(pe_.id(), to, message, n_bytes, message->action->traffic);
    return;
  }
  Bundle*& bundle = bundles_[static_cast<std::size_t>(to.value - first_here_)];
  if (bundle == nullptr) bundle = new (allocate_block(pe_, sizeof(Bundle))) Bundle;
  if (bundle->n == 0) opened_.push_back(to.value - first_here_);
  bundle->messages[bundle->n++] = message;
  if (message->prioritised) [[unlikely]]
    bundle->prioritised = true;
  if (bundle->n == Bundle::capacity) post(bundle, to);
  hold();
}

void Peers::post(Bundle*& bundle, PeId to) {
  if (bundle->n == 1) {  // posted alone; the bundle is kept for later messages
    auto* const message = static_cast<Envelope*>(bundle->messages[0]);
    bundle->n = 0;
    bundle->prioritised = false;
    pe_.machine().post(pe_.id(), to, message, sizeof(Envelope), message->action->traffic);
  } else {
    pe_.machine().post_bundle(to, std::exchange(bundle, nullptr));
  }
}

std::uint64_t Peers::before_slow() {
  flush();
  return read_ticks();
}

void Peers::slow_ran(const Action& action, std::uint64_t began) const {
  const bool quick = read_ticks() - began < bundle_ticks_;
  action.set_pace(quick ? Action::Pace::quick : Action::Pace::slow);
}

void Peers::look_at_clock(const Action& action) {
  const std::uint64_t now = read_ticks();
  if (now - last_look_ > bundle_ticks_) {
    if (look_every_ == 1) action.set_pace(Action::Pace::slow);
    look_every_ = 1;
  } else {
    look_every_ = std::min(2 * look_every_, most_between_looks);
  }
  until_look_ = look_every_;
  last_look_ = now;
  if (now - held_since_ > packed_ticks_) {
    flush();
  } else if (now - held_since_ > bundle_ticks_) {
    flush_bundles();
    holds_ = outbox_->holds();
  }
}

void Peers::flush_bundles() {
  for (const std::int32_t at : opened_) {
    Bundle*& bundle = bundles_[static_cast<std::size_t>(at)];
    if (bundle != nullptr && bundle->n != 0) post(bundle, PeId{first_here_ + at});
  }
  opened_.clear();
}

bool Peers::flush() {
  if (!holds_) return false;
  holds_ = false;
  flush_bundles();
  outbox_->flush();
  return true;
}

void Peers::drop_all() {
  for (Bundle*& bundle : bundles_) {
    if (bundle == nullptr) continue;
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      discard(static_cast<Envelope*>(bundle->messages[i]));
    Pool::release(std::exchange(bundle, nullptr), &pe_.pool());
  }
  outbox_->drop_all();
}

}  // namespace tess::detail
