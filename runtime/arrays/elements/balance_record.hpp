// The record of an element for its balancer, which migrates with the element: its measured load,
// and its place in the at_sync() barrier.
#pragma once

#include "runtime/core/serialize.hpp"
#include "runtime/pe/measure/load_record.hpp"
#include "runtime/pe/meter.hpp"

#include <cstdint>

namespace tess::detail {

/// The state of an element at the barrier.
enum class SyncPhase : std::uint8_t {
  runs,
  waits,    ///< it called at_sync()
  resumes,  ///< the message that calls resume_from_sync() is under way
};

/// Whether a barrier has seen an element.
enum class SyncEntry : std::uint8_t {
  none,
  held,    ///< it waits until the coordinator says which round it joins
  member,  ///< it joins round SyncState::next
};

struct SyncState {
  SyncPhase phase = SyncPhase::runs;
  SyncEntry entry = SyncEntry::none;
  std::uint32_t next = 0;    ///< for a member: the next round that it reaches
  EpochId epoch{};           ///< the epoch that the wait belongs to
  std::uint32_t led_by = 0;  ///< the broadcast that led to its wait
};

/// The loads of an element as a checkpoint has them, in seconds at speed 1; -1 if unknown.
struct PastLoad {
  double of_last_phase = -1;
  double since_then = -1;  ///< of the phase that the checkpoint interrupted
};

struct BalanceRecord {
  static constexpr std::size_t nowhere = ~std::size_t{0};

  LoadRecord load;
  SyncState sync;
  PastLoad past;                   ///< its second part: only after a restart, until a phase begins
  std::uint64_t size_bytes = 0;    ///< packed size when last measured; 0: never
  std::size_t position = nowhere;  ///< position in its PE's report of this round; does not migrate

  /// Ticks are packed as seconds, since another machine's counter may have another rate.
  void pack(Writer& ar, const Meter& meter) const;
  void unpack(Reader& ar, const Meter& meter);
  /// For a checkpoint.
  [[nodiscard]] PastLoad to_save(const Meter& meter) const {
    return {past.of_last_phase,
            load.known() ? meter.seconds(load.ticks) * load.speed : past.since_then};
  }
};

}  // namespace tess::detail
