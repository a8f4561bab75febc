// The data of one PE in a distributed strategy: its own elements, and of another PE only the
// summary that it has sent. The step functions of diffusion and gossip use only this, so that a
// group can run them with messages; the drivers here run them over a snapshot.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <map>
#include <optional>
#include <set>
#include <utility>

namespace tess::balance {

/// An element that is offered.
struct Item {
  double load = 0;
  std::size_t element = 0;  ///< the element's number, opaque to the other PE
  std::int64_t memory_bytes = 0;
  std::int64_t working_bytes = 0;
  std::size_t block = no_block;  ///< the shared block that it uses
  std::int64_t block_bytes = 0;
  friend auto operator<=>(const Item&, const Item&) = default;
};

/// The summary of a PE for others: a few numbers, and the shared blocks that it holds.
struct PeSummary {
  double work = 0;  ///< seconds at speed 1
  double background = 0;
  double speed = 1;
  std::int64_t room_bytes = 0;        ///< negative if the PE is above its limit
  std::int64_t working_bytes = 0;     ///< the most that one of its elements needs
  std::vector<std::size_t> blocks{};  ///< ascending

  /// The seconds that it needs, with `more` work added.
  [[nodiscard]] double time(double more = 0) const { return background + (work + more) / speed; }
  /// The room that the item takes here: nothing for a block that is here already, nor for working
  /// memory that another element needs as well.
  [[nodiscard]] std::int64_t needs_bytes(const Item& item) const;
  /// Takes the room of an item.
  void occupy(const Item& item);
};

class LocalPe {
 public:
  explicit LocalPe(PeSummary without_elements) : now_(std::move(without_elements)) {}

  [[nodiscard]] const PeSummary& summary() const { return now_; }
  [[nodiscard]] const std::set<Item>& items() const { return items_; }

  /// Adds an element of this PE with any load; it may be offered if `migratable`.
  void hold(const Item& item, bool migratable);
  void give(const Item& item);
  void receive(const Item& item) { hold(item, true); }

  /// The element to offer to a PE that should get `wanted` work: the largest one within it for
  /// which there is room there; otherwise the smallest larger one, for which the other PE gives
  /// elements back.
  [[nodiscard]] std::optional<Item> offer(const PeSummary& other, double wanted) const;

  /// The answer to an offer: elements to give in return, largest first, such that the PE receives
  /// not much more than `wanted` work. No value means a refusal: there is no memory for the trade,
  /// or the later of the two PEs would not finish earlier. What a PE frees is known only for each
  /// element's own memory, so a trade that needs a freed block's room is refused as well.
  [[nodiscard]] std::optional<std::vector<Item>> change_for(const Item& item, double wanted,
                                                            const PeSummary& giver) const;

 private:
  PeSummary now_;
  std::set<Item> items_;
  std::map<std::size_t, std::size_t> users_;     // elements here per shared block
  std::map<std::int64_t, std::size_t> working_;  // elements here per working memory above 0
};

/// Carries out an offer and its answer.
void trade(LocalPe& giver, LocalPe& taker, const Item& item, const std::vector<Item>& change);

/// What a PE may hold by such a limit; 0: no limit.
[[nodiscard]] std::int64_t room_of(std::uint64_t memory_limit_bytes);

/// The local view of every PE of a snapshot.
[[nodiscard]] std::vector<LocalPe> local_pes(const Snapshot& snapshot);

/// The assignment of a snapshot's elements that these PEs hold.
[[nodiscard]] Assignment collect(const Snapshot& snapshot, const std::vector<LocalPe>& pes);

}  // namespace tess::balance
