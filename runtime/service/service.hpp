// The service of a process: one thread, which sleeps in Boost.Asio until a timer is due or a signal
// arrives. It is started for signals, or by the first timer on a machine in real time.
//
//     SIGUSR1          each process prints what waits on its PEs, and the run goes on
//     SIGINT, SIGTERM  the same, then the run ends on all processes with exit code 128 + signal;
//                      a second one ends the job at once
//
//     signal -> a message to each PE here -> its census -> all here, or time is up: report
//            -> a message to each PE here -> Runtime::exit -> Stop to all PEs, each with its census
//
// A PE that runs a long entry method does not answer: after 0.3 s the report says what it runs, and
// after 0.7 s the job is aborted. (mpirun kills its processes 1 s after it passed SIGTERM on.)
//
// The PEs call it, and it posts messages to them; it runs no user code.
#pragma once

#include "runtime/scheduler/process_service.hpp"

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

  void post_after(PeId to, Envelope* message, Time delay) override;
  void take_census(std::uint64_t round, PeId pe, std::vector<std::string> lines) override;
  void ends_by_signal(int signal, PeId pe, std::vector<std::string> lines) override;
  void close() override;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace tess::detail
