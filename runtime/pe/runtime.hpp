// A run on one process: its PEs on a machine, and the end of the run. It ends in one of four ways,
// on all processes with the same exit code:
//
//   0       quiescence, and nothing waits
//   1       quiescence while something waits: a deadlock; what waits for what is reported
//   code    the program called exit(code)
//   1 or 2  an exception; 2 for bad input and for exhausted memory
//   128 + n signal n (SIGINT or SIGTERM); each process reports what waited there
//
// The end by exit():
//
//     exit asked -> PE 0: Stop to all PEs -> each stops user code, answers with the greatest code
//                                            that it was given; after a signal it first hands its
//                                            census to the service of its process
//                -> PE 0: Leave(code) to all PEs -> each stops its machine
#pragma once

#include "runtime/pe/interfaces/process_monitor.hpp"
#include "runtime/pe/interfaces/process_service.hpp"
#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/report/waiting.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace tess::detail {

struct LoadRecord;

/// "12 s", with three digits.
[[nodiscard]] std::string seconds_text(double seconds);

/// The words for an element in reports. The layer that defines elements provides the functions.
struct ElementWords {
  std::string (*text)(const Element& element);  ///< "Block[3,4]"
  std::string (*key)(const Element& element);   ///< unique in the job: reply_key()
  /// What its describe_state() returns, if it has one: "at step 16".
  std::string (*state)(const Element& element);
  LoadRecord* (*load)(Element& element);  ///< null: it is not measured
};

/// The key of an element in reports, from its collection and the hash of its index.
[[nodiscard]] std::string reply_key(CollectionId id, std::uint64_t index_hash);

class Runtime final : public Program {
 public:
  Runtime(Machine& machine, const RuntimeOptions& options, const ElementWords& words,
          std::function<void()> main);
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;
  ~Runtime() override;

  /// Called before run(). The service lives until the run has ended.
  void serve(ProcessService& service) { service_ = &service; }
  [[nodiscard]] ProcessService& service() { return *service_; }
  /// Called before run(): the PEs measure their idle time, and the monitor is called for what
  /// happens.
  void watch(ProcessMonitor& monitor);
  /// Null if the run is not monitored.
  [[nodiscard]] ProcessMonitor* monitor() { return monitor_; }
  /// Posts a message to a PE of this process once the delay is over.
  void post_after(PeId to, Envelope* message, Time delay);

  /// Throws Error if this process cannot run.
  void prepare() const;
  /// Drives this process until the run ends; returns the exit code.
  int run();

  [[nodiscard]] Machine& machine() { return machine_; }
  [[nodiscard]] const Machine& machine() const { return machine_; }
  [[nodiscard]] Pe& pe(PeId id) { return *pes_[static_cast<std::size_t>(id.value - first_.value)]; }

  /// The program, or a signal, requests the end of the run; the greatest exit code wins.
  void exit(Pe& pe, int code, int signal = 0);
  /// Epoch 0 is done. Called on PE 0.
  void quiescent(Pe& pe);
  /// Ends the run with exit code 2 and one line per process, however many PEs find bad input.
  void bad_input(Pe& pe, std::string_view what);
  /// Memory is exhausted: the same.
  void out_of_memory(Pe& pe, const std::string& place);
  [[nodiscard]] const ElementWords& element_words() const { return element_words_; }
  [[nodiscard]] const RuntimeOptions& options() const { return options_; }
  /// What a PE of this process runs, if --hang-report watches it: "Cell[3] on PE 2 has been in
  /// Cell::step for 12 s". On one thread at a time.
  struct Running {
    std::string text;
    double seconds = 0;
  };
  [[nodiscard]] std::optional<Running> watched(PeId id);
  /// The same text, or without --hang-report "it runs Cell::step".
  [[nodiscard]] std::string running_text(PeId id);
  /// What an audit found so far, as lines for a report; empty without one. `rows` and `answered`
  /// are of the PEs that have reported.
  [[nodiscard]] std::string audit_text(const std::vector<AuditRow>& rows,
                                       const std::function<bool(PeId)>& answered) const;
  /// Describes what a PE runs: "Block[3], Block::step on PE 2".
  [[nodiscard]] std::string describe(Pe& pe) const;
  /// The checkpoints of this run in a folder. On PE 0, for checkpoint() and restart().
  struct OwnCheckpoints {
    std::uint64_t last = 0;                ///< the last one that this run wrote or restarted from
    std::vector<std::uint64_t> refused{};  ///< damaged ones that a restart found
  };
  /// PE 0 only: a checkpoint() is under way.
  [[nodiscard]] bool& checkpoint_runs() { return checkpoint_runs_; }
  [[nodiscard]] OwnCheckpoints& own_checkpoints(const std::string& folder) {
    return own_checkpoints_[folder];
  }
  /// The random numbers of the runs that this one goes on with by restarts, the first one first,
  /// and at last its own. Empty until a checkpoint or restart. Checkpoints tell by it which run
  /// wrote them. On PE 0.
  [[nodiscard]] std::vector<std::uint64_t>& lineage() { return lineage_; }
  /// By PE: what the run that a restart goes on with had made, also on PEs that this run lacks. On
  /// PE 0.
  [[nodiscard]] std::vector<CollectionNumbers::Made>& made_before_restart() {
    return made_before_restart_;
  }
  /// Prints whole lines to standard error, never mixed with lines of another thread.
  void error_line(const std::string& line);

  // Program.
  void start(PeId pe) override;
  void accept(PeId id, Link* first) override { pe(id).accept(first); }
  void accept_bundle(PeId id, Bundle* bundle) override { pe(id).accept(bundle); }
  std::size_t step(PeId id, std::size_t most) override { return pe(id).step(most); }
  bool idle(PeId id) override { return pe(id).idle(); }
  void busy(PeId id) override { pe(id).busy(); }
  void receive(PeId id, std::span<const std::byte> bytes) override {
    pe(id).peers().receive(bytes);
  }
  Link* place(PeId id, std::span<const std::byte> head, std::span<const std::uint64_t> sizes,
              std::vector<std::span<std::byte>>& places) override {
    return pe(id).peers().place(head, sizes, places);
  }
  void placed(PeId id, Link* message) override;
  void drop(Link* message) override { discard(static_cast<Envelope*>(message)); }
  void finish(PeId id) override;

  // Control messages.
  struct EmptyArray {
    CollectionId id{};  // none: a section, which has no elements anywhere
    std::string name;
  };
  struct Census {
    Waits waits;
    std::uint64_t dead_letters = 0;
    std::vector<EmptyArray> empty;  // what has nothing to reduce on this PE
    bool exits = false;  // exit() was called: its message is under way, not counted in epoch 0
    std::uint64_t n_sent = 0;  // messages of epoch 0 that this PE has sent; its timers are frozen
    std::uint64_t n_periodic = 0;  // timers
  };
  void run_main(Pe& pe);
  void on_exit_asked(Pe& pe, int code, int signal);
  void on_stop(Pe& pe, int signal);
  /// What a PE measured, for process 0.
  struct Records {
    PeId pe{};
    PeLoad load;               // with --stats
    std::uint64_t origin = 0;  // of the trace, in ticks
    double seconds_per_tick = 0;
    Trace trace;  // with --trace, of PEs of other processes
  };
  void on_stopped(Pe& pe, int code, Records&& records);
  void on_leave(int code);
  void on_census_asked(Pe& pe);
  void on_census(Pe& pe, Census&& census);

 private:
  /// All processes of a job that cannot run call it: process 0 prints why. Returns the exit code.
  [[nodiscard]] int refuse_job(std::string_view why);
  void end_with(Pe& pe, int code, int signal = 0);
  /// Reports what waits at the end of the run, and ends it.
  void end_with_census(Pe& pe);
  /// Prints the result of the audit of a quiescent run; false if it found a difference.
  [[nodiscard]] bool report_audit();
  void print_statistics(PeId id);
  [[nodiscard]] Records records_of(Pe& pe) const;
  void write_trace_of_job();

  Machine& machine_;
  ProcessService* service_ = nullptr;
  ProcessMonitor* monitor_ = nullptr;
  const RuntimeOptions options_;
  const ElementWords element_words_;
  const std::function<void()> main_;
  const PeId first_;
  std::unique_ptr<std::byte[]> reserve_;  // released when memory is exhausted
  std::deque<Pool> pools_;  // before the PEs: one PE may free memory of another's pool
  std::vector<std::unique_ptr<Pe>> pes_;
  std::mutex output_;
  std::atomic<int> exit_code_{0};
  std::atomic<bool> left_{false};
  std::atomic<bool> said_bad_input_{false}, said_out_of_memory_{false};
  Waits still_;  // simulated machine: what waits if nothing can run

  // Only on PE 0.
  bool stopping_ = false;
  bool takes_census_ = false;
  std::int32_t n_answers_ = 0;
  std::vector<Records> records_;     // at the end, of each PE
  std::uint64_t n_sent_by_all_ = 0;  // messages of epoch 0, when it was found to be done
  Census census_;
  std::map<CollectionId, std::int32_t> empty_on_;          // number of PEs per collection
  std::map<std::string, OwnCheckpoints> own_checkpoints_;  // by folder
  std::vector<std::uint64_t> lineage_;
  std::vector<CollectionNumbers::Made> made_before_restart_;
  bool checkpoint_runs_ = false;
  // On each PE: the greatest exit code requested here.
  std::vector<int> asked_;
};

}  // namespace tess::detail
