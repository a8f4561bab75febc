// Gossip (Menon and Kalé 2013, "A distributed dynamic load balancer for iterative applications"):
// underloaded PEs spread word of themselves, overloaded PEs offer elements to PEs they have heard
// of, at random, more likely to the emptier. Where it differs from the paper: a PE remembers a
// bounded number of others (the paper's lists grow to all PEs), and the receiver decides about an
// offer, so that neither stale word nor two givers at once overload it or break its memory limit;
// for an element heavier than it has room for it gives change, without which heavy elements stay
// stuck among PEs of average load.
//
//   one iteration:  tell -> hear (n_rounds times)  ;  propose -> answer -> learn (until nothing)
//
// The one number known to all is the average time (one reduction).
#pragma once

#include "runtime/balance/local_pe.hpp"
#include "runtime/core/hash.hpp"

namespace tess::balance {

/// Word of an underloaded PE.
struct Rumour {
  std::size_t pe = 0;
  PeSummary summary;
};

/// An element offered to a PE.
struct Offer {
  std::size_t to = 0;
  Item item;
  PeSummary giver;  ///< before it gives
};

/// One PE of the protocol; each public call is a message to it or from it.
class GossipPe {
 public:
  static constexpr std::size_t most_known = 32;

  GossipPe(LocalPe local, std::size_t self, double average_time, std::uint64_t seed)
      : local_(std::move(local)), self_(self), average_(average_time), next_(mix(seed + self)) {}

  /// Forgets what it has heard; an underloaded PE knows of itself again.
  void begin_iteration();
  /// What it would say now.
  [[nodiscard]] const std::vector<Rumour>& tell() const { return known_; }
  [[nodiscard]] std::size_t random_peer(std::size_t n_pes) { return next_.below(n_pes); }
  void hear(const std::vector<Rumour>& rumours);
  /// An element that it would give, if it is overloaded and knows of a PE that may take it.
  [[nodiscard]] std::optional<Offer> propose();
  /// The receiver's decision: the elements that it gives in return for the one it takes, or a
  /// refusal (see LocalPe::change_for).
  [[nodiscard]] std::optional<std::vector<Item>> answer(const Offer& offer) const;
  /// How the receiver is after its answer.
  void learn(const Offer& offer, bool taken, const PeSummary& receiver);

  [[nodiscard]] const LocalPe& local() const { return local_; }
  [[nodiscard]] LocalPe& local() { return local_; }

 private:
  /// The work that would bring a PE to the load that it may have.
  [[nodiscard]] double gap(const PeSummary& pe) const;

  LocalPe local_;
  std::size_t self_;
  double average_;
  Random next_;
  std::vector<Rumour> known_;
};

/// The protocol over a snapshot; messages of a round arrive in PE order.
[[nodiscard]] Assignment gossip(const Snapshot& snapshot, std::uint64_t seed);

}  // namespace tess::balance
