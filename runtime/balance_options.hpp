// How an array is balanced: the strategy, when rounds run, and the prediction of loads.
#pragma once

#include "runtime/core/duration.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tess {

enum class RoundLines : std::uint8_t { none, print };
enum class SnapshotIndices : std::uint8_t { none, text };
enum class BalanceWhen : std::uint8_t { at_sync, periodic, automatic };

struct BalanceOptions {
  /// A name of balance::strategy_names(). With `none`, at_sync() is no barrier: elements continue
  /// immediately. With the user's own strategy: its name in reports, `own` if it has none.
  std::string strategy = "greedy_refine";
  BalanceWhen when = BalanceWhen::at_sync;
  std::chrono::nanoseconds period{0};  ///< period of periodic rounds, for which it is above 0
  /// last, moving_average, linear_trend. Distributed strategies (diffusion, gossip) know `last`
  /// only.
  std::string prediction = "last";
  std::uint64_t window = 5;                         ///< number of phases that a prediction uses
  std::uint64_t seed = 1;                           ///< seed of strategies that use random numbers
  std::vector<double> speeds{};                     ///< relative speed of each PE; empty: all equal
  std::vector<std::uint64_t> memory_limit_bytes{};  ///< of each PE; 0 or empty: none
  RoundLines lines = RoundLines::none;              ///< or one line per round to standard error
  /// text: snapshots have the index of each element, which costs a string per element and round.
  SnapshotIndices indices = SnapshotIndices::none;
};

/// "strategy=greedy,when=periodic,period=50ms,prediction=linear_trend,window=5,seed=7,report".
/// A first part without a key is the strategy. Throws Error that names the part.
[[nodiscard]] BalanceOptions parse_balance(std::string_view text);

namespace balance {
enum class StrategyOf : std::uint8_t { runtime, user };

/// Throws Error that names the option, its value, and what it may be. 0 PEs: their number is not
/// known yet. With the user's own strategy, options.strategy may be any name.
void validate(const BalanceOptions& options, std::int32_t n_pes,
              StrategyOf strategy = StrategyOf::runtime);
/// Throws Error that names the chare and the strategy if the chare has no balance_position(), which
/// the strategy needs.
void require_no_positions(const BalanceOptions& options, std::string_view chare);
}  // namespace balance

}  // namespace tess
