// The audit of messages between PEs (--audit): each PE counts, by the other PE and the message's
// action, what it sends and what arrives. Each hop of a message counts by itself, so a message that
// is forwarded is counted on each of its hops. The k-th message of one action from one PE to
// another carries the number k. Both ends add up the count, the numbers, and a hash of the numbers:
//
//     sent      n   Σ k   Σ hash(k)     equal: each arrived once
//     received  n   Σ k   Σ hash(k)     one missing: the difference of the sums is its number
//
// The hashes differ where one message is lost and another arrives twice. The tables are compared at
// quiescence, and in the reports of a hang, where a message may also be under way.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace tess::detail {

/// What one end counted of the messages of one action between two PEs.
struct AuditRow {
  PeId from{};
  PeId to{};
  std::uint32_t action = 0;
  bool at_sender = false;
  std::uint64_t n = 0;
  std::uint64_t numbers = 0;  ///< sum
  std::uint64_t hashes = 0;   ///< sum
  template <class Ar>
  void serialize(Ar& ar) {
    ar(from, to, action, at_sender, n, numbers, hashes);
  }
};

/// The counters of one PE.
class Audit {
 public:
  explicit Audit(PeId here) : here_(here) {}

  /// Counts a message that leaves for another PE; returns its number, which is not 0.
  std::uint32_t sent(PeId to, std::uint32_t action);
  void received(PeId from, std::uint32_t action, std::uint32_t number);
  [[nodiscard]] std::vector<AuditRow> rows() const;

  /// Numbers have so many bits, and then begin again.
  static constexpr unsigned n_bits = 29;

 private:
  struct Sums {
    std::uint64_t n = 0, numbers = 0, hashes = 0;
  };
  using Table = std::unordered_map<std::uint64_t, Sums>;  // by PE and action
  static std::uint64_t key(PeId pe, std::uint32_t action) {
    return static_cast<std::uint64_t>(pe.value) << 32U | action;
  }
  static void add(Sums& sums, std::uint32_t number);

  const PeId here_;
  Table sent_, received_;
};

/// The result of a comparison.
struct AuditResult {
  std::uint64_t n_sent = 0;
  std::vector<std::string> differences;  ///< one line for each pair of PEs and action
};

/// Compares the rows of all PEs. `name` names an action. A pair with a PE of which `answered` is
/// false is left out.
[[nodiscard]] AuditResult compare(const std::vector<AuditRow>& rows,
                                  const std::function<std::string(std::uint32_t)>& name,
                                  const std::function<bool(PeId)>& answered);

}  // namespace tess::detail
