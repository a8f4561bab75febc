// What one PE knows in a distributed strategy: its own elements, and of another PE no more than a
// summary that the other has sent. The step functions of diffusion and gossip work on these alone,
// so that a group can run them with messages; the drivers here run them over a snapshot.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <optional>
#include <set>

namespace tess::balance {

/// One PE as it tells others: four numbers.
struct PeSummary {
  double work = 0;  ///< seconds at speed 1
  double background = 0;
  double speed = 1;
  std::int64_t room_bytes = 0;  ///< negative where it is above its limit already

  /// Seconds that it needs, with `more` work besides.
  [[nodiscard]] double time(double more = 0) const { return background + (work + more) / speed; }
};

/// An element on offer.
struct Item {
  double load = 0;
  std::size_t element = 0;  ///< who: opaque to the other PE
  std::int64_t memory_bytes = 0;
  friend auto operator<=>(const Item&, const Item&) = default;
};

class LocalPe {
 public:
  explicit LocalPe(PeSummary without_elements) : now_(without_elements) {}

  [[nodiscard]] const PeSummary& summary() const { return now_; }
  [[nodiscard]] const std::set<Item>& items() const { return items_; }

  /// An element that is here: it may go on where `migratable`, and it has any load.
  void hold(const Item& item, bool migratable);
  void give(const Item& item);
  void receive(const Item& item) { hold(item, true); }

  /// What to offer to a PE that should get `wanted` work: the largest element within it that finds
  /// room there, else the smallest above, for which the other gives change.
  [[nodiscard]] std::optional<Item> offer(const PeSummary& other, double wanted) const;

  /// The answer to an offer: elements to give in return, largest first, such that not much more
  /// than `wanted` work comes in with it. Nothing, a refusal, where memory has no room for the
  /// trade or the later of the two PEs would not be done sooner.
  [[nodiscard]] std::optional<std::vector<Item>> change_for(const Item& item, double wanted,
                                                            const PeSummary& giver) const;

 private:
  PeSummary now_;
  std::set<Item> items_;
};

/// Carries out what was offered and answered.
void trade(LocalPe& giver, LocalPe& taker, const Item& item, const std::vector<Item>& change);

/// Every PE of a snapshot as it sees itself.
[[nodiscard]] std::vector<LocalPe> local_pes(const Snapshot& snapshot);

/// Where the elements of a snapshot are when the PEs hold these.
[[nodiscard]] Assignment collect(const Snapshot& snapshot, const std::vector<LocalPe>& pes);

}  // namespace tess::balance
