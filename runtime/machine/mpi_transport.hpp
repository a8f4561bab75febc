// Buffers between processes, over MPI. Any PE sends into the outbox; whoever holds the lock starts
// what waits there, and receives.
//
//     send() ─► outbox ─► waiting ─► MPI_Isend … MPI_Testsome      MPI_Improbe ─► MPI_Mrecv ─► Mail
//
// A buffer above the chunk limit is announced by its size and follows in chunks, in order.
#pragma once

#include "runtime/base/mpsc_queue.hpp"
#include "runtime/base/try_lock.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/mpi_mail.hpp"
#include "runtime/machine/mpi_requests.hpp"

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

namespace tess {

/// All but send() is called under the lock, or by one thread.
class Transport {
 public:
  /// `chunk_bytes`: the most that one MPI message carries; the same on all processes.
  Transport(MPI_Comm comm, std::int32_t n_processes, std::size_t chunk_bytes);

  /// Any thread; does not block.
  void send(ProcessId to, Buffer&& bytes);

  /// Starts the sends that wait, as many as may be under way, and frees those that are done.
  void push_out();

  /// Receives what has come, until the mail is full.
  void take_in(Mail& mail);

  /// After the last send(): receives and drops until every buffer that any process sent has been
  /// received. Counts, since a small send completes long before it is received.
  void drain();

  TryLock lock;

 private:
  enum Tag : int { whole, announcement, chunk };

  /// A buffer on its way out. The size is a member so that the announcement outlives its send.
  struct Outgoing : Link {
    int to = 0;
    Buffer bytes;
    std::uint64_t n_bytes = 0;
    std::size_t n_parts = 0;  // requests not yet complete
  };

  /// A buffer that comes in chunks.
  struct Incoming {
    std::unique_ptr<std::byte[]> bytes;
    std::uint64_t n_bytes = 0;
    std::size_t n_parts = 0;
  };

  void start(Outgoing& out);
  MPI_Request isend(const Outgoing& out, const void* from, std::size_t n_bytes, Tag tag);
  void expect(MPI_Message message, int source);

  MPI_Comm comm_;
  std::size_t chunk_bytes_;
  MpscQueue outbox_;               // any PE pushes
  std::deque<Outgoing*> waiting_;  // taken from the outbox, not yet started
  Requests<Outgoing> sends_;
  Requests<Incoming> chunks_;
  std::vector<std::int64_t> n_sent_;  // buffers, to each process
  std::int64_t n_received_ = 0;
};

}  // namespace tess
