// What the runtime asks of the service of its process: messages that are posted later, on machines
// in real time, and the report that a signal or a browser asks for. The service layer implements
// it.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/report/waiting.hpp"
#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <functional>
#include <string>

namespace tess::detail {

class Pe;

class ProcessService {
 public:
  ProcessService() = default;
  ProcessService(const ProcessService&) = delete;
  ProcessService& operator=(const ProcessService&) = delete;
  virtual ~ProcessService() = default;

  /// The run begins. Called on PE 0.
  virtual void begins(Pe& pe) = 0;
  /// Posts a message to a PE of this process once the delay is over; takes ownership. Any PE
  /// thread.
  virtual void post_after(PeId to, Envelope* message, Time delay) = 0;
  /// The run ends by a signal that another process may have received; `waits` is the census of a PE
  /// of this process. Called on the thread of each PE before it leaves the run.
  virtual void ends_by_signal(int signal, PeId pe, Waits waits) = 0;
  /// Asks for the report of the job, as SIGUSR1 does, and calls `done` with its text on a thread of
  /// the service; never if the run ends before. Process 0, any thread.
  virtual void report_job(std::function<void(std::string&&)> done) = 0;
  /// The PEs of this process leave the run: nothing is posted to them any more. Any PE thread.
  virtual void close() = 0;
};

}  // namespace tess::detail
