// The service of a process: one thread (timekeeper.hpp), which sleeps until a timer is due or a
// signal arrives. It is started for signals, or by the first timer on a machine in real time.
//
//     SIGUSR1          process 0 prints what waits on all PEs of the job, and the run goes on
//     report_job()     the same for the page of --monitor, which gets the text instead
//     --hang-report    the same, when no entry method has begun for that time; and a line for each
//                      entry method that takes as long
//     SIGINT, SIGTERM  each process prints what waits on its PEs, then the run ends on all processes
//                      with exit code 128 + signal; a second one ends the job at once
//
//     signal -> a message to each PE here -> its census -> all here, or time is up: report
//            -> a message to each PE here -> Runtime::exit -> Stop to all PEs, each with its census
//
// A PE that runs a long entry method does not answer: after 0.3 s the report says what it runs, and
// after 0.7 s the job is aborted. (mpirun kills its processes 1 s after it passed SIGTERM on.)
//
// For the job's report each process takes its own census as above, and one of its PEs sends it to
// PE 0. Process 0 prints what has arrived within a second. A process that gets no answer from
// process 0 prints its own part. What leaves a process is sent by the first of its PEs that is free.
//
//     process p  signal -> census -> a PE sends it -> PE 0 -> process 0 ──► report
//     process 0  signal, or hang -> a PE asks all PEs of other processes -> each process: census …
//
// On a simulated machine PE 0 looks for a hang by messages in virtual time, and reads the censuses of
// all PEs itself.
//
// The PEs call it, and it posts messages to them; it runs no user code.
#pragma once

#include "runtime/pe/interfaces/process_service.hpp"

#include <memory>

namespace tess::detail {

class Runtime;

class Service final : public ProcessService {
 public:
  /// With `signals`, takes those signals that have the system's default action until its end.
  Service(Runtime& runtime, bool signals);
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() override;

  void begins(Pe& pe) override;
  void post_after(PeId to, Envelope* message, Time delay) override;
  void ends_by_signal(int signal, PeId pe, Waits waits) override;
  void report_job(std::function<void(std::string&&)> done) override;
  void close() override;

  /// The thread and its state. Handlers of its messages on the PEs call it.
  class Loop;
  [[nodiscard]] Loop& loop() { return *loop_; }

 private:
  std::unique_ptr<Loop> loop_;
};

}  // namespace tess::detail
