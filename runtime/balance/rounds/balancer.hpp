// The balancer of one array: a group with one member per PE. Each member watches the array's
// elements on its PE; the coordinator (on the PE that started balancing) decides.
//
//     at_sync of all -> barrier -> coordinator: reached
//         collect  ->  all PEs report their loads        (reduction, in PE order)
//         decide       the strategy, on the coordinator
//         move     ->  elements migrate                  (an epoch: it ends when all have arrived)
//         resume   ->  every element continues
//
// A periodic round runs beside the elements' work. Its messages are expedited, and unless the
// strategy is distributed it neither awaits an epoch nor continues a coroutine, since both take
// their turn after the messages that are ready:
//
//     due -> collect -> (reduction) -> collected -> move_beside -> moved
//
// The balancer ends with its array: as soon as the array has ended on the coordinator, or after the
// round that runs then.
//
// A distributed strategy (diffusion, gossip) needs neither collect nor decide: the PEs exchange
// items among themselves (Exchange), then each PE fetches the elements that it was given.
#pragma once

#include "runtime/balance/rounds/barrier.hpp"
#include "runtime/balance/rounds/exchange.hpp"
#include "runtime/balance/rounds/measured.hpp"
#include "runtime/epoch.hpp"
#include "runtime/future.hpp"
#include "runtime/group.hpp"

#include <memory>

namespace tess::balance {

class Balancer final : public Group<Balancer>, private ElementWatcher {
 public:
  static constexpr LateMessages late_messages = LateMessages::ignored;
  static constexpr bool in_checkpoints =
      false;  // start_balancing() is called again after a restart

  /// The options that every member needs.
  struct Plan {
    CollectionId array{};
    PeId coordinator{};
    BalanceWhen when = BalanceWhen::at_sync;
    std::int64_t period_ns = 0;
    bool passes = false;         ///< strategy none, or periodic: at_sync() continues immediately
    std::vector<double> speeds;  ///< speed of each PE, or empty
    std::vector<std::uint64_t> memory_limit_bytes;
    DistributedStrategy distributed = DistributedStrategy::none;
    GroupProxy<Exchange> exchange;  ///< for a distributed strategy
    SnapshotIndices indices = SnapshotIndices::none;
  };
  /// The result of a distributed round, summed over PEs.
  struct RoundSums {
    PhaseSums phase;
    std::uint64_t n_elements = 0;
    std::uint64_t n_moved = 0;
    std::uint64_t moved_bytes = 0;
  };
  explicit Balancer(const Plan& plan);

  /// The array is known here: from now on the barrier waits for its elements.
  void attach(Collection& array);
  /// On the coordinator: sets the object that decides.
  void coordinate(std::unique_ptr<Coordinator> coordinator) {
    coordinator_ = std::move(coordinator);
  }
  [[nodiscard]] const std::vector<Round>& history() const;
  /// The group ends; the array may still exist here.
  void group_ends();
  /// The array has ended on this PE, possibly before attach().
  void array_ends();
  /// The array, or the exchange, ended before attach().
  void cannot_attach();
  /// On the coordinator: begins a phase; earlier measurements are discarded.
  Task begin_phase();
  /// On the coordinator: a round by the loads of a checkpoint.
  Task place_again();
  /// On the coordinator: ends a phase without a barrier of the elements.
  Task phase_ends(Others others = Others::fixed);

  // Entry methods.
  void attached_everywhere(std::int64_t n_under_way);
  void late_arrival();
  void admit(PeId asker, std::uint32_t ticket);
  void joins(std::uint32_t ticket, std::uint32_t round);
  void begin();
  Task reached(std::uint64_t n_elements);
  void due(std::uint64_t round);
  void sum_up(Others others, const Callback<PhaseSums>& target);
  void collect(Others others, const Callback<std::vector<PeReport>>& target);
  void collected(const std::vector<PeReport>& reports);
  void move_beside(const std::vector<Move>& moves);
  void moved();
  void move(const std::vector<Move>& moves);
  void resume(std::uint32_t round);
  /// A phase ends without a round, begins behind the moves of a round, or behind something else.
  enum class Phase : std::uint8_t { ends, begins_behind_moves, begins };
  void forget(Phase phase, const Callback<void>& done);
  void sum_past(const Callback<PastLoad>& target);
  void recall(bool interrupted, const Callback<std::uint64_t>& done);
  void prepare(Others others, const Callback<PhaseSums>& target);
  void fetch();
  void sum_round(const Callback<RoundSums>& target);

  /// Those of a periodic round, which elements' messages would otherwise delay at each of its
  /// steps.
  using EntryAttributes =
      Attributes<EntryMethod<&Balancer::due, expedited>, EntryMethod<&Balancer::collect, expedited>,
                 EntryMethod<&Balancer::collected, expedited>,
                 EntryMethod<&Balancer::move_beside, expedited>,
                 EntryMethod<&Balancer::moved, expedited>>;

 private:
  // ElementWatcher.
  void entered(Element& element) override;
  void left(Element& element) override;
  void destroyed(Element& element) override;
  void at_sync(Element& element) override;
  void collection_ends() override { array_ends(); }

  void watch(Collection& array);
  Task attached();
  Task forget_all(Phase phase);
  Task round(Others others);
  void begin_round();
  void end_round();
  void round_is_over();
  Task distributed_round_beside();
  [[nodiscard]] std::vector<std::vector<Move>> decide(const std::vector<PeReport>& reports);
  Task central_round(Others others);
  Task distributed_round(Others others);
  void pass(Element& element);
  void begin_if_ready();
  void alarm();
  void detach();
  void end_if_over();

  const Plan plan_;
  Barrier barrier_;
  Measured measured_;
  Collection* array_ = nullptr;   // set once its elements are measured
  std::string array_name_;        // set with it
  bool barrier_is_open_ = false;  // on this PE; before, elements are only measured
  std::uint64_t n_collected_ = 0;
  std::uint64_t n_rounds_seen_ = 0;  // periodic: rounds that this member knows of
  RoundSums sums_;                   // result of this PE in a distributed round

  // Only on the coordinator.
  std::unique_ptr<Coordinator> coordinator_;
  std::uint32_t barriers_ = 0;   // rounds at barriers that are over
  std::uint32_t n_reached_ = 0;  // barriers reached whose rounds are not over
  std::uint64_t n_rounds_ = 0;
  std::int64_t n_under_way_ = 0;  // elements that left a PE before balancing started there
  bool attached_ = false;         // all PEs are attached
  Callback<void> when_attached_;  // target for a round that waits for it
  bool ready_ = false;            // all members of round 0 are known
  bool running_ = false;
  std::size_t n_moving_ = 0;  // periodic: PEs that have not begun the round's moves yet, and 1
  Time round_began_{0};
  bool array_ended_ = false;  // on this PE: the balancer ends after the current round
  Time phase_began_{0};
};

/// Creates the balancer of an array, coordinated by this PE. For start_balancing().
[[nodiscard]] GroupProxy<Balancer> start(CollectionId array, const BalanceOptions& options,
                                         Strategy users);

}  // namespace tess::balance
