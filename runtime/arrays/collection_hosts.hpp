// Connects the broadcast log and the reduction trees of a collection to their PE and to the
// collection's elements.
#pragma once

#include "runtime/arrays/broadcast_log.hpp"
#include "runtime/reduce/reduction_tree.hpp"

namespace tess::detail {

class Collection;

/// Starts a broadcast from this PE, even if the collection is not known here yet.
void start_broadcast(CollectionId collection, SharedCall call);

class BroadcastHostOfCollection final : public BroadcastHost {
 public:
  explicit BroadcastHostOfCollection(Collection& collection) : collection_(collection) {}

  void send(PeId to, const NumberedCall& call) override;
  void send(PeId to, const BroadcastSettled& settled) override;
  void send(PeId to, const BroadcastDrop& drop) override;
  void flush() override;
  void apply(const NumberedCall& call) override;

 private:
  Collection& collection_;
};

/// The tree of a collection: its own, or a second one over members that a library defines (the
/// balancer's barrier).
enum class Track : std::uint8_t { own, second };

class ReductionHostOfCollection final : public ReductionHost {
 public:
  ReductionHostOfCollection(Collection& collection, Track track)
      : collection_(collection), track_(track) {}

  void send(PeId to, ReductionReport&& report) override;
  void send(PeId to, const ReductionBegin& begin) override;
  [[nodiscard]] std::uint64_t applied_broadcast() const override;
  void postpone_new_elements() override;
  void deliver(Partial& result, EpochId epoch) override;
  /// From now on the messages of the tree run before those of users. Called on every PE.
  void expedite() { expedites_ = true; }

 private:
  Collection& collection_;
  const Track track_;
  bool expedites_ = false;
};

}  // namespace tess::detail
