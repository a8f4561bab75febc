// An exchange in which every PE has a parcel for some of the others, and has to know when it has
// all that are for it. With a message to every PE it costs P messages per PE. Beyond some PEs
// parcels are therefore combined (Bruck et al. 1997, "Efficient algorithms for all-to-all
// communications"): the way from a PE to another is the difference of their numbers, modulo P,
// written with base r. Round k takes every parcel, wherever it is, as far as digit k says:
//
//     P = 64, r = 8, from 3 to 23: the difference is 20, digits 4 and 2
//     round 0: 3 -> 3 + 4 = 7          round 1: 7 -> 7 + 2 * 8 = 23
//
// In each round a PE sends at most r - 1 messages, empty ones too, so it knows how many it receives:
// (r - 1) log_r P in all. A PE begins a round when it has received those before it. Messages of
// later rounds may arrive earlier.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide {

/// Items from a PE to a PE.
struct Address {
  std::int32_t from = 0, to = 0;
  std::uint32_t n_items = 0;
};

/// A message: parcels that have a part of their way in common.
template <class Item>
struct Bundle {
  std::uint32_t round = 0;
  std::vector<Address> parcels;
  std::vector<Item> items;  ///< parcel after parcel
};

/// The number base of the ways between `n_pes`: with few PEs every parcel goes directly.
[[nodiscard]] constexpr std::int64_t base_of_ways(std::int32_t n_pes) noexcept {
  constexpr std::int32_t few = 16;
  return n_pes <= few ? few : 8;
}

/// A PE's part of an exchange, which it makes one of. Each PE calls start() once, and receive()
/// with what arrives, which may be earlier. Both call send(to, bundle) for the messages to other
/// PEs.
template <class Item>
class Exchange {
 public:
  Exchange(std::int32_t me, std::int32_t n_pes)
      : me_(me), n_pes_(n_pes), base_(base_of_ways(n_pes)) {
    for (std::int64_t step = 1; step < n_pes; step *= base_) n_due_.push_back(n_messages(step));
  }

  /// Before start(); nothing is sent for PEs without a parcel of their own.
  void put(std::int32_t to, std::span<const Item> items) { hold({me_, to, 0}, items); }

  template <class Send>
  void start(const Send& send) {
    is_started_ = true;
    advance(send);
  }
  template <class Send>
  void receive(const Bundle<Item>& bundle, const Send& send) {
    const std::span<const Item> items(bundle.items);
    std::size_t at = 0;
    for (const Address& parcel : bundle.parcels) {
      hold(parcel, items.subspan(at, parcel.n_items));
      at += parcel.n_items;
    }
    --n_due_[bundle.round];
    if (is_started_) advance(send);
  }
  /// True once all parcels for this PE are here. Nothing arrives, and nothing is sent, any more.
  [[nodiscard]] bool is_done() const noexcept {
    return is_started_ && round_ == n_due_.size() && (n_due_.empty() || n_complete() == round_);
  }

  struct Parcel {
    std::int32_t from = 0;
    std::span<const Item> items;
  };
  /// Those for this PE, by sender, its own included. Valid while the exchange is.
  [[nodiscard]] std::vector<Parcel> received() const {
    std::vector<Parcel> out;
    for (const Held& held : held_)
      if (held.address.to == me_) out.push_back({held.address.from, items_of(held)});
    std::sort(out.begin(), out.end(),
              [](const Parcel& a, const Parcel& b) { return a.from < b.from; });
    return out;
  }

 private:
  struct Held {
    Address address;
    std::size_t begin = 0;
  };
  void hold(Address address, std::span<const Item> items) {
    address.n_items = static_cast<std::uint32_t>(items.size());
    held_.push_back({address, items_.size()});
    items_.insert(items_.end(), items.begin(), items.end());
  }
  [[nodiscard]] std::span<const Item> items_of(const Held& held) const {
    return {items_.data() + held.begin, held.address.n_items};
  }
  /// In a round whose digit counts steps of so many PEs.
  [[nodiscard]] std::int64_t n_messages(std::int64_t step) const {
    return std::min<std::int64_t>(base_ - 1, (n_pes_ - 1) / step);
  }
  /// Rounds from the first on of which all messages are here.
  [[nodiscard]] std::size_t n_complete() const noexcept {
    std::size_t n = 0;
    while (n < n_due_.size() && n_due_[n] == 0) ++n;
    return n;
  }

  template <class Send>
  void advance(const Send& send) {
    for (; round_ < n_due_.size() && n_complete() >= round_; ++round_, step_ *= base_) {
      const std::int64_t n = n_messages(step_);
      std::vector<Bundle<Item>> bundles(static_cast<std::size_t>(n));
      for (Bundle<Item>& bundle : bundles) bundle.round = static_cast<std::uint32_t>(round_);
      std::size_t n_kept = 0;
      for (const Held& held : held_) {
        const std::int64_t way = (std::int64_t{held.address.to} - me_ + n_pes_) % n_pes_;
        const std::int64_t digit = way / step_ % base_;
        if (digit == 0) {
          held_[n_kept++] = held;
          continue;
        }
        Bundle<Item>& bundle = bundles[static_cast<std::size_t>(digit - 1)];
        const std::span<const Item> items = items_of(held);
        bundle.parcels.push_back(held.address);
        bundle.items.insert(bundle.items.end(), items.begin(), items.end());
      }
      held_.resize(n_kept);
      for (std::int64_t digit = 1; digit <= n; ++digit)
        send(static_cast<std::int32_t>((me_ + digit * step_) % n_pes_),
             std::move(bundles[static_cast<std::size_t>(digit - 1)]));
    }
  }

  std::int32_t me_, n_pes_;
  std::int64_t base_, step_ = 1;
  std::vector<std::int64_t> n_due_;  // by round: messages that have not arrived
  std::size_t round_ = 0;            // that has not been sent
  bool is_started_ = false;
  std::vector<Held> held_;
  std::vector<Item> items_;  // also of parcels that have gone on
};

}  // namespace tess::collide
