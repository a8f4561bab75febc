// What the runtime keeps of an element for its balancer, and takes along when the element migrates:
// its measured load, and its place in the at_sync() barrier.
#pragma once

#include "runtime/core/serialize.hpp"
#include "runtime/scheduler/load_record.hpp"
#include "runtime/scheduler/meter.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace tess {

/// Where an element is on its way through the barrier.
enum class SyncPhase : std::uint8_t {
  runs,
  waits,    ///< it called at_sync()
  resumes,  ///< the message that calls resume_from_sync() is on its way to it
};

struct SyncState {
  SyncPhase phase = SyncPhase::runs;
  bool known = false;           ///< a barrier has seen it
  bool member = false;          ///< the barrier waits for it
  std::uint32_t next = 0;       ///< a member: the round it reaches next
  std::uint32_t waits_for = 0;  ///< while it waits: the round that resumes it
  EpochId epoch{};              ///< on whose account it waits
  std::uint32_t led_by = 0;     ///< the broadcast that led to its wait
};

struct BalanceRecord {
  static constexpr std::size_t nowhere = ~std::size_t{0};

  LoadRecord load;
  SyncState sync;
  std::uint64_t size_bytes = 0;    ///< packed, when it was last looked at; 0: never
  std::size_t position = nowhere;  ///< among what its PE has reported in this round; stays here

  /// Ticks travel as seconds: another machine's counter may run at another rate.
  void pack(Writer& ar, const Meter& meter) const;
  void unpack(Reader& ar, const Meter& meter);
};

}  // namespace tess
