// The machine that a run uses: the number of PEs and processes, the transport of messages between
// them, the threads that drive the PEs, and the time. There are three implementations: threads, mpi
// and simulated. The runtime uses only this interface, so a program runs unchanged on all of them.
//
//     Program (the runtime)   accept / step / idle / receive   called by the machine, on the PE's thread
//     Machine                 post / send / stop / now         called by the runtime
//
// Within a process a message travels as a pointer (post). Between processes it travels as bytes
// (send): the runtime has packed many messages into one buffer. A large message is a parcel: a few
// bytes, and parts that the machine moves from the sender's memory to the memory that the receiving
// program names. No machine promises an order of delivery.
//
//     receiver:  place(head, sizes) → message, places    …parts arrive…    placed(message)
#pragma once

#include "runtime/base/bundle.hpp"
#include "runtime/base/link.hpp"
#include "runtime/core/buffer.hpp"
#include "runtime/core/duration.hpp"
#include "runtime/core/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tess::detail {

/// The purpose of a message. Only the simulated machine uses it, to delay one kind more than
/// another.
enum class Traffic : std::uint8_t { user, location, migration, control };

/// A large message under way to another process.
struct Parcel {
  Buffer head;
  std::vector<std::span<const std::byte>> parts;  ///< at least one; none is empty
  std::shared_ptr<void> keeper;  ///< keeps the parts until they are sent; any thread may release it
};

/// The program that a machine drives. Every function with a PE runs on that PE's thread, and never
/// twice at once for one PE.
class Program {
 public:
  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  virtual ~Program() = default;

  /// Called once per PE, on its thread, before any other call for that PE.
  virtual void start(PeId pe) = 0;
  /// Takes a list of messages that others posted to this PE, in the order in which they are to run.
  virtual void accept(PeId pe, Link* first) = 0;
  /// Takes several messages that another PE of the process posted together, and the bundle. Called
  /// only if the program posts bundles.
  virtual void accept_bundle(PeId /*pe*/, Bundle* /*bundle*/) {}
  /// Runs up to `most` messages that are ready; returns how many it ran.
  virtual std::size_t step(PeId pe, std::size_t most) = 0;
  /// No message is ready: sends what was held back to be packed. Returns true if it created or sent
  /// anything.
  virtual bool idle(PeId pe) = 0;
  /// The PE has run steps for about a millisecond, and more messages may be ready.
  virtual void busy(PeId /*pe*/) {}
  /// Takes a buffer that another process sent; `pe` is the PE whose thread received it.
  virtual void receive(PeId pe, std::span<const std::byte> bytes) = 0;
  /// Takes the head of a parcel whose parts have these sizes. Returns a message, and writes the
  /// destination of each part to `places`.
  virtual Link* place(PeId /*pe*/, std::span<const std::byte> /*head*/,
                      std::span<const std::uint64_t> /*sizes*/,
                      std::vector<std::span<std::byte>>& /*places*/) {
    return nullptr;
  }
  /// All parts of this message have arrived; `pe` is the PE whose thread noticed it.
  virtual void placed(PeId /*pe*/, Link* /*message*/) {}
  /// Frees a message whose parts arrived after finish().
  virtual void drop(Link* /*message*/) {}
  /// Called once per PE, on its thread, after the last step; it frees messages that remain.
  virtual void finish(PeId pe) = 0;
};

/// Time since the machine started: wall clock, or the virtual clock of the calling PE.
using Time = std::chrono::nanoseconds;

/// A time as a number of seconds.
[[nodiscard]] inline double seconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

class Machine {
 public:
  Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
  virtual ~Machine() = default;

  [[nodiscard]] std::int32_t n_pes() const { return n_processes_ * pes_per_process_; }
  [[nodiscard]] std::int32_t n_processes() const { return n_processes_; }
  [[nodiscard]] std::int32_t pes_per_process() const { return pes_per_process_; }
  /// The process of this memory. On the simulated machine all virtual processes share the memory of
  /// process 0.
  [[nodiscard]] ProcessId process() const { return process_; }
  [[nodiscard]] ProcessId process_of(PeId pe) const {
    return ProcessId{pe.value / pes_per_process_};
  }
  /// The PEs of a process are this one and those that follow it.
  [[nodiscard]] PeId first_pe(ProcessId process) const {
    return PeId{process.value * pes_per_process_};
  }
  /// True for one PE of each process.
  [[nodiscard]] bool is_first_of_process(PeId pe) const { return first_pe(process_of(pe)) == pe; }

  /// True if messages between the two PEs travel as pointers.
  [[nodiscard]] bool same_process(PeId a, PeId b) const { return process_of(a) == process_of(b); }

  /// The number of PEs in this memory: those of the process, or all simulated ones.
  [[nodiscard]] virtual std::int32_t n_pes_here() const { return pes_per_process_; }

  /// After this many unsuccessful checks of its queue a PE reports that it is idle.
  [[nodiscard]] virtual unsigned patience() const { return 64; }

  /// True if even a message of a PE to itself must go through post(): the simulated machine orders
  /// all messages.
  [[nodiscard]] virtual bool intercepts_local() const { return false; }

  /// Passes a message to a PE of this process; takes ownership of the link. `bytes` is its size for
  /// the cost model. Any PE thread of this process may call it.
  virtual void post(PeId from, PeId to, Link* message, std::size_t bytes, Traffic traffic) = 0;

  /// True if post_bundle() pays off; otherwise messages are posted one by one.
  [[nodiscard]] virtual bool takes_bundles() const { return false; }
  /// Passes several messages to a PE of this process; takes ownership.
  virtual void post_bundle(PeId /*to*/, Bundle* /*bundle*/) {}

  /// Passes a message to a PE of this process; takes ownership. Any thread may call it, also one
  /// that runs no PE, between the start of run() and stop().
  virtual void hand_in(PeId to, Link* message) = 0;

  /// Passes a message to a PE once the delay is over, in virtual time; takes ownership. Returns
  /// false, and does nothing, on a machine in real time.
  [[nodiscard]] virtual bool post_after(PeId /*to*/, Link* /*message*/, Time /*delay*/) {
    return false;
  }

  /// Sends bytes to another process. Any PE thread may call it; it does not block. Afterwards the
  /// caller may only clear() and refill `bytes`, which may keep its memory.
  virtual void send(PeId from, ProcessId to, Buffer&& bytes) = 0;
  /// Sends a parcel to another process; the same rules apply.
  virtual void send(PeId from, ProcessId to, Parcel&& parcel) = 0;

  /// Drives the PEs of this process until stop(); returns on the calling thread.
  virtual void run(Program& program) = 0;

  /// Ends run() in this process soon. Any PE thread may call it, more than once. Messages under way
  /// in this process are dropped after finish(); messages that other processes sent here are
  /// received and dropped, so that no process blocks.
  virtual void stop() = 0;

  /// Ends all processes of the job immediately with this exit code; does not return. The caller has
  /// flushed its output.
  [[noreturn]] virtual void abort(int exit_code) = 0;

  /// The run ended because the process was told to end: what follows must not keep it alive.
  /// Any PE thread.
  virtual void hurry(int /*exit_code*/) {}

  /// Compares 64 bits across all processes before the first message; true if all are equal. It
  /// detects processes that run different binaries.
  [[nodiscard]] virtual bool agree(std::uint64_t) { return true; }

  [[nodiscard]] virtual Time now(PeId pe) const = 0;

  /// True if now() is a virtual clock.
  [[nodiscard]] virtual bool virtual_time() const { return false; }
  /// The time that a PE has to charge() for each message that it ran; 0 on real machines.
  [[nodiscard]] virtual Time message_cost() const { return Time(0); }
  /// Advances the virtual clock of a running PE; does nothing on real machines.
  virtual void charge(PeId /*pe*/, Time /*work*/) {}

  /// Why run() returned although stop() was not called; empty if nothing was left to do.
  [[nodiscard]] virtual std::string gave_up() const { return {}; }

  /// What its times leave out, after run(); empty if nothing that matters.
  [[nodiscard]] virtual std::string left_out() const { return {}; }

  /// One line that describes the machine and the placement of its PEs.
  [[nodiscard]] virtual std::string describe() const = 0;

 protected:
  std::int32_t n_processes_ = 1;
  std::int32_t pes_per_process_ = 1;
  ProcessId process_{0};
};

}  // namespace tess::detail

namespace tess {

using detail::Machine;
using detail::seconds;
using detail::Time;

}  // namespace tess
