// Waits until no message is under way, control messages included, while the main coroutine itself
// waits. PE 0 asks all PEs for the numbers of messages that they have sent and processed, again and
// again, by messages that are not counted. Nothing is under way once the number sent in one wave is
// the number processed in the wave before: both only grow (completion.hpp has the argument).
//
// Each PE freezes its periodic timers in the first wave; thaw_here() ends that. A timer that runs
// once is reported: a checkpoint cannot save it.
#pragma once

#include "runtime/pe/pe.hpp"
#include "runtime/task.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tess::detail {

/// Ends on each PE what a Quiet began. For AskAll.
struct Thaw {
  std::uint8_t none = 0;
};
Thaw thaw_here(Pe& pe, const Thaw& done);

class Quiet {
 public:
  Quiet() = default;
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet();

  [[nodiscard]] bool await_ready() const noexcept { return false; }
  void await_suspend(Task::Handle task);
  /// A line for each PE on which timers are set; nothing if the run is quiet.
  std::vector<std::string> await_resume() { return std::move(timers_); }

  struct Asked {
    std::uint64_t id = 0;
    PeId from;
  };
  struct Answered {
    std::uint64_t id = 0;
    PeId from;
    bool reports = false;  // the PE had to report about an epoch
    std::uint64_t n_sent = 0;
    std::uint64_t n_processed = 0;
    std::uint64_t n_timers = 0;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(id, from, reports, n_sent, n_processed, n_timers);
    }
  };
  static void asked(Pe& pe, Asked&& m);
  static void answered(Pe& pe, Answered&& m);

 private:
  void ask();
  void take(const Answered& answer);

  Pe& pe_ = current_pe();
  Task::Handle task_;
  std::optional<RunHold> hold_;  // the run is not over meanwhile
  std::uint64_t id_ = 0;
  std::int32_t n_left_ = 0;
  bool reports_ = false;
  std::uint64_t n_sent_ = 0, n_processed_ = 0;  // sums over the PEs that have answered
  std::uint64_t processed_before_ = 0;          // in the wave before
  std::vector<std::string> timers_;
};

}  // namespace tess::detail
