// The distributed strategies among the PEs of a run: the computations of diffusion and gossip over
// a snapshot (strategies/), carried out by messages. It is a group with one member per PE; each has
// its own elements and what others have sent, and none has a list of all. Elements are exchanged as
// items of four numbers; they migrate only when the strategy is finished.
//
//   diffusion   in each stage two PEs talk:  greet <-> greet,  offer -> answer, offer -> answer …
//               (the later of the two offers); a reduction per sweep decides whether to continue
//   gossip      spread rumours, then  offer -> answer  until no PE makes an offer; a reduction after
//               each step, which does not wait for rumours under way: late ones are still used
#pragma once

#include "runtime/balance/rounds/pe_report.hpp"
#include "runtime/balance/strategies/gossip.hpp"
#include "runtime/callback.hpp"
#include "runtime/group.hpp"
#include "runtime/mailbox.hpp"

#include <memory>
#include <string_view>

namespace tess::balance {

enum class DistributedStrategy : std::uint8_t { none, diffusion, gossip };

/// The distributed strategy of this name; none for all other strategies.
[[nodiscard]] DistributedStrategy distributed_strategy(std::string_view name);

/// The name of an item: the PE that reported it, and its position there.
[[nodiscard]] constexpr std::size_t item_name(PeId origin, std::size_t position) {
  return static_cast<std::size_t>(origin.value) << 40U | position;
}
[[nodiscard]] constexpr PeId origin_of(std::size_t name) {
  return PeId{static_cast<std::int32_t>(name >> 40U)};
}
[[nodiscard]] constexpr std::size_t position_of(std::size_t name) {
  return name & ((std::size_t{1} << 40U) - 1);
}

class Exchange final : public Group<Exchange> {
 public:
  static constexpr LateMessages late_messages = LateMessages::ignored;
  static constexpr bool in_checkpoints = false;

  /// Sets this PE's elements as reported; called before run().
  void hold(const PeReport& report, double speed, std::uint64_t memory_limit_bytes);

  struct Order {
    DistributedStrategy strategy = DistributedStrategy::none;
    double average_time = 0;  ///< of all PEs, in seconds
    double mean_load = 0;     ///< weight of an element with unknown load, at speed 1
    std::uint64_t seed = 1;   ///< of gossip's random peers
  };
  /// On one member: makes all members carry out the strategy; `done` is called when they have.
  Task run(Order order, Callback<void> done);

  /// After run(): the items here that another PE reported.
  [[nodiscard]] std::vector<Item> arrived() const;
  [[nodiscard]] const PeSummary& summary() const { return local().summary(); }

  struct Talk {
    std::uint64_t key = 0;
    PeSummary summary;
    Item item;
    double wanted = 0;
    std::vector<Item> change;
    std::uint8_t ends = 0;  ///< the giver has nothing more to offer, or the taker refuses
  };
  struct Proposal {
    PeId from{};
    std::uint64_t key = 0;
    Offer offer;
  };
  struct Reply {
    std::uint64_t key = 0;
    std::uint8_t taken = 0;
    std::vector<Item> change;
    PeSummary receiver;
  };

  // Entry methods.
  struct Sweep {
    std::uint64_t number = 0;
    double mean_load = 0;
  };
  Task sweep(Sweep sweep, Callback<std::uint64_t> n_trades);
  void hear(Talk talk);
  void begin_gossip(Order order, const Callback<void>& done);
  void begin_iteration(const Callback<void>& done);
  void spread(const Callback<void>& done);
  void rumour(const std::vector<Rumour>& rumours);
  Task offer_all(Callback<std::uint64_t> n_trades);
  void propose(const Proposal& proposal);
  void reply(Reply reply);

 private:
  Task diffuse_with(PeId other, std::uint64_t stage);
  Task run_diffusion(Order order);
  Task run_gossip(Order order);
  void weigh_unknown(double mean_load);
  [[nodiscard]] const LocalPe& local() const { return gossip_ ? gossip_->local() : *local_; }

  std::unique_ptr<LocalPe> local_;
  std::uint64_t n_unknown_ = 0;       // local elements with unknown load, which are pinned
  std::unique_ptr<GossipPe> gossip_;  // holds a copy of the local PE from begin_gossip() on
  Mailbox<&Talk::key> talks_;
  Mailbox<&Reply::key> replies_;
  std::uint64_t n_trades_ = 0;  // trades of this PE in this sweep or iteration
  std::uint64_t n_offers_ = 0;
};

}  // namespace tess::balance
