// Gossip (Menon and Kalé 2013, "A distributed dynamic load balancer for iterative applications"):
// underloaded PEs spread rumours of their load; overloaded PEs offer elements to PEs they have
// heard of, chosen at random with preference for the emptier. Differences from the paper: a PE
// remembers a bounded number of others (the paper's lists grow to all PEs), and the receiver
// decides about an offer, so that neither old rumours nor two givers at once overload it or break
// its memory limit. For an element that is too heavy it gives smaller elements back; otherwise
// heavy elements would stay stuck among PEs of average load.
//
//   one iteration:  tell -> hear (n_rounds times)  ;  propose -> answer -> learn (until nothing)
//
// The only number known to all is the average time (one reduction).
#pragma once

#include "runtime/balance/local_pe.hpp"
#include "runtime/core/hash.hpp"

namespace tess::balance {

/// The state of an underloaded PE, spread to others.
struct Rumour {
  std::size_t pe = 0;
  PeSummary summary;
};

/// An element that is offered to a PE.
struct Offer {
  std::size_t to = 0;
  Item item;
  PeSummary giver;  ///< state of the giver before it gives
};

/// One PE of the protocol; each public call is a message to or from it.
class GossipPe {
 public:
  static constexpr std::size_t most_known = 32;

  GossipPe(LocalPe local, std::size_t self, double average_time, std::uint64_t seed)
      : local_(std::move(local)), self_(self), average_(average_time), next_(mix(seed + self)) {}

  /// Forgets the rumours; an underloaded PE then knows only its own state.
  void begin_iteration();
  /// The rumours that the PE would send now.
  [[nodiscard]] const std::vector<Rumour>& tell() const { return known_; }
  [[nodiscard]] std::size_t random_peer(std::size_t n_pes) { return next_.below(n_pes); }
  void hear(const std::vector<Rumour>& rumours);
  /// The next offer, if the PE is overloaded and knows a PE that may take an element.
  [[nodiscard]] std::optional<Offer> propose();
  /// The receiver's decision: the elements that it gives back for the one it takes, or a refusal
  /// (see LocalPe::change_for).
  [[nodiscard]] std::optional<std::vector<Item>> answer(const Offer& offer) const;
  /// Records the receiver's state after its answer.
  void learn(const Offer& offer, bool taken, const PeSummary& receiver);

  [[nodiscard]] const LocalPe& local() const { return local_; }
  [[nodiscard]] LocalPe& local() { return local_; }

 private:
  /// The work that would bring a PE to its permitted load.
  [[nodiscard]] double gap(const PeSummary& pe) const;

  LocalPe local_;
  std::size_t self_;
  double average_;
  Random next_;
  std::vector<Rumour> known_;
};

/// Runs the protocol over a snapshot; messages of a round arrive in PE order.
[[nodiscard]] Assignment gossip(const Snapshot& snapshot, std::uint64_t seed);

}  // namespace tess::balance
