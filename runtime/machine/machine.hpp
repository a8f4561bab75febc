// The machine a run stands on: how many PEs and processes there are, how a message gets from one to
// another, who drives each PE, and what time it is. Three implementations: threads, mpi, simulated.
// The runtime above knows this interface alone, so one program runs unchanged on all of them.
//
//     Program (the runtime)   accept / step / idle / receive   called by the machine, on the PE's
//     thread Machine                 post / send / stop / now         called by the runtime
//
// Within a process a message travels as a pointer (post). Between processes it travels as bytes
// (send): the runtime has packed many messages into one buffer. A large message is a parcel: a few
// bytes, and parts that the machine moves from where they stand at the sender to where the program
// at the receiver wants them. No order of delivery is promised, by any machine.
//
//     receiver:  place(head, sizes) → message, places    …parts come…    placed(message)
#pragma once

#include "runtime/base/bundle.hpp"
#include "runtime/base/link.hpp"
#include "runtime/core/buffer.hpp"
#include "runtime/core/ids.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tess {

/// What a message is for; only the simulated machine looks at it, to delay one kind more than
/// another.
enum class Traffic : std::uint8_t { user, location, migration, control };

/// A large message on its way to another process.
struct Parcel {
  Buffer head;
  std::vector<std::span<const std::byte>> parts;  ///< at least one; none is empty
  std::shared_ptr<void> keeper;  ///< keeps the parts until they have left; any thread may end it
};

/// What a machine drives. Every function with a PE runs on that PE's thread, never twice at once
/// for one PE.
class Program {
 public:
  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  virtual ~Program() = default;

  /// Called once a PE, on its thread, before anything else of that PE.
  virtual void start(PeId pe) = 0;
  /// Takes a list of messages, first to run first, that others posted to this PE.
  virtual void accept(PeId pe, Link* first) = 0;
  /// Takes several messages that another PE of the process posted together, and the bundle; called
  /// only if the program posts bundles.
  virtual void accept_bundle(PeId /*pe*/, Bundle* /*bundle*/) {}
  /// Runs up to `most` messages that are ready; returns how many it ran.
  virtual std::size_t step(PeId pe, std::size_t most) = 0;
  /// Nothing is ready: flush what was held back for company. True if that made or sent anything.
  virtual bool idle(PeId pe) = 0;
  /// Takes a buffer that another process sent; `pe` is the PE whose thread happened to receive it.
  virtual void receive(PeId pe, std::span<const std::byte> bytes) = 0;
  /// Takes the head of a parcel, whose parts have these sizes: returns a message, and says in
  /// `places` where each part is to be put.
  virtual Link* place(PeId /*pe*/, std::span<const std::byte> /*head*/,
                      std::span<const std::uint64_t> /*sizes*/,
                      std::vector<std::span<std::byte>>& /*places*/) {
    return nullptr;
  }
  /// All parts of that message have come; `pe` is the PE whose thread noticed.
  virtual void placed(PeId /*pe*/, Link* /*message*/) {}
  /// Frees a message whose parts came after finish().
  virtual void drop(Link* /*message*/) {}
  /// Called once a PE, on its thread, after the last step; messages that remain are freed here.
  virtual void finish(PeId pe) = 0;
};

/// Time since the machine started: wall clock, or the virtual clock of the PE that asks.
using Time = std::chrono::nanoseconds;

/// As a number of seconds.
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
  /// The process this memory belongs to. On the simulated machine all virtual processes share it:
  /// 0.
  [[nodiscard]] ProcessId process() const { return process_; }
  [[nodiscard]] ProcessId process_of(PeId pe) const {
    return ProcessId{pe.value / pes_per_process_};
  }

  /// True if a message between the two may travel as a pointer.
  [[nodiscard]] bool same_process(PeId a, PeId b) const { return process_of(a) == process_of(b); }

  /// How many PEs this memory holds: those of the process, or all simulated ones.
  [[nodiscard]] virtual std::int32_t n_pes_here() const { return pes_per_process_; }

  /// How many fruitless looks at its queue make a PE report that it has run dry.
  [[nodiscard]] virtual unsigned patience() const { return 64; }

  /// True if even a message of a PE to itself has to go through post(): the simulated machine
  /// orders them all.
  [[nodiscard]] virtual bool intercepts_local() const { return false; }

  /// Hands a message to a PE of this process; takes ownership of the link. `bytes` is its size for
  /// the cost model. Any PE thread of this process may call it.
  virtual void post(PeId from, PeId to, Link* message, std::size_t bytes, Traffic traffic) = 0;

  /// True if post_bundle() is worth while; otherwise messages are posted one by one.
  [[nodiscard]] virtual bool takes_bundles() const { return false; }
  /// Hands several messages to a PE of this process; takes ownership.
  virtual void post_bundle(PeId /*to*/, Bundle* /*bundle*/) {}

  /// Sends bytes to another process; never to this one. Any PE thread may call it; it does not
  /// block. What it leaves of `bytes` is for clear() alone; it may keep its memory, to be filled
  /// again.
  virtual void send(PeId from, ProcessId to, Buffer&& bytes) = 0;
  /// The same for a parcel.
  virtual void send(PeId from, ProcessId to, Parcel&& parcel) = 0;

  /// Drives the PEs of this process until stop(); returns on the thread that called it.
  virtual void run(Program& program) = 0;

  /// Ends run() in this process soon; any PE thread may call it, more than once. What is on its way
  /// in this process is dropped after finish(); what other processes sent here is received and
  /// dropped, so that none of them blocks.
  virtual void stop() = 0;

  /// Ends the whole job now, all processes, with this exit code; does not return. Text was flushed
  /// by the caller.
  [[noreturn]] virtual void abort(int exit_code) = 0;

  /// Agreement of all processes before the first message: the same 64 bits everywhere? (Binaries
  /// that differ.)
  [[nodiscard]] virtual bool agree(std::uint64_t) { return true; }

  [[nodiscard]] virtual Time now(PeId pe) const = 0;

  /// True if now() is a virtual clock.
  [[nodiscard]] virtual bool virtual_time() const { return false; }
  /// What the PE has to charge() for each message that it ran; 0 where time passes by itself.
  [[nodiscard]] virtual Time message_cost() const { return Time(0); }
  /// Advances the virtual clock of a PE that runs; nothing where time is real.
  virtual void charge(PeId /*pe*/, Time /*work*/) {}

  /// One line: what the machine is and how its PEs are placed.
  [[nodiscard]] virtual std::string describe() const = 0;

 protected:
  std::int32_t n_processes_ = 1;
  std::int32_t pes_per_process_ = 1;
  ProcessId process_{0};
};

}  // namespace tess
