// Buffers between processes, over MPI. Any PE sends, at once if it gets the lock, else by way of
// the outbox; whoever holds the lock starts what waits there, and receives.
//
//     send() ─► (outbox ─► waiting) ─► MPI_Isend        MPI_Irecv, posted ahead ─► MPI_Test ─► Mail
//
// A few receives of the usual size are always posted, in a ring: MPI fills them in the order in
// which they were posted, so one test, of the oldest, finds whatever has come, and a small message
// goes from the sender's memory to its place without a probe. A larger buffer is announced by its
// size, and follows in chunks through a communicator of their own.
#pragma once

#include "runtime/base/mpsc_queue.hpp"
#include "runtime/base/try_lock.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/mpi_mail.hpp"
#include "runtime/machine/mpi_requests.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace tess {

/// All but send() and new_mail() is called under the lock, or by one thread.
class Transport {
 public:
  /// `chunk_bytes`: the most that one MPI message carries; the same on all processes. All make
  /// their transports together.
  Transport(MPI_Comm comm, std::int32_t n_processes, std::size_t chunk_bytes);
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  ~Transport();

  /// Any thread; does not block. Leaves `bytes` empty; it keeps its memory if MPI needs it no more.
  void send(ProcessId to, Buffer& bytes);

  /// Starts the sends that wait, as many as may be under way, and frees those that are done.
  void push_out();

  /// Receives what has come, until the mail is full.
  void take_in(Mail& mail);

  /// After the last send(): receives and drops until every buffer that any process sent has been
  /// received. Counts, since a small send completes long before it is received.
  void drain();

  /// Any thread.
  [[nodiscard]] Mail new_mail() const { return Mail(slot_bytes_); }

  TryLock lock;

 private:
  enum Tag : int { whole, announcement };

  /// A buffer on its way out. The size is a member so that the announcement outlives its send.
  struct Outgoing : Link {
    int to = 0;
    Buffer bytes;
    std::uint64_t n_bytes = 0;
    std::size_t n_parts = 0;  // requests not yet complete
  };

  /// A buffer that comes in chunks.
  struct Incoming {
    Mail::Block bytes;
    std::uint64_t n_bytes = 0;
    std::size_t n_parts = 0;
  };

  /// A receive that is posted ahead.
  struct Slot {
    MPI_Request request = MPI_REQUEST_NULL;
    Mail::Block bytes;
  };

  [[nodiscard]] bool send_now(int to, const Buffer& bytes, MPI_Request& request);
  void start(Outgoing& out);
  void post(Slot& slot);
  void expect(std::uint64_t n_bytes, int source);

  MPI_Comm comm_;
  MPI_Comm chunk_comm_ = MPI_COMM_NULL;
  const std::size_t chunk_bytes_;
  const std::size_t whole_bytes_;  // the most that travels in one piece, unannounced
  const std::size_t slot_bytes_;
  std::array<Slot, 8> slots_;
  std::size_t oldest_ = 0;         // of the slots: the next to be filled
  unsigned n_finds_ = 0;           // calls of take_in() that found something, one after the other
  MpscQueue outbox_;               // any PE pushes
  std::deque<Outgoing*> waiting_;  // taken from the outbox, not yet started
  Requests<Outgoing> sends_;
  Requests<Incoming> chunks_;
  std::vector<std::int64_t> n_sent_;  // buffers, to each process
  std::int64_t n_received_ = 0;
};

}  // namespace tess
