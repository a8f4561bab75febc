// What waits in a run: the lines and the facts from which the reports of a deadlock, of a signal
// and of --hang-report are made. Each PE fills a Waits (census.hpp); those of several PEs are merged
// and printed.
//
//     3 wait:
//       cycle of replies: Cell[3] waits for Cell[5].depth, Cell[5] waits for Cell[3].depth
//       1 message (Cell::take) on PE 2 to Cell[9], which does not exist
//       Cell[3] on PE 2: Cell::step waits for the reply of Cell[5].depth
//
// What others wait for stands first: running handlers, then messages without an element, incomplete
// reductions and barriers, then coroutines, epochs and queues. Long lists are shortened.
#pragma once

#include "runtime/pe/report/audit.hpp"
#include "runtime/pe/report/wait_reason.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess::detail {

/// The place of a line in the report.
enum class WaitRank : std::uint8_t { handler, message, collective, coroutine, epoch, queue };

struct WaitLine {
  WaitRank rank{};
  std::string text;
};

/// An element (or the main program) that needs the reply of another.
struct Need {
  NamedElement asker;
  NamedElement asked;
};

struct Waits {
  static constexpr std::size_t n_ranks = 6;
  /// A PE keeps so many lines of one rank, and so many needs; it counts the other lines.
  static constexpr std::size_t most_kept = 1000;
  static constexpr std::size_t most_needs = 100'000;

  std::vector<WaitLine> lines;
  std::array<std::uint64_t, n_ranks> n_of_rank{};  ///< with those that were not kept
  std::vector<Need> needs;
  std::vector<AuditRow> audit;  ///< with --audit: the messages that the PEs have counted

  void add(WaitRank rank, std::string text);
  void add_need(Need need) {
    if (needs.size() < most_needs) needs.push_back(std::move(need));
  }
  void merge(Waits&& other);
  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] bool empty() const { return size() == 0; }
};

/// "3 wait:" and a line for each, ordered by rank and text; the last ones of many of one rank are
/// left out, with their number. Cycles of replies stand first. If nothing waits it says so.
[[nodiscard]] std::string list_of_waiting(Waits waits);

/// The cycles of elements that wait for each other's replies, each as a text; at most one per
/// element.
[[nodiscard]] std::vector<std::string> cycles_of_replies(const std::vector<Need>& needs);

}  // namespace tess::detail
